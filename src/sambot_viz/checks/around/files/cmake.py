"""Read the commands in a CMakeLists.txt, and find what stops CMake."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from sambot_viz.cached import cached_property
from sambot_viz.checks.around.files.fault import Fault
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.errors import Place, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

_TOKEN = re.compile(
    r"(?P<skip>\s+|\#\[(?P<level>=*)\[.*?\](?P=level)\]|\#[^\n]*)"
    r"|(?P<bracket>\[(?P<depth>=*)\[.*?\](?P=depth)\])"
    r'|(?P<quoted>"(?:[^"\\]|\\.)*")'
    r'|(?P<sign>[()"])'
    r"|(?P<word>(?:\$\(\w*\)|\\.|[^\s()\#\"\\])"
    r"(?:\$\(\w*\)|\\.|\"(?:[^\"\\\n]|\\.)*\"|[^\s()\#\"\\])*)",
    re.DOTALL,
)
_COMMAND = re.compile(r"[ \t]*\w+[ \t]*\(")
_BLOCKS = frozenset({"if", "foreach", "while", "function", "macro", "block"})
_KEYWORDS = frozenset(
    "TYPE DESTINATION FILE_PERMISSIONS DIRECTORY_PERMISSIONS PERMISSIONS PATTERN REGEX "
    "USE_SOURCE_PERMISSIONS FILES_MATCHING OPTIONAL MESSAGE_NEVER CONFIGURATIONS "
    "COMPONENT EXCLUDE_FROM_ALL".split()
)
INSTALLED = frozenset(
    "TARGETS IMPORTED_RUNTIME_ARTIFACTS FILES PROGRAMS DIRECTORY SCRIPT CODE EXPORT "
    "RUNTIME_DEPENDENCY_SET".split()
)
"""The first words of install( … )."""
_FIRST = {"cmake_minimum_required": "VERSION"}
"""Command → its required first word."""
_DEFINING = frozenset({"macro", "function", "include", "add_subdirectory"})
"""Commands that may define commands of any name."""
_HERE = re.compile(r"\$\{(CMAKE_CURRENT_SOURCE_DIR|PROJECT_SOURCE_DIR)\}/?")
_NAME = "PROJECT_NAME"


class CMakeWord(NamedTuple):
    """An argument of a command, without quotation marks, and its line."""

    text: str
    line: int


class CMakeCommand(NamedTuple):
    """A command.

    Attributes:
        name: in small letters.
        words: its arguments; parentheses among them are left out.
        line: where its name is.
        certain: False within if( … ), a loop or a function.
    """

    name: str
    words: tuple[CMakeWord, ...]
    line: int
    certain: bool

    @property
    def directories(self) -> tuple[CMakeWord, ...]:
        """The folders of install(DIRECTORY …), relative to the package."""
        return self.installed("DIRECTORY")

    @property
    def files(self) -> tuple[CMakeWord, ...]:
        """The files of install(FILES …), relative to the package."""
        return self.installed("FILES")

    def installed(self, kind: str) -> tuple[CMakeWord, ...]:
        """Return what install(KIND …) installs, files relative to the package."""
        if self.name != "install" or not self.words or self.words[0].text != kind:
            return ()
        found: list[CMakeWord] = []
        for text, line in self.words[1:]:
            if text in _KEYWORDS:
                break
            found.append(CMakeWord(_HERE.sub("", text) or ".", line))
        return tuple(found)

    @property
    def destination(self) -> CMakeWord | None:
        """The argument after DESTINATION, or None."""
        for at, word in enumerate(self.words[:-1]):
            if word.text == "DESTINATION":
                return self.words[at + 1]
        return None


class CMakeFile:
    """A CMakeLists.txt.

    Args:
        text: its text.
        shown: the path as the user would write it.
    """

    def __init__(self, text: str, shown: str) -> None:
        self.shown = shown
        self.fault: Fault | None = None
        """The fault that stops CMake; it makes the commands uncertain."""
        self.misspelt: Fault | None = None
        """The fault of a word that CMake does not know."""
        self._lines = text.splitlines()
        self.commands = tuple(self._commands(text))
        self.fault = self.fault or self._open_block()
        if self.fault is None:
            self.misspelt = next(self._misspelt(), None)
            self.fault = self.misspelt

    def place(self, line: int) -> Place:
        """Return the place of a line."""
        return Place(self.shown, line)

    @cached_property
    def names(self) -> frozenset[str]:
        """The names of all commands."""
        return frozenset(command.name for command in self.commands)

    @property
    def is_package(self) -> bool:
        """True when it builds a ROS 2 package, as far as its text shows."""
        makes = {"ament_package", "ament_auto_package"}
        return self.fault is None and not makes.isdisjoint(self.names)

    def certain(self, name: str) -> bool:
        """Return whether a command has a call outside if( … ), loops and functions."""
        return any(c.name == name and c.certain for c in self.commands)

    @cached_property
    def project(self) -> CMakeWord | None:
        """The name of the only project, when it is plain text."""
        projects = [c for c in self.commands if c.name == "project" and c.words]
        if len({c.words[0].text for c in projects}) != 1:
            return None
        name = projects[0].words[0]
        return name if re.fullmatch(r"[\w.-]+", name.text) else None

    def is_name(self, part: str) -> bool:
        """Return whether a text misspells ${PROJECT_NAME}, such as ${PROJECT_NAM}."""
        bare = re.sub(r"^\$?[{(]?|[)}]?$", "", part)
        known = {c.words[0].text for c in self.commands if c.name == "set" and c.words}
        like = nearest(bare.upper(), [_NAME], likeness=0.85) is not None
        return like and bare not in known

    def _commands(self, text: str) -> Iterator[CMakeCommand]:
        line, closed, inside = 1, 0, 0
        name = CMakeWord("", 0)
        words: list[CMakeWord] = []
        opened: list[int] = []
        for token in _TOKEN.finditer(text):
            found = token[0]
            if found == '"':
                self.fault = self._open_quote(text)
                return
            if found == "(":
                opened.append(line)
            elif found == ")" and opened:
                opened.pop()
                if not opened:
                    closed, low = line, name.text.lower()
                    inside -= low.startswith("end") and low[3:] in _BLOCKS
                    yield CMakeCommand(low, tuple(words), name.line, inside <= 0)
                    inside += low in _BLOCKS
                    words = []
            elif found == ")":
                self.fault = self._closed_early(name, closed, line)
                return
            elif token["skip"] is None and opened:
                words.append(CMakeWord(_bare(found), line))
            elif token["word"]:
                name = CMakeWord(found, line)
            line += found.count("\n")
        if opened:
            self.fault = self._never_closed(name, opened[0])

    def _misspelt(self) -> Iterator[Fault]:
        """Find misspelt commands, and misspelt keywords of commands."""
        known = vocabulary("cmake_commands")
        for command in self.commands if _DEFINING.isdisjoint(self.names) else ():
            near = [name for name in known if is_one_slip(command.name, name)]
            if command.name not in known and len(near) == 1:
                cause = f"there is no command {command.name}()"
                yield self._renamed(command.line, command.name, near[0], cause)
        for name, key in _FIRST.items():
            for words in (c.words[:1] for c in self.commands if c.name == name):
                said = words[0].text if words else key
                if said != key and is_one_slip(said.upper(), key):
                    cause = f"{name}( … ) has {said}"
                    yield self._renamed(words[0].line, said, key, cause)
        for words in (c.words for c in self.commands if c.name == "install"):
            said = {word.text for word in words}
            for word in (*words[:1], *words[1:-1]):
                wanted = INSTALLED if word is words[0] else ["DESTINATION"]
                near = [key for key in wanted if is_one_slip(word.text.upper(), key)]
                if near and said.isdisjoint(wanted):
                    cause = f"install( … ) has {word.text}"
                    yield self._renamed(word.line, word.text, near[0], cause)

    def _renamed(self, line: int, wrong: str, right: str, cause: str) -> Fault:
        old = self._lines[line - 1]
        pattern = rf"(?i)\b{re.escape(wrong)}\b"
        better = re.sub(pattern, right, old, count=1)
        return Fault(line, cause, f"write {right}", better)

    def _open_block(self) -> Fault | None:
        """Find a block such as if( … ) without an end, and an end without a block."""
        opened: list[CMakeCommand] = []
        for command in self.commands:
            kind = command.name.removeprefix("end")
            if command.name in _BLOCKS:
                opened.append(command)
            elif kind != command.name and kind in _BLOCKS:
                if not opened:
                    cause = f"{command.name}() closes nothing"
                    return Fault(command.line, cause, "delete it")
                if opened[-1].name != kind:
                    return self._without_end(opened[-1])
                opened.pop()
        return self._without_end(opened[-1]) if opened else None

    def _without_end(self, block: CMakeCommand) -> Fault:
        """Find the last line in a block without an end, by its indentation."""
        head = _indent(self._lines[block.line - 1])
        last = block.line
        for number in range(block.line + 1, len(self._lines) + 1):
            code = _code(self._lines[number - 1])
            between = code.strip().lower().startswith(("else", ")"))
            if code and _indent(code) <= head and not between:
                break
            last = number if code else last
        end = f"end{block.name}()"
        line = self._lines[last - 1]
        return Fault(
            last,
            f"the {block.name}( … ) of line {block.line} has no {end}",
            f"write {end} after this line",
            f"{line}\n{' ' * head}{end}",
        )

    def _never_closed(self, name: CMakeWord, line: int) -> Fault:
        """Find the last line before the next command, where the ) is missing."""
        end, head = len(self._lines), _indent(self._lines[line - 1])
        for number in range(line + 1, end + 1):
            text = self._lines[number - 1]
            inner = name.text.lower() not in _BLOCKS and _indent(text) > head
            if _COMMAND.match(text) and not inner:
                end = number - 1
                break
        code = {n: _code(self._lines[n - 1]) for n in range(line, end + 1)}
        last = max((n for n, text in code.items() if text), default=line)
        word = (code[last].split() or [name.text])[-1]
        return Fault(
            line,
            f"the ( of {name.text} is not closed",
            f"write {word}) in line {last}" if last != line else f"write {word})",
            f"{code[last]})",
            last,
        )

    def _closed_early(self, name: CMakeWord, closed: int, line: int) -> Fault:
        """Find the ) that closes a command before its last words."""
        before = _code(self._lines[closed - 1]) if name.line > closed > 0 else ""
        word = "".join(before.split()[-1:]).removesuffix(")")
        if word and before.endswith(")"):
            hint = f"write {word} without the ) after it in line {closed}"
            return Fault(line, "this ) closes nothing", hint, before[:-1], closed)
        code = _code(self._lines[line - 1])
        better = code[:-1] if code.endswith("))") else None
        return Fault(line, "this ) closes nothing", "delete it", better)

    def _open_quote(self, text: str) -> Fault:
        """Find the first quotation mark whose text does not end in its line."""
        at = len(text)
        for token in _TOKEN.finditer(text):
            quoted = token["quoted"] or ""
            if token["sign"] == '"' or "\n" in quoted:
                at = token.start()
                break
        rest = _code(text[at:].split("\n", 1)[0])
        value = re.split(r"\s|\)", rest, maxsplit=1)[0]
        start = text.rfind("\n", 0, at) + 1
        return Fault(
            text.count("\n", 0, at) + 1,
            'a quotation mark " is opened and not closed',
            f'write {value}"',
            f'{text[start:at]}{value}"{rest[len(value) :]}',
        )


def _bare(text: str) -> str:
    """Return the text in quotation marks."""
    return text[1:-1] if len(text) > 1 and text[0] == text[-1] == '"' else text


def _indent(text: str) -> int:
    return len(text) - len(text.lstrip())


def _code(text: str) -> str:
    """Return a line without its comment."""
    return text.partition("#")[0].rstrip()

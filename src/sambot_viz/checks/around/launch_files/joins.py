"""Report words of commands and parts of paths that launch joins wrongly."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from itertools import pairwise

from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call
from sambot_viz.checks.around.place import rewritten
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name
from sambot_viz.edits import together, write, write_attribute, write_between
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.xml.element import Element

_CODE = "launch-code"
_WORDS = ("arguments", "cmd", "ros_arguments")
OPTION = re.compile(r"-{1,2}[A-Za-z][\w-]*\s+\S.*")
"""An option with its value in one text."""
_OPTION_ALONE = re.compile(r"(-{1,2}[A-Za-z][\w-]*)\s+")
"""An option with the blank before its value."""
_WORD = re.compile(r"(?:\$\([^()]*\)|\S)+")
"""A word of a command; a substitution is one, with its blanks."""
_NUMBERS = re.compile(r"(-?[\d.]+\s+){3,}.*")
_ASSIGNED = re.compile(r"\w+:=.*")
_COMMAND = re.compile(r"\$\(command\s+(['\"]?)(\w+)\$\(")
_OF_SHELL = frozenset("\"'|&;<>*$`")
_LIKENESS = 0.85
_FOLDERS = frozenset({"FindPackageShare", "ThisLaunchFileDir"})
_PATHS = frozenset({"PathJoinSubstitution", "join"})


def several_words(around: Surroundings) -> Iterator[Problem]:
    """Report program arguments with several words in one text, and numbers."""
    for launch in around.launches:
        for call in launch.calls:
            whole = call.given("shell") is not None
            yield from () if whole else _no_program(launch, call)
            for argument in _WORDS:
                option = ""
                for item, node in call.listing(argument).items:
                    # An option may precede several words for another program.
                    is_value, option = option[:1] == "-", launch.values.said(item) or ""
                    if isinstance(node, ast.Constant) and not whole:
                        yield from _no_word(node, launch, argument, is_value)
                    elif isinstance(node, ast.BinOp) and not whole and not is_value:
                        yield from _one_word(node, launch)


def _no_program(launch: LaunchFile, call: Call) -> Iterator[Problem]:
    """Report a command in one text, which launch takes for a program's name."""
    first = next((node for _, node in call.listing("cmd").items), None)
    if first is None or first is call.given("cmd"):
        return
    parts = first.elts if isinstance(first, ast.List) else [first]
    known = [part.value for part in parts if isinstance(part, ast.Constant)]
    text = "".join(part for part in known if isinstance(part, str))
    words = text.split()
    if len(words) < 2 or text[0] == "/":
        return
    right = ", ".join(repr(word) for word in words)
    plain = len(known) == len(parts) and not set(text) & _OF_SHELL
    yield Problem.at(
        launch.place(first),
        "error",
        _CODE,
        f"launch runs cmd without a shell, so '{text.strip()}' is one word, the name "
        "of a program that does not exist",
        rewritten(first, launch.shown, right)
        if plain
        else Fix("write each word in a text of its own, or shell=True"),
    )


def _no_word(
    node: ast.Constant, launch: LaunchFile, argument: str, is_value: bool
) -> Iterator[Problem]:
    text = node.value
    if isinstance(text, (int, float)) and not isinstance(text, bool):
        yield Problem.at(
            launch.place(node),
            "error",
            _CODE,
            f"{argument} takes texts, and {text} is a number: ros2 launch stops",
            rewritten(node, launch.shown, f"'{ast.unparse(node)}'"),
        )
    elif is_value or not isinstance(text, str):
        return
    elif OPTION.fullmatch(text) or _NUMBERS.match(text):
        words = ", ".join(repr(word) for word in _WORD.findall(text))
        yield Problem.at(
            launch.place(node),
            "warning",
            _CODE,
            f"'{text}' is one word for the program, which launch does not take apart: "
            "it knows no such option",
            rewritten(node, launch.shown, words),
        )


def _one_word(node: ast.BinOp, launch: LaunchFile) -> Iterator[Problem]:
    """Report an option that a plus joins with its value: '-d ' + path."""
    left = node.left
    text = left.value if isinstance(left, ast.Constant) else None
    option = _OPTION_ALONE.fullmatch(text) if isinstance(text, str) else None
    if option is None or not isinstance(node.op, ast.Add):
        return
    begin, end = launch.place(left), launch.place(node.right)
    right = f"'{option[1]}', "
    yield Problem.at(
        begin,
        "warning",
        _CODE,
        f"the plus makes one word of {option[1]} and its value, which launch does not "
        "take apart: the program knows no such option",
        write_between(begin, end, right, f"write {right}… with a comma"),
    )


def joined_texts(around: Surroundings) -> Iterator[Problem]:
    """Report two words of a command that a missing comma joins."""
    for launch, text in around.launch_texts():
        lines = text.splitlines()
        for call in launch.calls:
            for argument in _WORDS:
                for _, node in call.listing(argument).items:
                    if _is_joined(node, lines):
                        yield _joined(node, launch, lines)


def _is_joined(node: ast.expr, lines: list[str]) -> bool:
    """Return whether two texts, each alone in a line, do not look like one text."""
    last = node.end_lineno or node.lineno
    if not isinstance(node, ast.Constant) or last != node.lineno + 1:
        return False
    first, second = (_alone(lines[at - 1]) for at in (node.lineno, last))
    value = f"{first}{second}"
    return bool(first and second) and value == node.value and " " not in value


def _alone(line: str) -> str | None:
    """Return the text of a line that is only a text in quotation marks."""
    found = re.fullmatch(r"\s*(['\"])([^'\"\\]*)\1\s*,?\s*(#.*)?", line)
    return None if found is None else found[2]


def _joined(node: ast.expr, launch: LaunchFile, lines: list[str]) -> Problem:
    code = lines[node.lineno - 1].partition("#")[0].rstrip()
    place = Place(launch.shown, node.lineno, len(code) + 1)
    return Problem.at(
        place,
        "warning",
        _CODE,
        "a comma is missing at the end of this line: Python makes one word of two",
        write_between(place, place, ",", "add a comma there"),
    )


def joined_words(around: Surroundings) -> Iterator[Problem]:
    """Report words of a command that a missing blank joins."""
    for launch in around.launches:
        for call in launch.called("Command"):
            words = call.listing("command", 0).items
            for at, (_, node) in enumerate(words):
                yield from _glued(launch, [n for _, n in words], at, node)
        for pair in _option_pairs(launch):
            yield from _glued_option(launch, pair)
    for package in around.packages:
        for root in package.frontends:
            for element in root.iter():
                yield from _glued_in_xml(element)


def _glued(
    launch: LaunchFile, nodes: Sequence[ast.expr], at: int, node: ast.expr
) -> Iterator[Problem]:
    """Report xacro without a blank after it, or an argument without one before it."""
    text = node.value if isinstance(node, ast.Constant) else None
    if not isinstance(text, str) or len(nodes) < 2:
        return
    before = launch.values.text(nodes[at - 1]) if at else " "
    after = launch.values.text(nodes[at + 1]) if at + 1 < len(nodes) else None
    place = launch.place(node)
    if not at and text == "xacro" and not (after or "x")[:1].isspace():
        yield Problem.at(
            place,
            "error",
            "launch-command",
            "Command joins its words without a blank: xacro and the name of the model "
            "become one word, and ros2 launch stops",
            write(
                place,
                text,
                f"{text} ",
                hint=f"write '{text} ', with a blank at the end",
            ),
        )
    elif at and _ASSIGNED.fullmatch(text) and not (before or "x")[-1:].isspace():
        yield Problem.at(
            place,
            "error",
            "launch-command",
            f"Command joins its words without a blank: {text} becomes a part of the "
            "word before it",
            rewritten(node, launch.shown, f"' {text}'"),
        )


def _option_pairs(launch: LaunchFile) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield each two joined parts in a launch argument."""
    for call in launch.called("IncludeLaunchDescription"):
        given = call.given("launch_arguments")
        for node in ast.walk(given) if given is not None else ():
            for value in node.values if isinstance(node, ast.Dict) else ():
                parts = value.elts if isinstance(value, ast.List) else []
                yield from pairwise(parts)


def _glued_option(
    launch: LaunchFile, pair: tuple[ast.expr, ast.expr]
) -> Iterator[Problem]:
    """Report options that become a part of the path after them."""
    node, path = pair
    text = node.value if isinstance(node, ast.Constant) else None
    after = launch.values.text(path) or "x"
    if isinstance(text, str) and text.startswith("-") and text[-1].isalnum():
        if not after[0].isspace() and not isinstance(path, ast.Constant):
            yield Problem.at(
                launch.place(node),
                "error",
                "launch-command",
                f"launch joins these parts without a blank: {text} and what follows "
                "become one word",
                rewritten(node, launch.shown, repr(f"{text} ")),
            )


def _glued_in_xml(element: Element) -> Iterator[Problem]:
    for name, value in element.attributes.items():
        found = _COMMAND.search(value)
        if found is not None:
            wrong = f"{found[2]}$("
            right = value.replace(wrong, f"{found[2]} $(", 1)
            hint = f"write a blank behind {found[2]}"
            is_xml = not element.place.file.endswith((".yaml", ".yml"))
            yield Problem.at(
                element.place,
                "error",
                "launch-command",
                f"{found[2]} and the name of the model become one word without a blank "
                "between them, and ros2 launch stops",
                write_attribute(element.place, name, value, right, hint=hint)
                if is_xml
                else hint,
            )


def joined_paths(around: Surroundings) -> Iterator[Problem]:
    """Report parts of a path that a launch file joins without a slash."""
    for launch in around.launches:
        inner = {
            id(part)
            for call in ast.walk(launch.tree)
            if isinstance(call, ast.Call)
            # A misspelt one has another finding.
            if nearest(call_name(call.func) or "", _PATHS, _LIKENESS)
            for part in (*call.args, *(k.value for k in call.keywords))
        }
        for node in ast.walk(launch.tree):
            if isinstance(node, ast.List) and id(node) not in inner:
                yield from _without_slash(launch, node)


def _without_slash(launch: LaunchFile, parts: ast.List) -> Iterator[Problem]:
    first, *others = parts.elts or [ast.Constant(None)]
    if not isinstance(first, ast.Call) or call_name(first.func) not in _FOLDERS:
        return
    texts = [p for p in others if isinstance(p, ast.Constant)]
    glued = [p for p in texts if isinstance(p.value, str) and p.value[:1] != "/"]
    if glued and len(texts) == len(others):
        words = [(p, f"/{p.value}") for p in glued]
        yield Problem.at(
            launch.place(glued[0]),
            "error",
            "launch-command",
            "launch joins the parts of a path without a slash, unless they are in a "
            "PathJoinSubstitution: there is no such file",
            together(
                f"write {', '.join(repr(text) for _, text in words)}",
                *(rewritten(part, launch.shown, repr(text)) for part, text in words),
            ),
        )

"""Walks through docs/first-robot.md as its readers do, from an empty folder.

The page is the only source: its blocks are written to files where it says so, a block
of changes is a mistake that lasts up to the next bold paragraph, and what is quoted
after a command is what the command has to say.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import tempfile
from collections.abc import Generator, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.cli import COMMANDS, main

PAGE = Path(__file__).resolve().parents[3] / "docs" / "first-robot.md"

_PART = re.compile(
    r"^```(?P<kind>\w+)\n(?P<body>(?:(?!```).*\n)*)```$"
    r"|(?P<quote>(?:^>.*\n)+)"
    r"|(?P<text>(?:^(?![>`]).*\S.*\n|^`(?!``).*\n)+)",
    re.MULTILINE,
)
"""A block, a quotation, or a paragraph."""
_WRITE = re.compile(r"(?:^|.* )Write `(?P<file>[^`]+)`:$")
_ADD = re.compile(
    r"^Add to `(?P<file>[^`]+)`, at the end of `(?P<start><(?P<tag>\w+)[^`]*)>`:$"
)
_APPEND = re.compile(r"^Add to `(?P<file>[^`]+)`, at the end:$")
_COMMAND = re.compile(r"`(sambot-viz [^`]+)`")
_FINDING = re.compile(r"[^ ]+:\d+(:\d+)?: (?P<severity>\w+)\[(?P<code>[\w-]+)\]: ")
_OF_A_FILE = re.compile(r" *(\d+ \||\^$)")
_SHOWN = "…"
"""A line of it stands for the rest of what a command says."""


@dataclass(frozen=True, slots=True)
class Trial:
    """Commands of the page, in the folder as it is then.

    Attributes:
        line: of the page where they are, counted from 1.
        files: name → text.
        commands: each as it is typed.
        said: what the page quotes of them, with the commands where they are in the
            block; None where it quotes nothing.
        span: the part of the page that `said` is.
        quoted: whether the quotation has only messages, one a paragraph.
    """

    line: int
    files: Mapping[str, str]
    commands: tuple[str, ...]
    said: str | None
    span: tuple[int, int]
    quoted: bool = False

    @property
    def shows(self) -> bool:
        """Whether its command opens the page and waits."""
        return self.command not in COMMANDS

    @property
    def draws(self) -> bool:
        """Whether it needs a browser."""
        return any(" snapshot " in command for command in self.commands)

    @property
    def picture(self) -> str:
        """The name of the file that is a picture of the page; "" for none."""
        words = self.commands[0].split()
        return words[-1] if self.said is None and "-o" in words else ""

    @property
    def command(self) -> str:
        """The name of the first command, such as check."""
        return self.commands[0].split()[1]


class Walk:
    """The page, read from top to bottom.

    Attributes:
        files: name → text, as they are at the end.
        trials: all commands, in the order of the page.
    """

    def __init__(self, page: str) -> None:
        self._page = page
        self._before = ""
        self._mistake: str | None = None
        self.files: dict[str, str] = {}
        self.trials: list[Trial] = []
        for part in _PART.finditer(page):
            self._take(part)

    def _take(self, part: re.Match[str]) -> None:
        kind, body = part["kind"], part["body"]
        if kind in ("xml", "yaml", "python", "cmake"):
            self._write(body)
        elif kind == "diff":
            self._mistake = body
        elif kind in ("sh", "text"):
            prompt = "" if kind == "sh" else "$ "
            typed = re.findall(rf"^{re.escape(prompt)}(sambot-viz .*)$", body, re.M)
            said = body if prompt else None
            self._try(typed, said, part.span("body"))
        elif part["quote"]:
            command = " ".join(_COMMAND.findall(self._before)[-1].split())
            self._try([command], part["quote"], part.span("quote"), quoted=True)
        else:
            self._before = part["text"].strip()
            if self._before.startswith(("**", "#")):
                self._mistake = None

    def _line(self, place: int) -> int:
        return self._page.count("\n", 0, place) + 1

    def _write(self, body: str) -> None:
        if written := _WRITE.match(self._before.replace("\n", " ")):
            self.files[written["file"]] = body
            return
        if appended := _APPEND.match(self._before):
            self.files[appended["file"]] += body
            return
        added = _ADD.match(self._before)
        assert added, f"where does this go? {self._before!r}"
        text = self.files[added["file"]]
        begin = text.index(added["start"])
        close = f"</{added['tag']}>"
        outermost = added["tag"] in ("robot", "model")
        end = text.rindex(close) if outermost else text.index(close, begin)
        end = text.rindex("\n", 0, end) + 1
        self.files[added["file"]] = text[:end] + body + text[end:]

    def _try(
        self,
        commands: list[str],
        said: str | None,
        span: tuple[int, int],
        *,
        quoted: bool = False,
    ) -> None:
        if not commands:
            return
        files = dict(self.files)
        if self._mistake is not None:
            name, text = self._with_mistake(self._mistake, commands[0])
            files[name] = text
        line = self._line(span[0])
        trial = Trial(line, files, tuple(commands), said, span, quoted)
        self.trials.append(trial)

    def _with_mistake(self, change: str, command: str) -> tuple[str, str]:
        """Return the file that the change fits, first that of the command."""
        for name in sorted(self.files, key=lambda name: name not in command.split()):
            with contextlib.suppress(ValueError):
                return name, changed(self.files[name], change)
        raise ValueError(f"{PAGE.name}: this change fits no file:\n{change}")


def changed(text: str, change: str) -> str:
    """Return a text with the lines of a diff changed.

    Raises:
        ValueError: the lines are not there, or more than once.
    """
    for before, after in _hunks(change):
        if text.count(before) != 1:
            raise ValueError(before)
        text = text.replace(before, after)
    return text


def _hunks(change: str) -> Iterator[tuple[str, str]]:
    """Yield pieces of a diff: lines before, lines after. A piece ends after its +."""
    pieces = re.findall(r"(?:^[- ].*\n)+(?:^\+.*\n)*(?:^ .*\n)*", change, re.MULTILINE)
    for piece in pieces:
        lines = piece.splitlines(keepends=True)
        yield (
            "".join(line[1:] for line in lines if line[0] != "+"),
            "".join(line[1:] for line in lines if line[0] != "-"),
        )


def write_files(files: Mapping[str, str], folder: Path) -> None:
    """Write the files of a trial into an empty folder."""
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, "utf-8")


def said_in(folder: Path, trial: Trial) -> str:
    """Run the commands of a trial, and return the quotation that is right now."""
    outputs = [output_of(folder, command) for command in trial.commands]
    if trial.quoted:
        return "".join(_paragraphs(outputs[0]))
    pairs = zip(trial.commands, outputs, strict=True)
    return "".join(f"$ {command}\n{output}" for command, output in pairs)


def output_of(folder: Path, command: str) -> str:
    """Run a command in this process; what `>` names gets its standard output."""
    words = shlex.split(command, comments=False)[1:]
    target = words[words.index(">") + 1] if ">" in words else None
    words = words[: words.index(">")] if target else words
    out, err = io.StringIO(), io.StringIO()
    with (
        _inside(folder),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        contextlib.suppress(SystemExit),
    ):
        main(words)
    if target:
        (folder / target).write_text(out.getvalue(), "utf-8")
        return err.getvalue()
    return err.getvalue() + out.getvalue()


@contextlib.contextmanager
def _inside(folder: Path) -> Generator[None]:
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


def _paragraphs(output: str) -> Iterator[str]:
    """Yield a quotation with a paragraph for each error and warning.

    Of several findings with one code, such as one for each wheel, the first is quoted.
    Notes and the lines of files below a message are left out.
    """
    quoted: dict[str, str] = {}
    for line in output.splitlines():
        found = _FINDING.match(line)
        code = found["code"] if found else line
        if _OF_A_FILE.match(line) or (found and found["severity"] == "info"):
            continue
        quoted.setdefault(code, f"> `{line.strip()}`\n")
    yield ">\n".join(quoted.values())


def graph_in(folder: Path, trial: Trial) -> str:
    """Return the graph that a trial draws, without links: it is shown elsewhere."""
    command = trial.commands[0].partition(" -o ")[0]
    return output_of(folder, f"{command} --format svg").replace("\\", "/")


def agrees(quotation: str, now: str) -> bool:
    """Whether a quotation is what commands say; a line of … stands for the rest."""
    if f"{_SHOWN}\n" not in quotation:
        return quotation == now
    pattern = re.escape(quotation).replace(re.escape(f"{_SHOWN}\n"), "(?:.*\n)*?")
    return re.fullmatch(pattern, now) is not None


def refreshed(page: str, *, drawn: bool = False) -> str:
    """Return the page with the quotations that are right now.

    Args:
        page: its text.
        drawn: run the commands that need a browser; without it, all others.
    """
    pieces: list[str] = []
    end = 0
    for trial in Walk(page).trials:
        if trial.said is None or trial.draws != drawn:
            continue
        with tempfile.TemporaryDirectory() as folder:
            write_files(trial.files, Path(folder))
            now = said_in(Path(folder), trial)
        kept = agrees(trial.said, now)
        pieces += [page[end : trial.span[0]], trial.said if kept else now]
        end = trial.span[1]
    return "".join([*pieces, page[end:]])

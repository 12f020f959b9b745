"""``sambot-viz grade``: list which steps of a lesson a model passes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from sambot_viz.commands.command_line import Parser
from sambot_viz.errors import LessonError, UsageError
from sambot_viz.files import reason_of, write_atomically
from sambot_viz.lessons.grading import Grade, grade
from sambot_viz.lessons.writers import WRITERS
from sambot_viz.outlet import Line, Painted, write_lines, write_out
from sambot_viz.problems import write_problems
from sambot_viz.text import lines

PASSED, FAILED, TROUBLE = 0, 1, 2


def run(words: list[str]) -> int:
    """Grade; return 0 when all steps hold, 1 when one does not, 2 for usage errors."""
    given = parser().parse_args(words)
    try:
        found = grade(given.path, given.lesson, step=given.step)
    except LessonError as error:
        write_problems(error.problems)
        return TROUBLE
    if given.format == "text":
        written = [*_in_words(found)]
        document = "\n".join(_plain(each) for each in written)
    else:
        written, document = [], WRITERS[given.format](found)
    if given.output:
        _write(Path(given.output), document)
    elif written:
        write_out(*written)
    else:
        write_lines(document)
    return PASSED if found.passed else FAILED


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz grade",
        description="Say which steps of a lesson hold for a model and the files around "
        "it. They are read as those of an unknown person, in a process with limits of "
        "time and memory. Exit status: 0 all steps hold, 1 one does not, 2 usage, or a "
        "lesson that cannot be read.",
    )
    made.add_argument("path", metavar="FILE", help="model file, or folder with one")
    made.add_argument(
        "--lesson",
        metavar="LESSON",
        default="nav2-first-robot",
        help="name of a lesson that ships (see sambot-viz lesson list), a lesson.yaml, "
        "or its folder (default: %(default)s)",
    )
    made.add_argument(
        "--step", metavar="STEP", help="only this step, by its number or its name"
    )
    made.add_format(*(name for name in WRITERS if name != "json"))
    made.add_argument(
        "--output", "-o", metavar="FILE", help="write into this file, with its folder"
    )
    return made


def _in_words(found: Grade) -> Iterator[Line]:
    before = ""
    for step in found.steps:
        mark = Painted("passed", "added") if step.passed else Painted("failed", "error")
        yield [mark, f"  {step.number}. {step.title} ({step.name})"]
        again = step.message == before != ""
        text = "as in the step before" if again else step.message
        for message in text.splitlines():
            yield f"        {message}"
        before = step.message
    points = f"{found.score:g} of {found.max_score:g} points"
    count = sum(step.passed for step in found.steps)
    yield f"{found.lesson}: {count} of {len(found.steps)} steps hold, {points}"


def _plain(written: Line) -> str:
    if isinstance(written, str):
        return written
    return "".join(p if isinstance(p, str) else p.words for p in written)


def _write(path: Path, document: str) -> None:
    """Write a file, and make its folder: that of a grader may not exist yet.

    Raises:
        UsageError: it cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(path, f"{lines(document)}\n".encode())
    except OSError as error:
        raise UsageError(f"cannot write '{path}': {reason_of(error)}") from error

"""``sambot-viz diff``: list the differences between two models."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from sambot_viz.bundled import find
from sambot_viz.commands.command_line import Parser, parse
from sambot_viz.errors import RobotError
from sambot_viz.options import Options
from sambot_viz.outlet import Line, Painted, write_json, write_out
from sambot_viz.problems import write_problems
from sambot_viz.robot.difference import Difference, differences
from sambot_viz.robot.difference_words import in_words
from sambot_viz.robot.model import Robot, load_robot

SAME, DIFFERENT, TROUBLE = 0, 1, 2


def run(words: list[str]) -> int:
    """Print the differences; return 0 if none, 1 if some, 2 for a broken model."""
    given, options = parse(parser(), words)
    try:
        mine, theirs = (_load(name, options) for name in (given.mine, given.theirs))
    except RobotError as error:
        write_problems(error.problems)
        return TROUBLE
    found = differences(mine, theirs)
    if given.format == "json":
        rows = [_as_json(one) for one in found]
        names = {"mine": given.mine, "theirs": given.theirs}
        write_json({**names, "differences": rows})
    else:
        write_out(*_in_words(found, given.mine, given.theirs))
    return DIFFERENT if found else SAME


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz diff",
        groups=("model",),
        takes_model=False,
        takes_arguments=True,
        description="List what differs between two models, link by link and joint by "
        "joint: parents, origins, axes, limits, shapes, colours, masses. NAME:=VALUE "
        "is an argument for xacro, of both. Exit status: 0 the same, 1 different, 2 a "
        "model with errors, or usage.",
    )
    made.add_argument("mine", metavar="A", help="model file or package folder")
    made.add_argument("theirs", metavar="B", help="the one that it is compared with")
    made.add_format()
    return made


def _load(name: str, options: Options) -> Robot:
    return load_robot(
        find(Path(name)).model,
        xacro_args=options.xacro_args,
        package_path=options.package_path,
        trusted=options.trusted,
    )


def _as_json(found: Difference) -> dict[str, object]:
    mine, theirs = found.places
    return {
        "kind": found.kind,
        "name": found.name,
        "property": found.what or None,
        "mine": found.mine,
        "theirs": found.theirs,
        "unit": found.unit or None,
        "apart": found.apart,
        "line": mine and mine.line,
        "their_line": theirs and theirs.line,
    }


def _in_words(found: Sequence[Difference], mine: str, theirs: str) -> Iterator[Line]:
    """Write a table with the rows: value, in the first model, in the second."""
    if not found:
        yield "the models are the same"
        return
    rows = [("", mine, theirs, "")]
    for one in map(in_words, found):
        whose = f"{one.whose}: {one.what}" if one.what else one.whose
        rows.append((whose, one.mine, one.theirs, one.apart))
    widths = [max(len(row[column]) for row in rows) for column in range(3)]
    for number, row in enumerate(rows):
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=False))
        written = "  ".join((*cells, row[3])).rstrip()
        yield [Painted(written, "bold")] if number == 0 else written

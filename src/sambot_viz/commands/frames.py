"""``sambot-viz frames``: the tree of frames, as view_frames draws it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from sambot_viz.commands.command_line import (
    Parser,
    drawing_format,
    parse,
    posed_frames,
    write_drawing,
)
from sambot_viz.frames.export.drawing import tree_dot, tree_json_text
from sambot_viz.frames.export.svg import tree_svg
from sambot_viz.frames.frame_tree import FrameTree
from sambot_viz.inputs import Inputs
from sambot_viz.problems import write_problems
from sambot_viz.robot.model import Robot

Draw = Callable[[FrameTree, "Robot | None"], str]
FORMATS: dict[str, Draw] = {
    ".svg": tree_svg,
    ".dot": tree_dot,
    ".gv": tree_dot,
    ".json": tree_json_text,
}


def run(words: list[str]) -> int:
    """Draw the frames of a model; returns 0."""
    given, options = parse(parser(), words)
    output = Path(given.output) if given.output else None
    draw = tree_dot if output is None else drawing_format(output, FORMATS)
    with Inputs(options, listen=given.listen) as inputs:
        robot = inputs.robot()
        found = [p for p in inputs.problems() if p.severity != "info"]
        write_problems(found, model=options.model)
        drawing = draw(posed_frames(robot, inputs), robot)
    write_drawing(output, drawing)
    return 0


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz frames",
        groups=("model", "source", "pose"),
        description="Draw the tree of frames with joint name and type, xyz [m] and "
        "rpy [rad]. Exit status: 0 drawn, 1 errors found, 2 usage.",
    )
    made.add_listen()
    made.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help="file to write: .svg, .dot or .json (default: DOT on standard output)",
    )
    return made

"""``sambot-viz export``: the 3D view and a motion as one HTML file."""

from __future__ import annotations

from pathlib import Path

from sambot_viz.commands.command_line import (
    Parser,
    output_path,
    parse,
    start_state,
)
from sambot_viz.errors import UsageError
from sambot_viz.inputs import Inputs
from sambot_viz.problems import write_problems


def run(words: list[str]) -> int:
    """Write a page of a model; 0 when the file is written."""
    given, options = parse(parser(), words, panels=False, watch=False)
    output = output_path(given.output, "a page", ".html", ".htm")
    with Inputs(options, listen=given.listen) as inputs:
        write_problems(inputs.problems(), model=options.model)
        start_state(inputs.robot(), options)
        _export(inputs, output, given.motion == "sweep")
    return 0


def _export(inputs: Inputs, output: Path, sweep: bool) -> None:
    """Write what a page would show."""
    try:
        write_page(inputs, output, sweep=sweep)
    except OSError as error:
        raise UsageError(f"cannot write '{output}': {error.strerror}") from error


def write_page(
    inputs: Inputs,
    output: Path,
    *,
    sweep: bool,
) -> None:
    """Write the page of what is opened, and what is wrong with its config.

    Args:
        inputs: the model and the config.
        output: the file.
        sweep: whether it has a motion.

    Raises:
        RobotError: the model cannot be shown.
        OSError: the file cannot be written.
    """
    from sambot_viz.export.page_file import cut_short
    from sambot_viz.visualizer import Visualizer

    with Visualizer.of_inputs(inputs) as viz:
        session = viz.server.sessions.all()[0]
        write_problems(session.document.config.problems)
        if sweep:
            write_problems(cut_short(session.copy()))
        viz.export(output, sweep=sweep)


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz export",
        groups=("model", "source", "config", "view", "pose"),
        description="Write the 3D view with a motion of the robot as one HTML file, "
        "which any browser opens from a disk, without a server and without a network. "
        "Exit status: 0 written, 1 errors found, 2 usage.",
    )
    made.add_listen()
    add = made.add_argument
    add("-o", "--output", required=True, metavar="FILE.html", help="file to write")
    add(
        "--motion",
        default="sweep",
        choices=("sweep", "none"),
        help="motion: sweep moves each joint to its limits and back, or plays a "
        "recording from --at on (at most five minutes), none moves nothing "
        "(default: %(default)s)",
    )
    return made

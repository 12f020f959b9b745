"""``sambot-viz expand``: the text that xacro makes from a model, or its URDF."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from sambot_viz.bundled import find
from sambot_viz.commands.command_line import Parser, model_path, parse
from sambot_viz.outlet import write_xml
from sambot_viz.problems import write_problems
from sambot_viz.robot.load import expand
from sambot_viz.robot.model import load_robot
from sambot_viz.robot.model_source import OpenedModel, open_model


def run(words: list[str]) -> int:
    """Print the text."""
    given, options = parse(parser(), words)
    model = open_model(find(model_path(options)).model)
    # An SDF file must be read as a model, not only expanded, to be written as URDF.
    as_urdf = given.to == "urdf" and model.document.tag == "sdf"
    print_as = _urdf_of if as_urdf else expand
    text = print_as(
        model,
        xacro_args=options.xacro_args,
        package_path=options.package_path,
        trusted=options.trusted,
    )
    write_xml(text)
    return 0


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz expand",
        groups=("model",),
        description="Print the URDF or SDF that xacro makes from a model. Exit status: "
        "0 printed, 1 errors found, 2 usage.",
    )
    made.add_argument(
        "--to",
        choices=("urdf",),
        help="print URDF: of an SDF file that which robot_state_publisher makes of it",
    )
    return made


def _urdf_of(
    model: OpenedModel,
    *,
    xacro_args: Mapping[str, str],
    package_path: Sequence[Path | str],
    trusted: bool,
) -> str:
    """Return an SDF file as URDF; write its problems to standard error.

    Raises:
        RobotError: ROS would refuse the model.
    """
    robot = load_robot(
        model, xacro_args=xacro_args, package_path=package_path, trusted=trusted
    )
    lost = [problem for problem in robot.problems if problem.severity != "info"]
    write_problems(lost)
    return robot.urdf

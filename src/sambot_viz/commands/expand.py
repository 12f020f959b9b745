"""``sambot-viz expand``: the URDF that xacro makes from a model."""

from __future__ import annotations

import sys

from sambot_viz.bundled import find
from sambot_viz.commands.command_line import Parser, model_path, parse
from sambot_viz.robot.load import expand


def run(words: list[str]) -> int:
    """Print the URDF."""
    _, options = parse(parser(), words)
    text = expand(
        find(model_path(options)).model,
        xacro_args=options.xacro_args,
        package_path=options.package_path,
        trusted=options.trusted,
    )
    sys.stdout.write(text)
    sys.stdout.flush()
    return 0


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz expand",
        groups=("model",),
        description="Print the URDF that xacro makes from a model. Exit status: 0 "
        "printed, 1 errors found, 2 usage.",
    )
    return made

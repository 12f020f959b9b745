"""``sambot-viz expand``: the URDF that xacro makes of a model."""

from __future__ import annotations

import sys

from sambot_viz.bundled import find
from sambot_viz.commands.options import Parser, add_model_options, parse
from sambot_viz.robot.load import expand


def run(words: list[str]) -> int:
    """Print the URDF."""
    parser = Parser(
        prog="sambot-viz expand",
        description="Print the URDF that xacro makes of a model.",
    )
    add_model_options(parser)
    _, wanted = parse(parser, words)
    text = expand(
        find(wanted.model).model,
        xacro_args=wanted.xacro_args,
        package_path=wanted.package_path,
        trusted=wanted.trusted,
    )
    sys.stdout.write(text)
    sys.stdout.flush()
    return 0

"""``sambot-viz echo``: the pose of one frame in another, as tf2_echo prints it."""

from __future__ import annotations

import argparse
import json

from sambot_viz.commands.command_line import Parser, parse
from sambot_viz.commands.posed_frames import posed_frames
from sambot_viz.errors import FrameError
from sambot_viz.frames.explain import Explanation, explain
from sambot_viz.frames.export.echo_text import echo_json, format_echo
from sambot_viz.inputs import Inputs
from sambot_viz.problems import write_problems


class _AnyOrder(Parser):
    """Accepts options between MODEL, SOURCE and TARGET as well."""

    parse_args = argparse.ArgumentParser.parse_intermixed_args


def run(words: list[str]) -> int:
    """Print the pose of TARGET in SOURCE; 0 when there is one."""
    given, options = parse(parser(), words)
    robot = Inputs(options).robot()
    found = [p for p in robot.problems if p.severity != "info"]
    write_problems(found, model=options.model)
    tree = posed_frames(robot, options)
    # What tf2_echo calls the source is the target of tf2's look-up.
    found = explain(tree, given.source, given.target, robot)
    if found.transform is None:
        raise FrameError(_no_answer(found))
    if given.format == "json":
        print(json.dumps(echo_json(found.transform), indent=2))
    else:
        time = tree.latest_common_time(found.target, found.source)
        print(format_echo(found.transform, time))
    return 0


def _no_answer(found: Explanation) -> str:
    """Return the text that tf2 shows, then the reason."""
    tf2_text = found.refused.tf2_text if found.refused else ""
    return f"{tf2_text}\n  {found.reason}"


def parser() -> Parser:
    """Return the flags of the command."""
    made = _AnyOrder(
        prog="sambot-viz echo",
        groups=("model", "pose"),
        description="Print the pose of the frame TARGET, seen from the frame SOURCE, "
        "as tf2_echo does: the transform that takes coordinates in TARGET to SOURCE. "
        "Exit status: 0 printed, 1 no such transform, 2 usage.",
    )
    made.add_argument("source", metavar="SOURCE", help="the frame to look from")
    made.add_argument("target", metavar="TARGET", help="the frame to look at")
    made.add_format()
    return made

"""``sambot-viz echo``: the pose of one frame in another, as tf2_echo prints it."""

from __future__ import annotations

import argparse
import math
import os.path
from collections.abc import Sequence

from sambot_viz.commands.command_line import Parser, parse, posed_frames
from sambot_viz.errors import FrameError
from sambot_viz.frames.robot_frames import explain
from sambot_viz.frames.transform import Transform
from sambot_viz.geometry import rotation_from_xyzw
from sambot_viz.inputs import Inputs
from sambot_viz.outlet import write_json, write_lines
from sambot_viz.problems import write_problems


class _AnyOrder(Parser):
    """Accept options between MODEL, SOURCE and TARGET too, and MODEL after them.

    Users who know the command without a MODEL add one at the end.
    """

    def parse_args(  # pyright: ignore[reportIncompatibleMethodOverride]
        self, args: Sequence[str] | None = None, namespace: None = None
    ) -> argparse.Namespace:
        """Return the arguments of the command line."""
        given = self.parse_intermixed_args(args, namespace)
        words = (given.model, given.looker, given.seen)
        if words[0] and not os.path.exists(words[0]) and os.path.exists(words[2]):
            given.looker, given.seen, given.model = words
        return given


def run(words: list[str]) -> int:
    """Print the pose of TARGET in SOURCE; 0 when there is one."""
    given, options = parse(parser(), words)
    with Inputs(options, listen=given.listen) as inputs:
        robot = inputs.robot()
        found = [p for p in inputs.problems() if p.severity != "info"]
        write_problems(found, model=options.model)
        tree = posed_frames(robot, inputs)
    # The "source" of tf2_echo is the target frame of tf2's look-up.
    found = explain(tree, given.looker, given.seen, robot)
    if found.transform is None:
        # The text that tf2 shows, then the reason.
        tf2_text = found.refused.tf2_text if found.refused else ""
        raise FrameError(tf2_text, f"  {found.reason}")
    if given.format == "json":
        write_json(echo_json(found.transform))
    else:
        time = tree.latest_common_time(found.target, found.source)
        write_lines(f"{format_echo(found.transform, time)}\n")
    return 0


def parser() -> Parser:
    """Return the flags of the command."""
    made = _AnyOrder(
        prog="sambot-viz echo",
        groups=("model", "source", "pose"),
        description="Print the pose of the frame TARGET, seen from the frame SOURCE, "
        "as tf2_echo does: the transform that takes coordinates in TARGET to SOURCE. "
        "Exit status: 0 printed, 1 no such transform, 2 usage.",
    )
    made.add_argument("looker", metavar="SOURCE", help="the frame to look from")
    made.add_argument("seen", metavar="TARGET", help="the frame to look at")
    made.add_listen()
    made.add_format()
    return made


EchoJson = dict[str, "list[float] | list[list[float]]"]


def format_echo(transform: Transform, time: float = 0.0) -> str:
    """Return the block that tf2_echo prints once per period, in its form since Humble.

    Three decimals, minus zeros included, as the real tool has them; unlike there, the
    angles at a pitch of ±90° are right.

    Args:
        transform: the pose of TARGET in SOURCE, `tree.lookup(SOURCE, TARGET)` for
            ``tf2_echo SOURCE TARGET``.
        time: the time of the transform [s]; 0.0 for a chain of static transforms.

    Returns:
        Ten lines without a line break at the end.
    """
    xyz = [c + 0.0 for c in transform.translation.tolist()]
    # Adding 0 makes -0.0 into 0.0, which is what tf2's sums of products yield.
    x, y, z, w = (c + 0.0 for c in transform.rotation_xyzw.tolist())
    roll, pitch, yaw = (angle + 0.0 for angle in transform.rpy)
    # The pitch is minus a number in tf2, which prints as -0.000 when there is none.
    rpy = (roll, pitch or -0.0, yaw)
    rows = rotation_from_xyzw((x, y, z, w))
    full = [[*row, c] for row, c in zip(rows, xyz, strict=True)]
    full.append([0.0, 0.0, 0.0, 1.0])
    return "\n".join(
        (
            f"At time {_time(time)}",
            f"- Translation: {_listed(xyz)}",
            f"- Rotation: in Quaternion {_listed((x, y, z, w))}",
            f"- Rotation: in RPY (radian) {_listed(rpy)}",
            f"- Rotation: in RPY (degree) {_listed([math.degrees(a) for a in rpy])}",
            "- Matrix:",
            *("".join(f" {c:6.3f}" for c in row) for row in full),
        )
    )


def echo_json(transform: Transform) -> EchoJson:
    """Return the transform as exact lists: translation [m], rotation, rpy [rad]."""
    return {
        "translation": transform.translation.tolist(),
        "rotation_xyzw": transform.rotation_xyzw.tolist(),
        "rpy": list(transform.rpy),
        "matrix": transform.matrix.tolist(),
    }


def _listed(numbers: list[float] | tuple[float, ...]) -> str:
    return f"[{', '.join(f'{c:.3f}' for c in numbers)}]"


def _time(seconds: float) -> str:
    """Seconds, a dot, nanoseconds without zero padding: tf2_echo's own way."""
    # A float of today's epoch has no better resolution than microseconds.
    nanoseconds = round(seconds * 1_000_000) * 1000
    whole, rest = divmod(nanoseconds, 1_000_000_000)
    return f"{whole}.{rest}"

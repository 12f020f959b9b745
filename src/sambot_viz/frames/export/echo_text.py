"""A transform as tf2_echo prints it, and as JSON."""

from __future__ import annotations

import math

from sambot_viz.frames.transform import Transform
from sambot_viz.geometry import rotation_from_xyzw

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

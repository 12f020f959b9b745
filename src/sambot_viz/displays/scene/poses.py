"""Poses as viser wants them: a quaternion (w, x, y, z) and a position [m]."""

from __future__ import annotations

import math

import numpy as np

from sambot_viz.robot.model import Matrix

Wxyz = tuple[float, float, float, float]
Position = tuple[float, float, float]

IDENTITY_WXYZ: Wxyz = (1.0, 0.0, 0.0, 0.0)


def wxyz_of(T: Matrix) -> Wxyz:
    """The rotation of a (4, 4) or (3, 3) matrix as a unit quaternion (w, x, y, z)."""
    r00, r01, r02 = float(T[0, 0]), float(T[0, 1]), float(T[0, 2])
    r10, r11, r12 = float(T[1, 0]), float(T[1, 1]), float(T[1, 2])
    r20, r21, r22 = float(T[2, 0]), float(T[2, 1]), float(T[2, 2])
    # The largest of the four components is computed first, so that the division
    # below never loses digits.
    if r00 + r11 + r22 > 0:
        s = math.sqrt(1.0 + r00 + r11 + r22) * 2
        return (s / 4, (r21 - r12) / s, (r02 - r20) / s, (r10 - r01) / s)
    if r00 >= r11 and r00 >= r22:
        s = math.sqrt(1.0 + r00 - r11 - r22) * 2
        return ((r21 - r12) / s, s / 4, (r01 + r10) / s, (r02 + r20) / s)
    if r11 >= r22:
        s = math.sqrt(1.0 + r11 - r00 - r22) * 2
        return ((r02 - r20) / s, (r01 + r10) / s, s / 4, (r12 + r21) / s)
    s = math.sqrt(1.0 + r22 - r00 - r11) * 2
    return ((r10 - r01) / s, (r02 + r20) / s, (r12 + r21) / s, s / 4)


FARTHEST = 1e30
"""Browsers compute with 32 bits: what is farther away [m] would be infinite there."""


def position_of(T: Matrix) -> Position:
    """The translation of a (4, 4) matrix [m], always finite.

    viser keeps what it is given for every browser that comes later, so this is the
    last place where an absurd number can be stopped (DESIGN §4.5).
    """
    return (_shown(T[0, 3]), _shown(T[1, 3]), _shown(T[2, 3]))


def _shown(metres: float) -> float:
    """A finite coordinate; NaN (of two infinities) becomes 0."""
    # A comparison with NaN is never true.
    return (
        float(metres)
        if -FARTHEST < metres < FARTHEST
        else FARTHEST
        if metres > 0
        else -FARTHEST
        if metres < 0
        else 0.0
    )


def inverse(T: Matrix) -> Matrix:
    """The inverse of a rigid (4, 4) transform."""
    turned = np.swapaxes(T[:3, :3], 0, 1)
    out: Matrix = np.eye(4)
    out[:3, :3] = turned
    out[:3, 3] = -(turned @ T[:3, 3])
    return out


def wxyz_from_z(direction: Position) -> Wxyz:
    """The shortest rotation that turns +z into a direction (any length but 0)."""
    x, y, z = direction
    norm = math.sqrt(x * x + y * y + z * z)
    x, y, z = x / norm, y / norm, z / norm
    if z < -0.999999:
        return (0.0, 1.0, 0.0, 0.0)
    w = 1.0 + z
    length = math.sqrt(w * w + x * x + y * y)
    return (w / length, -y / length, x / length, 0.0)

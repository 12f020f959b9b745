"""Default sizes of displays, from the size of the shown robot."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sambot_viz.frames import FrameTree

_ROUND = (1.0, 2.0, 5.0, 10.0)
_APART = 0.001
"""Frames nearer than this are at one place [m]."""


@dataclass(frozen=True, slots=True)
class SceneSize:
    """The measures that sizes of displays follow.

    Attributes:
        length: the longest side of the box around the robot [m].
        spacing: the usual way from a frame to its parent [m].
    """

    length: float
    spacing: float


def frame_spacing(tree: FrameTree, length: float) -> float:
    """Return the median way from a frame to its parent [m].

    Frames at the place of their parent do not count; `length` without any other.
    """
    hops = [tree.hop(f).transform.matrix for f in tree.frames if tree.parent(f)]
    ways = [float(np.linalg.norm(T[:3, 3])) for T in hops]
    return float(np.median([w for w in ways if w > _APART] or [length]))


def round_size(size: float) -> float:
    """Return the nearest of 1, 2 and 5 times a power of ten, by their ratio.

    Args:
        size: size [m]; smaller ones than 0.1 mm count as that.
    """
    size = max(size, 1e-4)
    power = 10.0 ** math.floor(math.log10(size))
    nearest = min(_ROUND, key=lambda times: abs(math.log(size / (times * power))))
    return float(f"{nearest * power:.1g}")

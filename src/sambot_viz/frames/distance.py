"""How far two frames are from each other."""

from __future__ import annotations

import math
from dataclasses import dataclass

from sambot_viz.frames.frame_tree import FrameTree
from sambot_viz.geometry import Vector3


@dataclass(frozen=True, slots=True)
class FrameDistance:
    """Where the origin of a frame is, seen from another.

    Attributes:
        length: between the two origins [m].
        offset: of the second origin, along the axes of the first frame [m].
    """

    length: float
    offset: Vector3


def distance_between(tree: FrameTree, first: str, second: str) -> FrameDistance:
    """The distance of the origins of two frames.

    Raises:
        LookupRefused: a frame does not exist, or the two are not connected.
    """
    x, y, z = tree.lookup(first, second).translation.tolist()
    return FrameDistance(math.sqrt(x * x + y * y + z * z), (x, y, z))

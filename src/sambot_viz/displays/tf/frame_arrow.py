"""The arrow that TF draws from a frame to its parent."""

from __future__ import annotations

import math

from sambot_viz.displays.scene.solids import Arrow
from sambot_viz.geometry import Vector3

HEAD_LENGTH, HEAD_DIAMETER, SHAFT_DIAMETER = 0.1, 0.04, 0.01
SHORTEST_ARROW = 0.001
"""Frames nearer than this have no arrow [m]."""


def frame_arrow(at: Vector3, scale: float) -> Arrow | None:
    """The arrow from a frame to its parent, in the parent's coordinates.

    Args:
        at: origin of the frame in its parent [m].
        scale: Marker Scale.

    Returns:
        None when the frames are too close for an arrow.
    """
    distance = math.sqrt(sum(c * c for c in at))
    if distance <= SHORTEST_ARROW:
        return None
    head = HEAD_LENGTH * scale
    if distance < head:
        head *= distance
    shaft = max(0.0, distance - head)
    towards_parent = (-at[0], -at[1], -at[2])
    return Arrow(
        start=at,
        direction=towards_parent,
        shaft=(shaft, SHAFT_DIAMETER * scale),
        head=(head, HEAD_DIAMETER * scale),
    )

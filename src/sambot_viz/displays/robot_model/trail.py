"""The trail of a link: a ribbon behind its origin, as RViz draws it."""

from __future__ import annotations

import math
from collections import deque

import numpy as np
import viser

from sambot_viz.displays.scene.node_cache import remove_all
from sambot_viz.geometry import Vector3

COLOR = (0, 128, 128)
WIDTH = 0.01
ELEMENT = 0.02
"""Length of a piece [m]."""
MOST_ELEMENTS = 100


class Trail:
    """A line through the places where a frame has been, in the fixed frame.

    Args:
        scene: where to draw.
        name: node name.
    """

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        self._scene = scene
        self._name = name
        self._corners: deque[Vector3] = deque(maxlen=MOST_ELEMENTS)
        self._head: Vector3 | None = None
        self._node: viser.LineSegmentsHandle | None = None
        self._visible = True

    def follow(self, at: Vector3) -> None:
        """The frame is here now; nothing is sent unless it has moved."""
        if self._head is not None and math.dist(at, self._head) < 1e-6:
            return
        if not self._corners:
            self._corners.append(at)
        elif math.dist(at, self._corners[-1]) >= ELEMENT:
            self._corners.append(at)
        self._head = at
        points = [*self._corners]
        if points[-1] != at:
            points.append(at)
        if len(points) < 2:
            return
        segments = np.stack([points[:-1], points[1:]], axis=1).astype(np.float32)
        if self._node is None:
            self._node = self._scene.add_line_segments(
                self._name, segments, colors=COLOR, thickness=WIDTH
            )
            self._node.visible = self._visible
        else:
            self._node.points = segments

    def show(self, visible: bool) -> None:
        """Show or hide it; it goes on growing while it is hidden."""
        self._visible = visible
        if self._node is not None:
            self._node.visible = visible

    def remove(self) -> None:
        """Take it out of the scene and forget the way."""
        if self._node is not None:
            remove_all([self._node])
            self._node = None
        self._corners.clear()
        self._head = None

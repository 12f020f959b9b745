"""Axes: the axes of one frame, larger than those that TF draws."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.scene.frame_nodes import NodeCache
from sambot_viz.displays.scene.solids import add_axes, axes_triangles
from sambot_viz.displays.scene_size import SceneSize, round_size
from sambot_viz.displays.triangle_display import DrawnTriangles, TriangleDisplay
from sambot_viz.rviz import (
    FIXED_FRAME,
    DisplayConfig,
    FloatProperty,
    KeptProperty,
    TfFrameProperty,
)

OF_ROS1 = "of ROS 1; RViz for ROS 2 ignores it"


class AxesDisplay(TriangleDisplay):
    """Axes at the origin of its reference frame."""

    kind = "rviz_default_plugins/Axes"
    properties = (
        TfFrameProperty(
            "Reference Frame",
            default=FIXED_FRAME,
            help="The frame whose axes are drawn.",
        ),
        FloatProperty(
            "Length", default=1.0, minimum=0.0001, unit="m", help="Length of each axis."
        ),
        FloatProperty(
            "Radius",
            default=0.1,
            minimum=0.0001,
            unit="m",
            help="Thickness of each axis; as in RViz this is its diameter.",
        ),
        KeptProperty("Alpha", support="none", note=OF_ROS1),
        KeptProperty("Show Trail", support="none", note=OF_ROS1),
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._nodes = NodeCache()

    @classmethod
    def size_values(cls, size: SceneSize) -> Mapping[str, float]:
        """Return axes half as long as the robot, in RViz's proportion."""
        length = round_size(size.length / 2)
        return {"Length": length, "Radius": length / 10}

    def draw(self) -> None:
        """Draw the axes, unless they are drawn already."""
        frame = self.context.frame(self.config.get("Reference Frame"))
        problem = self.context.lookup_problem(frame)
        if problem is not None:
            self.clear()
            self.status.set("Transform", "Error", problem)
            return
        self.status.set("Transform", "Ok", "Transform OK")
        name = f"{self.context.above(frame)}/{self.key}"
        length = float(self.config.get("Length"))
        diameter = float(self.config.get("Radius"))
        self._nodes.show(
            (name, length, diameter),
            lambda: (add_axes(self.context.scene, name, length, diameter),),
        )

    def drawn(self) -> Iterator[DrawnTriangles]:
        """Yield the axes, which are not selectable, as in RViz."""
        get = self.config.get
        if self._nodes.handles:
            axes = axes_triangles(float(get("Length")), float(get("Radius")))
            yield DrawnTriangles(
                axes, np.eye(4), self.context.frame(get("Reference Frame"))
            )

    def clear(self) -> None:
        """Take the axes out of the scene."""
        self._nodes.remove()

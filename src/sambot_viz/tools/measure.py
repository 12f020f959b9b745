"""Measure: the distance of two points that are clicked (§2.7)."""

from __future__ import annotations

import numpy as np
import viser

from sambot_viz.rviz import ColorProperty, ToolConfig
from sambot_viz.tools.tool import Ray, Tool, ToolContext
from sambot_viz.views.camera import Vector, add, length, subtract, times

COLOR = (128, 128, 0)


class MeasureTool(Tool):
    """First click: start; second: end; third: a new start. Esc takes the line away.

    RViz tells the length in its status bar only; here it stands at the line too. A
    page reports clicks and no moves of the mouse, so the line comes with the second
    click.
    """

    kind = "rviz_default_plugins/Measure"
    label = "Measure"
    key = "N"
    help = "Click on two points, on the robot or on the grid. Esc: start again."
    clicks = True
    properties = (
        ColorProperty("Line color", default=COLOR, help="Colour of the line."),
    )

    def __init__(self, desk: ToolContext, config: ToolConfig | None) -> None:
        """See `Tool`."""
        super().__init__(desk, config)
        self._points: list[Vector] = []
        self._drawn: list[viser.SceneNodeHandle] = []

    def click(self, ray: Ray) -> None:
        """See `Tool`: a click on the background does nothing."""
        hit = self.desk.pick(ray)
        if hit is None:
            return
        if len(self._points) == 2:
            self.cancel()
        self._points.append(hit.point)
        self._draw()

    def cancel(self) -> None:
        """See `Tool`."""
        self._points.clear()
        self._draw()

    def property_changed(self) -> None:
        """See `Tool`."""
        self._draw()

    @property
    def length(self) -> float | None:
        """The length measured [m]; None before the second point."""
        if len(self._points) < 2:
            return None
        return length(subtract(self._points[1], self._points[0]))

    def _draw(self) -> None:
        for node in self._drawn:
            node.remove()
        self._drawn.clear()
        if not self._points:
            self.desk.say("")
            return
        color = COLOR if self.config is None else self.config.get("Line color")
        scene = self.desk.scene
        start = self._points[0]
        if self.length is None:
            dot = scene.add_point_cloud(
                "/~measure.start",
                np.array([start], np.float32),
                color,
                point_size=0.01,
                point_shape="circle",
                point_shading="flat",
                precision="float32",
            )
            self._drawn.append(dot)
            self.desk.say("Click on the second point.")
            return
        end = self._points[1]
        line = scene.add_line_segments(
            "/~measure",
            np.array([[start, end]], np.float32),
            colors=color,
            thickness=2.0,
            thickness_units="screen",
        )
        middle = times(add(start, end), 0.5)
        label = scene.add_label(
            "/~measure.length", f"{self.length:.6g} m", position=middle
        )
        self._drawn += [line, label]
        self.desk.say(f"[Length: {self.length:.6g}m]")

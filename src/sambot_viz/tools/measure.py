"""Measure: the distance between two points that are clicked on."""

from __future__ import annotations

import numpy as np
import viser

from sambot_viz.rviz import ColorProperty, ToolConfig
from sambot_viz.tools.picking.hit import Hit
from sambot_viz.tools.picking.rays import Array
from sambot_viz.tools.tool import Click, Tool, ToolContext

COLOR = (128, 128, 0)


class MeasureTool(Tool):
    """First click: start; second: end; third: a new start. Esc removes the line.

    RViz shows the length in its status bar only; here it is written at the line too.
    A page reports clicks but not moves of the mouse, so the line appears with the
    second click.
    """

    kind = "rviz_default_plugins/Measure"
    label = "Measure"
    key = "N"
    help = "Click on two points, on the robot or on the grid. Esc: start again."
    clicks = True
    properties = (
        ColorProperty("Line color", default=COLOR, help="Colour of the line."),
    )

    def __init__(self, context: ToolContext, config: ToolConfig | None) -> None:
        """Nothing is measured at first."""
        super().__init__(context, config)
        self._points: list[Array] = []
        self._drawn: list[viser.SceneNodeHandle] = []

    def click(self, click: Click, hit: Hit) -> None:
        """Take a point; a click on the background does nothing."""
        if hit.point is None:
            return
        if len(self._points) == 2:
            self._points.clear()
        self._points.append(hit.point)
        self._draw()

    def cancel(self) -> None:
        """Forget the points and remove the line."""
        self._points.clear()
        self._draw()

    def property_changed(self) -> None:
        """Draw in the new colour."""
        self._draw()

    @property
    def length(self) -> float | None:
        """The measured length [m]; None before the second point."""
        if len(self._points) < 2:
            return None
        return float(np.linalg.norm(self._points[1] - self._points[0]))

    def _draw(self) -> None:
        for node in self._drawn:
            node.remove()
        self._drawn.clear()
        if not self._points:
            self.context.show_status("")
        elif self.length is None:
            self._drawn.append(self._add_start())
            self.context.show_status("Click on the second point.")
        else:
            self._drawn += self._add_line(self.length)
            self.context.show_status(f"[Length: {self.length:.6g}m]")

    @property
    def _color(self) -> tuple[int, int, int]:
        return COLOR if self.config is None else self.config.get("Line color")

    def _add_start(self) -> viser.SceneNodeHandle:
        return self.context.scene.add_point_cloud(
            "/~measure.start",
            np.array([self._points[0]], np.float32),
            self._color,
            point_size=0.01,
            point_shape="circle",
            point_shading="flat",
            precision="float32",
        )

    def _add_line(self, length: float) -> list[viser.SceneNodeHandle]:
        scene, points = self.context.scene, np.array(self._points)
        line = scene.add_line_segments(
            "/~measure",
            points[None].astype(np.float32),
            colors=self._color,
            thickness=2.0,
            thickness_units="screen",
        )
        label = scene.add_label(
            "/~measure.length", f"{length:.6g} m", position=points.mean(axis=0)
        )
        return [line, label]

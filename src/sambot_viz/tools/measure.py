"""Measure: the distance between two points that are clicked on."""

from __future__ import annotations

import numpy as np
import viser

from sambot_viz.displays.picking.rays import Array
from sambot_viz.displays.picking.selectable import Hit
from sambot_viz.rviz import ColorProperty, ToolConfig
from sambot_viz.tools.picking.snap import frame_at
from sambot_viz.tools.tool import Click, Tool, ToolContext
from sambot_viz.views.camera import components

COLOR = (128, 128, 0)
THICKNESS, RIM_THICKNESS = 3.0, 6.0
"""Of the line, and of the white one below it, which dark backgrounds need [pixels]."""
RIM = (255, 255, 255)


class MeasureTool(Tool):
    """First click: start; second: end; third: a new start.

    A point next to the origin of a frame in the picture is that origin, as in programs
    for CAD; RViz measures surfaces only. Between the first two, the line ends under the
    mouse. Esc or a right click removes it. The length is also written at the line,
    which RViz does not; and its line of one pixel can hardly be seen on a dark
    background: this one is thicker, with a rim.
    """

    kind = "rviz_default_plugins/Measure"
    label = "Measure"
    key = "N"
    help = "Click two points or frames; a right click starts again, Esc ends."
    touch = "Tap two points or frames; a third one starts again."
    clicks = True
    properties = (
        ColorProperty("Line color", default=COLOR, help="Colour of the line."),
    )

    def __init__(self, context: ToolContext, config: ToolConfig | None) -> None:
        """Nothing is measured at first."""
        super().__init__(context, config)
        self._start: Array | None = None
        self._end: Array | None = None
        self._finished = False
        self._names: list[str | None] = [None, None]
        self._dot: viser.PointCloudHandle | None = None
        self._lines: tuple[viser.LineSegmentsHandle, ...] = ()
        self._text: viser.LabelHandle | None = None

    @property
    def wants_hover(self) -> bool:
        """The line ends under the mouse until its end is clicked on."""
        return self._start is not None and not self._finished

    def click(self, click: Click, hit: Hit) -> None:
        """Take a point; a click on the background does nothing."""
        point, frame = self._meant(click, hit)
        if point is None:
            return
        if self.wants_hover:
            self._end, self._finished = point, True
            self._names[1] = frame
        else:
            self._start, self._end, self._finished = point, None, False
            self._names = [frame, None]
        self._draw()

    def hover(self, click: Click, hit: Hit) -> None:
        """End the line under the mouse; over the background it stays."""
        point, frame = self._meant(click, hit)
        if self.wants_hover and point is not None:
            self._end, self._names[1] = point, frame
            self._draw()

    def _meant(self, click: Click, hit: Hit) -> tuple[Array | None, str | None]:
        """Return the point of a click, and the frame that it is the origin of."""
        origins = self.context.frame_origins()
        frame = frame_at(click, origins)
        return (hit.point, None) if frame is None else (origins[frame], frame)

    def left(self) -> None:
        """Forget a start without an end, as RViz begins again; a whole line stays."""
        if self.wants_hover:
            self.cancel()

    def cancel(self) -> None:
        """Forget the points and remove the line."""
        self._start, self._end, self._finished = None, None, False
        self._draw()

    def property_changed(self) -> None:
        """Draw in the new colour."""
        self._clear()
        self._draw()

    @property
    def length(self) -> float | None:
        """The measured length [m]; None before there are two points."""
        if self._start is None or self._end is None:
            return None
        return float(np.linalg.norm(self._end - self._start))

    def _draw(self) -> None:
        """Draw the start or the line; a line that follows the mouse is only moved."""
        if self._start is None:
            self._clear()
            self.context.show_status("")
        elif self._end is None:
            self._clear()
            self._dot = self._add_dot(self._start)
            begin = f"From {self._names[0]}. " if self._names[0] else ""
            self.context.show_status(f"{begin}Click the second point.")
        else:
            self._draw_line(self._start, self._end)
            ends = zip(("from", "to"), self._names, strict=True)
            between = "".join(f" {way} {name}" for way, name in ends if name)
            self.context.show_status(f"{self.length:.6g} m{between}. {self.help}")

    def _draw_line(self, start: Array, end: Array) -> None:
        points = np.array([[start, end]], np.float32)
        length, middle = f"{self.length:.6g} m", components((start + end) / 2)
        if self._lines and self._text is not None:
            for line in self._lines:
                line.points = points
            self._text.text, self._text.position = length, middle
            return
        self._clear()
        scene = self.context.scene
        # What is as near and was added later is drawn over it.
        looks = (".rim", RIM, RIM_THICKNESS), ("", self._color, THICKNESS)
        self._lines = tuple(
            scene.add_line_segments(
                f"/~measure{name}",
                points,
                colors=color,
                thickness=thickness,
                thickness_units="screen",
            )
            for name, color, thickness in looks
        )
        # A label of constant size on the screen has a background, unlike RViz's names.
        self._text = scene.add_label(
            "/~measure.length",
            length,
            position=middle,
            font_screen_scale=1.5,
            anchor="bottom-center",
        )

    def _add_dot(self, start: Array) -> viser.PointCloudHandle:
        return self.context.scene.add_point_cloud(
            "/~measure.start",
            start[None].astype(np.float32),
            self._color,
            point_size=0.015,
            point_shape="circle",
            point_shading="flat",
            precision="float32",
        )

    def _clear(self) -> None:
        for node in (self._dot, *self._lines, self._text):
            if node is not None:
                node.remove()
        self._dot = self._text = None
        self._lines = ()

    @property
    def _color(self) -> tuple[int, int, int]:
        return COLOR if self.config is None else self.config.get("Line color")

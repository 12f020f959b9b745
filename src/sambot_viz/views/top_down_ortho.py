"""TopDownOrtho: a map's view from above, without perspective."""

from __future__ import annotations

import math

import numpy as np

from sambot_viz.rviz import FloatProperty, Property
from sambot_viz.views.camera import (
    FILLED_HEIGHT,
    FILLED_WIDTH,
    ORTHO_HEIGHT,
    Camera,
    Vector,
    Vectors,
    vector,
)
from sambot_viz.views.orbit import OrbitView
from sambot_viz.views.view import COMMON_PROPERTIES, Values, View

TOP_DOWN_ORTHO_PROPERTIES: tuple[Property, ...] = (
    *COMMON_PROPERTIES,
    FloatProperty("Scale", default=10.0, help="Pixels of the picture per metre."),
    FloatProperty(
        "Angle",
        default=0.0,
        unit="rad",
        help="How far the picture is turned about the vertical.",
    ),
    FloatProperty("X", default=0.0, unit="m", help="The middle of the picture."),
    FloatProperty("Y", default=0.0, unit="m", help="The middle of the picture."),
)
SMALLEST_SCALE = 1e-3
"""A page cannot draw a smaller one [pixels per metre]."""


class TopDownOrthoView(View):
    """From straight above, without perspective.

    viser has no orthographic camera: the page draws `Camera.as_perspective`.
    """

    kind = "rviz_default_plugins/TopDownOrtho"
    help = "Looks straight down, without perspective."
    properties = TOP_DOWN_ORTHO_PROPERTIES
    from_above = True
    nearness = "Scale"

    @property
    def scale(self) -> float:
        """Pixels per metre."""
        scale = abs(float(self.config.get("Scale")))
        return max(scale, SMALLEST_SCALE)

    def local_camera(self) -> Camera:
        """Straight above (X, Y), looking down."""
        x, y, angle = (float(self.config.get(name)) for name in ("X", "Y", "Angle"))
        up = vector(-math.sin(angle), math.cos(angle), 0.0)
        above, below = vector(x, y, ORTHO_HEIGHT), vector(x, y, 0.0)
        return Camera(above, below, up, near=self.near, scale=self.scale)

    def read_local(self, camera: Camera) -> Values:
        """Return the middle and the turn of the picture; the height does not matter."""
        up, scale = camera.image_up, camera.scale or self.scale
        angle = math.atan2(-up[0], up[1])
        return {"Scale": scale, "Angle": angle, **self.look_at_local(camera.look_at)}

    def look_at_local(self, point: Vector) -> Values:
        """Scale and angle stay."""
        return {"X": float(point[0]), "Y": float(point[1])}

    def fit_local(self, points: Vectors, width: int, height: int) -> Values:
        """Put the middle of the points into the middle of the picture."""
        camera, middle = self.local_camera(), points.mean(axis=0)
        across = float(np.ptp(points @ camera.right))
        upwards = float(np.ptp(points @ camera.image_up))
        scales = (FILLED_WIDTH * width / across, FILLED_HEIGHT * height / upwards)
        return {"Scale": min(scales), **self.look_at_local(middle)}

    def mimic(self, old: View) -> Values:
        """Comes to the focal point or the camera of the old view."""
        if isinstance(old, TopDownOrthoView):
            return {n: old.config.get(n) for n in ("Scale", "Angle", "X", "Y")}
        if isinstance(old, OrbitView):
            return self.look_at_local(old.focal_point)
        return self.look_at_local(old.local_camera().position)

    def zero(self) -> Values:
        """Return the origin in the middle, at 10 pixels per metre."""
        return {"Scale": 10.0, "Angle": 0.0, "X": 0.0, "Y": 0.0}

    def shifted(self, offset: Vector) -> Values:
        """Moves the middle; RViz turns the offset by Angle, which moves the picture."""
        return self.look_at_local(self.local_camera().look_at + offset)

"""TopDownOrtho: a map's view from above, without perspective (§1.7)."""

from __future__ import annotations

import math

from sambot_viz.rviz import FloatProperty, Property
from sambot_viz.views.camera import ORTHO_HEIGHT, Camera, Vector
from sambot_viz.views.common import COMMON_PROPERTIES
from sambot_viz.views.orbit import OrbitView
from sambot_viz.views.view import Values, View

TOP_DOWN_ORTHO_PROPERTIES: tuple[Property, ...] = (
    *COMMON_PROPERTIES,
    FloatProperty(
        "Scale", default=10.0, help="How many pixels of the picture are one metre."
    ),
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

    viser has no orthographic camera: `Camera.in_perspective` says what is drawn.
    """

    kind = "rviz_default_plugins/TopDownOrtho"
    help = "Looks straight down, without perspective."
    properties = TOP_DOWN_ORTHO_PROPERTIES
    orthographic = True

    @property
    def scale(self) -> float:
        """Pixels per metre."""
        scale = abs(float(self.config.get("Scale")))
        return max(scale, SMALLEST_SCALE)

    def local_camera(self) -> Camera:
        """See `View`."""
        x, y, angle = (float(self.config.get(name)) for name in ("X", "Y", "Angle"))
        up = (-math.sin(angle), math.cos(angle), 0.0)
        above = (x, y, ORTHO_HEIGHT)
        return Camera(above, (x, y, 0.0), up, near=self.near, scale=self.scale)

    def read_local(self, camera: Camera) -> Values:
        """See `View`."""
        up, scale = camera.image_up, camera.scale or self.scale
        x, y, _ = camera.look_at
        return {"Scale": scale, "Angle": math.atan2(-up[0], up[1]), "X": x, "Y": y}

    def look_at_local(self, point: Vector) -> Values:
        """See `View`: scale and angle stay."""
        return {"X": point[0], "Y": point[1]}

    def mimic(self, old: View) -> Values:
        """See `View`."""
        if isinstance(old, TopDownOrthoView):
            return {n: old.config.get(n) for n in ("Scale", "Angle", "X", "Y")}
        if isinstance(old, OrbitView):
            return self.look_at_local(old.focal_point)
        return self.look_at_local(old.local_camera().position)

    def zero(self) -> Values:
        """See `View`."""
        return {"Scale": 10.0, "Angle": 0.0, "X": 0.0, "Y": 0.0}

    def shifted(self, offset: Vector) -> Values:
        """See `View`; RViz turns the offset by Angle, which moves the picture."""
        x, y = (float(self.config.get(name)) for name in ("X", "Y"))
        return {"X": x + offset[0], "Y": y + offset[1]}

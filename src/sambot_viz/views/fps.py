"""FPS: a camera that stands somewhere and turns its head (§1.8)."""

from __future__ import annotations

from sambot_viz.rviz import FloatProperty, Property, VectorProperty
from sambot_viz.views.camera import (
    Camera,
    Vector,
    add,
    angles_of,
    on_sphere,
    subtract,
    times,
)
from sambot_viz.views.common import COMMON_PROPERTIES
from sambot_viz.views.view import STEEPEST, Values, View

FPS_PROPERTIES: tuple[Property, ...] = (
    *COMMON_PROPERTIES,
    FloatProperty(
        "Yaw", default=0.0, unit="rad", help="Where it looks, about the vertical."
    ),
    FloatProperty(
        "Pitch",
        default=0.0,
        minimum=-STEEPEST,
        maximum=STEEPEST,
        unit="rad",
        help="How far it looks down.",
    ),
    VectorProperty(
        "Position",
        default=(5.0, 5.0, 10.0),
        unit="m",
        help="Where the camera stands, in the target frame.",
    ),
)
ZERO_POSITION: Vector = (5.0, 5.0, 10.0)
ARM = 0.01
"""A page turns its camera about a point; this near, it turns on the spot [m]."""


class FPSView(View):
    """Stands at a place and looks round."""

    kind = "rviz_default_plugins/FPS"
    help = "Stands at a place and looks round, as in a first-person game."
    properties = FPS_PROPERTIES

    @property
    def position(self) -> Vector:
        """Where the camera stands in the target frame [m]."""
        x, y, z = self.config.get("Position")
        return (float(x), float(y), float(z))

    def local_camera(self) -> Camera:
        """See `View`."""
        yaw, pitch = (float(self.config.get(name)) for name in ("Yaw", "Pitch"))
        ahead = add(self.position, times(on_sphere(yaw, -pitch), ARM))
        return Camera(self.position, ahead, near=self.near)

    def read_local(self, camera: Camera) -> Values:
        """See `View`: a roll is lost."""
        return {"Position": camera.position, **_looking(camera.forward)}

    def look_at_local(self, point: Vector) -> Values:
        """See `View`: the position stays."""
        return _looking(subtract(point, self.position))

    def mimic(self, old: View) -> Values:
        """See `View`."""
        return self.read_local(old.local_camera())

    def zero(self) -> Values:
        """See `View`: at (5, 5, 10), looking at the origin."""
        return {
            "Position": ZERO_POSITION,
            **_looking(subtract((0.0, 0.0, 0.0), ZERO_POSITION)),
        }

    def shifted(self, offset: Vector) -> Values:
        """See `View`."""
        return {"Position": add(self.position, offset)}


def _looking(direction: Vector) -> Values:
    yaw, elevation = angles_of(direction)
    return {"Yaw": yaw, "Pitch": max(-STEEPEST, min(STEEPEST, -elevation))}

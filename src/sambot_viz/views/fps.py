"""FPS: a camera with a position and a direction, as in a first-person game."""

from __future__ import annotations

from sambot_viz.rviz import FloatProperty, KeptProperty, Property, VectorProperty
from sambot_viz.views.camera import (
    FIELD_OF_VIEW,
    UP,
    Camera,
    Vector,
    Vectors,
    angles_of,
    components,
    on_sphere,
    vector,
)
from sambot_viz.views.view import COMMON_PROPERTIES, STEEPEST, Values, View

FPS_PROPERTIES: tuple[Property, ...] = (
    *COMMON_PROPERTIES,
    FloatProperty(
        "Yaw", default=0.0, unit="rad", help="Direction of view, about the vertical."
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
        help="Position of the camera, in the target frame.",
    ),
    KeptProperty("Roll", support="none", note="of ROS 1; RViz for ROS 2 ignores it"),
)
ZERO_POSITION = vector(5.0, 5.0, 10.0)
ARM = 0.01
"""A page turns its camera about a point; with one this near, it turns in place [m]."""


class FPSView(View):
    """Stays at a position and looks around."""

    kind = "rviz_default_plugins/FPS"
    help = "Stays at a position and looks around, as in a first-person game."
    properties = FPS_PROPERTIES
    nearness = "Position"

    @property
    def position(self) -> Vector:
        """Position of the camera in the target frame [m]."""
        return vector(*self.config.get("Position"))

    def local_camera(self) -> Camera:
        """Looks down for a positive pitch."""
        yaw, pitch = (float(self.config.get(name)) for name in ("Yaw", "Pitch"))
        ahead = self.position + ARM * on_sphere(yaw, -pitch)
        return Camera(self.position, ahead, UP, near=self.near)

    def read_local(self, camera: Camera) -> Values:
        """Read position, yaw and pitch; a roll of the camera is lost."""
        return {"Position": components(camera.position), **_looking(camera.forward)}

    def look_at_local(self, point: Vector) -> Values:
        """Turn towards a point; the position stays."""
        return _looking(point - self.position)

    def fit_local(self, points: Vectors, width: int, height: int) -> Values:
        """Move the camera to where it has the points in front of it."""
        camera = self.local_camera()
        away = camera.distance_to_show(points, width / height) * camera.forward
        return {"Position": components(points.mean(axis=0) - away)}

    def mimic(self, old: View) -> Values:
        """Takes over the camera of the old view."""
        return self.read_local(old.local_camera().with_fov(FIELD_OF_VIEW))

    def zero(self) -> Values:
        """At (5, 5, 10), looking at the origin."""
        return {"Position": components(ZERO_POSITION), **_looking(-ZERO_POSITION)}

    def shifted(self, offset: Vector) -> Values:
        """Moves the camera."""
        return {"Position": components(self.position + offset)}


def _looking(direction: Vector) -> Values:
    yaw, elevation = angles_of(direction)
    return {"Yaw": yaw, "Pitch": max(-STEEPEST, min(STEEPEST, -elevation))}

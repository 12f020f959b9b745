"""Orbit: round a focal point, at a distance (spec/rviz-core.md §8.3)."""

from __future__ import annotations

import math

from sambot_viz.rviz import BoolProperty, FloatProperty, Property, VectorProperty
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

ORBIT_PROPERTIES: tuple[Property, ...] = (
    *COMMON_PROPERTIES,
    FloatProperty(
        "Distance",
        default=10.0,
        minimum=0.001,
        unit="m",
        help="From the focal point to the camera.",
    ),
    FloatProperty(
        "Focal Shape Size",
        default=0.05,
        minimum=0.001,
        unit="m",
        help="Size of the mark at the focal point while the mouse moves the view.",
        support="none",
    ),
    BoolProperty(
        "Focal Shape Fixed Size",
        default=True,
        help="Keep the size of that mark in metres, not on the screen.",
        support="none",
    ),
    FloatProperty(
        "Yaw",
        default=math.pi / 4,
        unit="rad",
        help="Where the camera stands around the vertical through the focal point.",
    ),
    FloatProperty(
        "Pitch",
        default=math.pi / 4,
        minimum=-STEEPEST,
        maximum=STEEPEST,
        unit="rad",
        help="How high the camera stands above the focal point.",
    ),
    VectorProperty(
        "Focal Point",
        default=(0.0, 0.0, 0.0),
        unit="m",
        help="The point the camera looks at, in the target frame.",
    ),
)


class OrbitView(View):
    """Round a focal point, at a distance."""

    kind = "rviz_default_plugins/Orbit"
    help = "Moves round a focal point."
    properties = ORBIT_PROPERTIES

    @property
    def distance(self) -> float:
        """From the focal point to the camera [m]."""
        return float(self.config.get("Distance"))

    @property
    def focal_point(self) -> Vector:
        """Focal point in the target frame [m]."""
        x, y, z = self.config.get("Focal Point")
        return (float(x), float(y), float(z))

    def local_camera(self) -> Camera:
        """See `View`: the formula of §1.4."""
        sign = self._sign
        yaw, pitch = (float(self.config.get(name)) for name in ("Yaw", "Pitch"))
        focal = self.focal_point
        away = times(on_sphere(sign * yaw, sign * pitch), self.distance)
        return Camera(add(focal, away), focal, (0.0, 0.0, sign), near=self.near)

    def read_local(self, camera: Camera) -> Values:
        """See `View`."""
        return self._round(camera.position, camera.look_at)

    def look_at_local(self, point: Vector) -> Values:
        """See `View`: the camera turns where it stands (§1.4)."""
        return self._round(self.local_camera().position, point)

    def mimic(self, old: View) -> Values:
        """See `View`."""
        camera = old.local_camera()
        if old.orthographic:
            x, y, _ = camera.look_at
            return {
                "Distance": 100.0,
                "Focal Point": (x, y, 0.0),
                "Yaw": -math.pi / 2,
                "Pitch": STEEPEST,
            }
        if type(old) is OrbitView:
            return self._round(camera.position, old.focal_point, old.distance)
        away = math.hypot(*camera.position)
        focal = add(camera.position, times(camera.forward, away))
        return self._round(camera.position, focal)

    def zero(self) -> Values:
        """See `View`; RViz also stops fixing the size of the focal mark (§1.4)."""
        return {
            "Yaw": math.pi / 4,
            "Pitch": math.pi / 4,
            "Distance": 10.0,
            "Focal Shape Size": 0.05,
            "Focal Shape Fixed Size": False,
            "Focal Point": (0.0, 0.0, 0.0),
        }

    def shifted(self, offset: Vector) -> Values:
        """See `View`."""
        return {"Focal Point": add(self.focal_point, offset)}

    @property
    def _sign(self) -> float:
        return -1.0 if self.config.get("Invert Z Axis") else 1.0

    def _round(
        self, position: Vector, focal: Vector, distance: float | None = None
    ) -> Values:
        """The properties of a camera that stands at `position` and sees `focal`."""
        away = subtract(position, focal)
        yaw, pitch = angles_of(away)
        sign = self._sign
        return {
            "Distance": math.hypot(*away) if distance is None else distance,
            "Focal Point": focal,
            "Yaw": sign * yaw % (2.0 * math.pi),
            "Pitch": sign * pitch,
        }

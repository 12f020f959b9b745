"""Orbit: a camera on a sphere around a focal point."""

from __future__ import annotations

import math

from sambot_viz.rviz import BoolProperty, FloatProperty, Property, VectorProperty
from sambot_viz.views.camera import (
    FIELD_OF_VIEW,
    ORTHO_FIELD_OF_VIEW,
    Camera,
    Vector,
    Vectors,
    angles_of,
    components,
    length,
    on_sphere,
    vector,
)
from sambot_viz.views.view import COMMON_PROPERTIES, STEEPEST, Values, View

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
        help="Size of the disc at the focal point while the mouse moves the view.",
    ),
    BoolProperty(
        "Focal Shape Fixed Size",
        default=True,
        help="Keep the size of that disc in metres, not in pixels.",
    ),
    FloatProperty(
        "Yaw",
        default=math.pi / 4,
        unit="rad",
        help="Direction from the focal point to the camera, about the vertical.",
    ),
    FloatProperty(
        "Pitch",
        default=math.pi / 4,
        minimum=-STEEPEST,
        maximum=STEEPEST,
        unit="rad",
        help="Elevation of the camera above the focal point.",
    ),
    VectorProperty(
        "Focal Point",
        default=(0.0, 0.0, 0.0),
        unit="m",
        help="The point the camera looks at, in the target frame.",
    ),
)


ORTHOGRAPHIC = "Orthographic"
SIDES = {
    "front": 0.0,
    "left": math.pi / 2,
    "back": math.pi,
    "right": 3.0 * math.pi / 2,
}
"""Side of a robot → the yaw from which it is seen [rad]; x points forward."""


class OrbitView(View):
    """Looks at a focal point from a distance."""

    kind = "rviz_default_plugins/Orbit"
    help = "Moves around a focal point."
    properties = (
        *ORBIT_PROPERTIES,
        BoolProperty(
            ORTHOGRAPHIC,
            default=False,
            help="Keep parallel lines parallel, as in a drawing; RViz ignores it, and "
            "shows the same side in perspective.",
        ),
    )

    @property
    def orthographic(self) -> bool:
        """Whether parallel lines stay parallel in its picture."""
        return ORTHOGRAPHIC in self.config.declared and self.config.get(ORTHOGRAPHIC)

    @property
    def distance(self) -> float:
        """From the focal point to the camera [m]."""
        return float(self.config.get("Distance"))

    @property
    def focal_point(self) -> Vector:
        """Focal point in the target frame [m]."""
        return vector(*self.config.get("Focal Point"))

    def local_camera(self) -> Camera:
        """Return the camera, at yaw and pitch as seen from the focal point.

        With Invert Z Axis all of it is mirrored: both angles, and up.
        """
        sign = self._sign
        yaw, pitch = (float(self.config.get(name)) for name in ("Yaw", "Pitch"))
        focal = self.focal_point
        away = self.distance * on_sphere(sign * yaw, sign * pitch)
        camera = Camera(focal + away, focal, vector(0.0, 0.0, sign), near=self.near)
        return camera.with_fov(ORTHO_FIELD_OF_VIEW) if self.orthographic else camera

    def read_local(self, camera: Camera) -> Values:
        """Make the middle of the picture the focal point."""
        if camera.is_parallel:
            camera = camera.with_fov(FIELD_OF_VIEW)
        return self._around(camera.position, camera.look_at)

    def look_at_local(self, point: Vector) -> Values:
        """Turn the camera in place, as RViz does; without perspective, move it."""
        if self.orthographic:
            return {"Focal Point": components(point)}
        return self._around(self.local_camera().position, point)

    def fit_local(self, points: Vectors, width: int, height: int) -> Values:
        """Make the middle of the points the focal point."""
        camera, middle = self.local_camera(), points.mean(axis=0)
        away = camera.distance_to_show(points, width / height) * camera.forward
        fitted = camera.placed(middle - away, middle, camera.up)
        return {
            "Distance": fitted.with_fov(FIELD_OF_VIEW).distance,
            "Focal Point": components(middle),
        }

    def mimic(self, old: View) -> Values:
        """Keeps the picture; from above it looks down from 100 m, as in RViz."""
        camera = old.local_camera().with_fov(FIELD_OF_VIEW)
        if old.from_above:
            x, y, _ = camera.look_at
            return {
                "Distance": 100.0,
                "Focal Point": (float(x), float(y), 0.0),
                "Yaw": -math.pi / 2,
                "Pitch": STEEPEST,
            }
        if type(old) is OrbitView:
            return self._around(camera.position, old.focal_point, old.distance)
        focal = camera.position + length(camera.position) * camera.forward
        return self._around(camera.position, focal)

    def zero(self) -> Values:
        """Return what RViz sets: Focal Shape Fixed Size is false, not its default."""
        values: Values = {
            "Yaw": math.pi / 4,
            "Pitch": math.pi / 4,
            "Distance": 10.0,
            "Focal Shape Size": 0.05,
            "Focal Shape Fixed Size": False,
            "Focal Point": (0.0, 0.0, 0.0),
        }
        return {**values, ORTHOGRAPHIC: False} if self.orthographic else values

    def shifted(self, offset: Vector) -> Values:
        """Moves the focal point."""
        return {"Focal Point": components(self.focal_point + offset)}

    @property
    def _sign(self) -> float:
        return -1.0 if self.config.get("Invert Z Axis") else 1.0

    def _around(
        self, position: Vector, focal: Vector, distance: float | None = None
    ) -> Values:
        """Return the properties of a camera at `position` that looks at `focal`."""
        away = position - focal
        yaw, pitch = angles_of(away)
        sign = self._sign
        return {
            "Distance": length(away) if distance is None else distance,
            "Focal Point": components(focal),
            "Yaw": sign * yaw % (2.0 * math.pi),
            "Pitch": sign * pitch,
        }

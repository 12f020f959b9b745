"""XYOrbit, with the focal point on the ground; ThirdPersonFollower, which turns too."""

from __future__ import annotations

from sambot_viz.views.camera import (
    FIELD_OF_VIEW,
    Camera,
    Vector,
    Vectors,
    components,
    length,
)
from sambot_viz.views.orbit import ORBIT_PROPERTIES, OrbitView
from sambot_viz.views.view import Values, View

RAISED = 0.2
"""The camera is higher than Orbit's by this part of the distance."""


class XYOrbitView(OrbitView):
    """Looks at a point of the ground."""

    kind = "rviz_default_plugins/XYOrbit"
    help = "Moves around a point on the ground, low in the picture."
    properties = ORBIT_PROPERTIES

    def local_camera(self) -> Camera:
        """Return the camera of Orbit, moved up in its picture."""
        camera = super().local_camera()
        up = RAISED * self.distance * camera.image_up
        return camera.placed(camera.position + up, camera.look_at + up, camera.up)

    def read_local(self, camera: Camera) -> Values:
        """Return the properties of a raised camera."""
        down = -RAISED * length(camera.look_at - camera.position) * camera.image_up
        return self._around(camera.position + down, camera.look_at + down)

    def look_at_local(self, point: Vector) -> Values:
        """Turn to a point, with the focal point on the ground."""
        on_ground = point * (1.0, 1.0, 0.0)
        return self._around(self.local_camera().position, on_ground)

    def fit_local(self, points: Vectors, width: int, height: int) -> Values:
        """Put the middle of the points into the middle of the picture."""
        camera, middle = self.local_camera(), points.mean(axis=0)
        distance = camera.distance_to_show(points, width / height)
        focal = middle - RAISED * distance * camera.image_up
        return {"Distance": distance, "Focal Point": components(focal)}

    def mimic(self, old: View) -> Values:
        """Keeps the picture where its middle and the camera are above the ground."""
        if old.from_above:
            return super().mimic(old)
        camera = old.local_camera().with_fov(FIELD_OF_VIEW)
        down = -camera.image_up
        ahead = _to_ground(camera.position, camera.forward)
        below = _to_ground(camera.position, down)
        if ahead is None or below is None:
            return {}
        distance = below * ahead / (RAISED * ahead + below)
        position = camera.position + RAISED * distance * down
        reach = _to_ground(position, camera.forward)
        if reach is None:
            return {}
        focal = position + reach * camera.forward
        return self._around(position, focal, distance)


def _to_ground(origin: Vector, direction: Vector) -> float | None:
    """Distance along a ray to the plane z = 0 [m]; None when the ray misses it."""
    if direction[2] == 0.0:
        return None
    reach = float(-origin[2] / direction[2])
    return reach if reach > 0.0 else None


class ThirdPersonFollowerView(XYOrbitView):
    """Follows position and yaw of the target frame, not its roll and pitch."""

    kind = "rviz_default_plugins/ThirdPersonFollower"
    help = "Follows the target frame and turns with it."
    follows_yaw = True

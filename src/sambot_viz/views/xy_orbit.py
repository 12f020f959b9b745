"""XYOrbit: Orbit with the focal point on the ground, low in the picture (§1.5)."""

from __future__ import annotations

from sambot_viz.views.camera import Camera, Vector, add, length, subtract, times
from sambot_viz.views.orbit import OrbitView
from sambot_viz.views.view import Values, View

RAISED = 0.2
"""The camera stands higher than Orbit's by this part of the distance."""


class XYOrbitView(OrbitView):
    """Round a point of the ground.

    A page turns the camera about the middle of the picture, which is above the focal
    point; RViz turns it about the focal point itself. What the camera shows then is
    kept exactly, so the focal point may leave the ground a little.
    """

    kind = "rviz_default_plugins/XYOrbit"
    help = "Moves round a point of the ground, which stays low in the picture."

    def local_camera(self) -> Camera:
        """See `View`."""
        camera = super().local_camera()
        raised = times(camera.image_up, RAISED * self.distance)
        return camera.placed(
            add(camera.position, raised), add(camera.look_at, raised), camera.up
        )

    def read_local(self, camera: Camera) -> Values:
        """See `View`."""
        return self._lowered(camera.position, camera.look_at, camera)

    def look_at_local(self, point: Vector) -> Values:
        """See `View`: the new focal point is on the ground."""
        return self._round(self.local_camera().position, (point[0], point[1], 0.0))

    def mimic(self, old: View) -> Values:
        """See `View`: what is in the middle of the picture comes to the ground."""
        if old.orthographic:
            return super().mimic(old)
        camera = old.local_camera()
        down = times(camera.image_up, -1.0)
        ahead = _to_ground(camera.position, camera.forward)
        below = _to_ground(camera.position, down)
        if ahead is None or below is None:
            return {}
        distance = below * ahead / (RAISED * ahead + below)
        position = add(camera.position, times(down, RAISED * distance))
        reach = _to_ground(position, camera.forward)
        if reach is None:
            return {}
        focal = add(position, times(camera.forward, reach))
        return self._round(position, focal, distance)

    def _lowered(self, position: Vector, middle: Vector, camera: Camera) -> Values:
        """The properties of a raised camera that looks at `middle`."""
        distance = length(subtract(middle, position))
        lowered = times(camera.image_up, -RAISED * distance)
        return self._round(add(position, lowered), add(middle, lowered))


def _to_ground(origin: Vector, direction: Vector) -> float | None:
    """How far along a ray the plane z = 0 is [m]; None when it never comes."""
    if direction[2] == 0.0:
        return None
    reach = -origin[2] / direction[2]
    return reach if reach > 0.0 else None

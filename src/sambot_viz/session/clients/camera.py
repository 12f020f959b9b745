"""The camera of one client: sent to it, and read back when a mouse has moved it.

viser's camera turns about a point in front of it, with a fixed up direction, and in
perspective. An orthographic view is drawn by a far camera with a small field of view
(`Camera.as_perspective`); that of TopDownOrtho looks almost straight down.
"""

from __future__ import annotations

import time

import numpy as np
import viser

from sambot_viz.geometry import rotation_from_xyzw
from sambot_viz.views.camera import (
    FIELD_OF_VIEW,
    ORTHO_FIELD_OF_VIEW,
    UP,
    WIDEST_ORTHO,
    Camera,
    Vector,
    components,
    length,
)

VISER_FIRST_POSITION = (3.0, 3.0, 3.0)
"""Position of the camera in a page that viser has just opened [m]."""
ECHO_TIME = 8.0
"""A page answers a new camera within this time, also while it loads [s]."""
POLE = 1e-5
"""A camera that looks down leans by this angle, which defines "up" in its picture
[rad]."""
CLOSE = 0.1
"""For a nearer target, viser may ignore a small change of direction [m]."""
SAME_WAY = 1e-6
"""A camera at rest looks at its target, with at most this deviation [rad]."""
FARTHEST = 1e12
"""A camera with larger numbers is not taken from a browser [m]."""
STRAIGHT_DOWN = 2e-3
"""A camera that leans by less looks straight down: a page that has just been told of
TopDownOrtho still keeps its camera 0.001 away from the pole [rad]."""

Report = tuple[int, Camera | None]
"""The height of a browser's picture [pixels], and its camera."""
_START = Camera(np.array(VISER_FIRST_POSITION), np.zeros(3), UP)


class ClientCamera:
    """One client's camera.

    Attributes:
        client: the browser.
        camera: its camera in the fixed frame.
    """

    def __init__(self, client: viser.ClientHandle) -> None:
        self.client = client
        self._height = max(1, client.camera.image_height)
        self.camera = self.report()[1] or _START
        self._answered_by: float | None = None

    @property
    def is_fresh(self) -> bool:
        """Whether the page was just opened, and its camera has not been moved."""
        return np.allclose(self.client.camera.position, VISER_FIRST_POSITION, atol=1e-3)

    def point(
        self, camera: Camera, ortho_fov: float | None = ORTHO_FIELD_OF_VIEW
    ) -> None:
        """Send the browser a camera of the fixed frame.

        Args:
            camera: where to look from.
            ortho_fov: the field of view that an orthographic camera is drawn with
                [rad]; None draws it from 500 m above (`Camera.as_perspective`).
        """
        same = not camera.orthographic and same_picture(camera, self.camera)
        self.camera = camera
        if not same or self._answered_by is not None:
            # A page that shows that picture already reports nothing.
            self._answered_by = time.monotonic() + ECHO_TIME
        drawn = camera.as_perspective(self._height, ortho_fov)
        position, up = drawn.position, drawn.up
        if camera.orthographic:
            position = position - POLE * drawn.distance * drawn.image_up
            up = UP
        handle = self.client.camera
        with self.client.atomic():
            handle.min_orbit_distance = 0.001
            handle.max_orbit_distance = float("inf")
            handle.up_direction = components(up)
            handle.position = components(position)
            if drawn.distance < CLOSE:
                handle.look_at = components(drawn.look_at + 1.0)
            handle.look_at = components(drawn.look_at)
            handle.near = drawn.near
            handle.far = drawn.far
            handle.fov = drawn.fov
        self.client.flush()

    def take(self, report: Report) -> bool:
        """Take over what the browser has reported.

        Args:
            report: what `report` has returned.

        Returns:
            Whether a user moved the camera. False for the echo of `point`, for a new
            size of the window, and for numbers that are not a camera.
        """
        height, reported = report
        resized, self._height = height != self._height, height
        if resized and self.camera.orthographic:
            # As many pixels per metre as before.
            self.point(self.camera)
            return False
        if reported is None:
            return False
        if same_picture(reported, self.camera):
            self._answered_by = None
            return False
        if self._answered_by is not None and time.monotonic() < self._answered_by:
            return False
        self.camera = reported
        return True

    def report(self) -> Report:
        """Return the height of the picture, and the camera in the fixed frame.

        That is what the browser has reported last only until `point` is called, which
        gives viser's handle the new camera at once. The camera is None for nonsense:
        viser does not check what a browser sends. Any number may be NaN or missing, and
        the camera may be in the point that it looks at.
        """
        height = max(1, self.client.camera.image_height)
        return height, self._reported(height)

    def _reported(self, height: int) -> Camera | None:
        handle = self.client.camera
        position, look_at, up = (
            _numbers(values, 3)
            for values in (handle.position, handle.look_at, handle.up_direction)
        )
        wxyz, fov = _numbers(handle.wxyz, 4), _numbers([handle.fov], 1)
        if position is None or look_at is None or up is None:
            return None
        if wxyz is None or fov is None or length(wxyz) < 1e-3:
            return None
        away = length(look_at - position)
        if away < 1e-9:
            return None
        forward = _rotation(wxyz)[:, 2]
        if length(look_at - position - away * forward) > SAME_WAY * away:
            # A camera that moves reports where its target will be when it stops. At
            # the pole the yaw between the two would be anything.
            look_at = position + away * forward
        angle = float(fov[0]) if 0.0 < fov[0] < np.pi else FIELD_OF_VIEW
        aside = length((position - look_at)[:2])
        from_above = angle < WIDEST_ORTHO and aside < STRAIGHT_DOWN * away
        if from_above:
            # It leans a little; TopDownOrtho looks straight down.
            position = look_at + length(look_at - position) * UP
        if length(np.cross(look_at - position, up)) < 1e-9 * length(up):
            up = -_rotation(wxyz)[:, 1]
            if length(np.cross(look_at - position, up)) < 1e-9:
                return None
        camera = Camera(position, look_at, up, fov=angle)
        return camera.as_orthographic(height) if from_above else camera


def same_picture(one: Camera, two: Camera) -> bool:
    """Whether two cameras show the same, to a fraction of a pixel."""
    if (one.scale is None) != (two.scale is None):
        return False
    if one.scale is None and one.is_parallel != two.is_parallel:
        return False
    if one.scale is not None and two.scale is not None:
        pixel = 0.5 / two.scale
        near = abs(one.scale / two.scale - 1.0) < 1e-4
    else:
        near = length(one.position - two.position) < 2e-5 * two.distance + 1e-6
        pixel = 2e-5 * two.with_fov(FIELD_OF_VIEW).distance + 1e-6
    looking = one.look_at - two.look_at
    return near and length(looking) < pixel and length(one.right - two.right) < 1e-3


def _rotation(wxyz: Vector) -> Vector:
    """The (3, 3) rotation of a quaternion (w, x, y, z)."""
    w, x, y, z = wxyz.tolist()
    return np.array(rotation_from_xyzw((x, y, z, w)))


def _numbers(values: object, count: int) -> Vector | None:
    """Numbers of a browser as an array; None when they are not that, or too large."""
    try:
        array = np.asarray(values, np.float64)
    except (TypeError, ValueError):
        return None
    good = array.shape == (count,) and bool((np.abs(array) < FARTHEST).all())
    return array if good else None

"""The camera of one browser: told where to be, and heard where a mouse moved it.

viser's camera turns about a point in front of it, with a fixed up direction, and in
perspective. An orthographic view is drawn by a far camera with a small field of view
(`Camera.in_perspective`) that looks all but straight down.
"""

from __future__ import annotations

import time

import numpy as np
import viser
import viser.transforms

from sambot_viz.views.camera import (
    FIELD_OF_VIEW,
    ORTHO_FIELD_OF_VIEW,
    Camera,
    Vector,
    add,
    length,
    subtract,
    times,
)

VISER_FIRST_POSITION = (3.0, 3.0, 3.0)
"""Where viser puts the camera of a page that it opens."""
ECHO_TIME = 8.0
"""A page answers a new camera within this time, also while it loads [s]."""
POLE = 1e-5
"""A camera that looks down leans so far, so that "up" in its picture is told [rad]."""
CLOSE = 0.1
"""viser takes directions to nearer points for unchanged too easily [m]."""
FLAT = 2 * ORTHO_FIELD_OF_VIEW
"""A field of view below this is that of an orthographic view [rad]."""


class BrowserCamera:
    """One browser's camera.

    Attributes:
        client: the browser.
        camera: what it shows, in the fixed frame.
    """

    def __init__(self, client: viser.ClientHandle) -> None:
        self.client = client
        self._height = max(1, client.camera.image_height)
        self.camera = self._reported()
        self._answered_by: float | None = None

    @property
    def is_fresh(self) -> bool:
        """Whether the page was just opened, and nobody has moved its camera."""
        return np.allclose(self.client.camera.position, VISER_FIRST_POSITION, atol=1e-3)

    @property
    def is_flat(self) -> bool:
        """Whether it shows an orthographic view."""
        return self.camera.scale is not None

    def point(
        self, camera: Camera, flat_fov: float | None = ORTHO_FIELD_OF_VIEW
    ) -> None:
        """Send the browser a camera of the fixed frame.

        Args:
            camera: where to look from.
            flat_fov: the field of view that an orthographic camera is drawn with
                [rad]; None draws it from 500 m above (see `Camera.in_perspective`).
        """
        self.camera = camera
        self._answered_by = time.monotonic() + ECHO_TIME
        drawn = camera.in_perspective(self._height, flat_fov)
        position, up = drawn.position, drawn.up
        if camera.scale is not None:
            lean = times(drawn.image_up, -POLE * drawn.distance)
            position, up = add(position, lean), (0.0, 0.0, 1.0)
        handle = self.client.camera
        with self.client.atomic():
            handle.min_orbit_distance = 0.001
            handle.max_orbit_distance = float("inf")
            handle.up_direction = up
            handle.position = position
            if drawn.distance < CLOSE:
                handle.look_at = add(drawn.look_at, (1.0, 1.0, 1.0))
            handle.look_at = drawn.look_at
            handle.near = drawn.near
            handle.far = drawn.far
            handle.fov = drawn.fov
        self.client.flush()

    def take(self) -> bool:
        """Take over what the browser reports.

        Returns:
            Whether somebody moved the camera there; the echo of `point` and a new
            size of the window are no moves.
        """
        height = max(1, self.client.camera.image_height)
        resized, self._height = height != self._height, height
        if resized and self.is_flat:
            # As many pixels per metre as before.
            self.point(self.camera)
            return False
        reported = self._reported()
        if same_picture(reported, self.camera):
            self._answered_by = None
            return False
        if self._answered_by is not None and time.monotonic() < self._answered_by:
            return False
        self.camera = reported
        return True

    def _reported(self) -> Camera:
        """The camera of the last report, in the fixed frame."""
        handle = self.client.camera
        fov = float(handle.fov)
        R = viser.transforms.SO3(handle.wxyz).as_matrix()
        flat = fov < FLAT
        camera = Camera(
            _vector(handle.position),
            _vector(handle.look_at),
            _vector(-R[:, 1]) if flat else _vector(handle.up_direction),
            fov=fov if fov > 0 else FIELD_OF_VIEW,
        )
        if not flat:
            return camera
        # It leans a little; an orthographic view looks straight down.
        above = (*camera.look_at[:2], camera.look_at[2] + camera.distance)
        upright = camera.placed(above, camera.look_at, camera.up)
        return upright.in_parallel(self._height)


def same_picture(one: Camera, two: Camera) -> bool:
    """Whether two cameras show the same, to a fraction of a pixel."""
    if (one.scale is None) != (two.scale is None):
        return False
    if one.scale is not None and two.scale is not None:
        pixel = 0.5 / two.scale
        near = abs(one.scale / two.scale - 1.0) < 1e-4
    else:
        pixel = 2e-5 * two.distance + 1e-6
        near = length(subtract(one.position, two.position)) < pixel
    looking = subtract(one.look_at, two.look_at)
    return (
        near
        and length(looking) < pixel
        and length(subtract(one.right, two.right)) < 1e-3
    )


def _vector(values: object) -> Vector:
    x, y, z = (float(v) for v in np.asarray(values, np.float64))
    return (x, y, z)

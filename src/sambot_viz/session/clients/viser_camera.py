"""The camera as viser's messages have it.

That is where a page was when it came, and where pages are sent that have no window of
ours: those of a snapshot, and files. viser's camera turns about a point in front of it,
with a fixed up direction, and in perspective. An orthographic view is drawn by a far
camera with a small field of view (`Camera.as_perspective`); that of TopDownOrtho looks
almost straight down.
"""

from __future__ import annotations

import numpy as np
import viser

from sambot_viz.geometry import rotation_from_xyzw
from sambot_viz.session.clients.client_camera import leaning
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
CLOSE = 0.1
"""For a nearer target, viser may ignore a small change of direction [m]."""
SAME_WAY = 1e-6
"""A camera at rest looks at its target, with at most this deviation [rad]."""
FARTHEST = 1e12
"""A camera with larger numbers is not taken from a browser [m]."""
STRAIGHT_DOWN = 2e-3
"""A camera that leans by less looks straight down: a page that has just been told of
TopDownOrtho still keeps its camera 0.001 away from the pole [rad]."""


def is_fresh(handle: viser.CameraHandle) -> bool:
    """Return whether the page was just opened, and its camera has not been moved."""
    return np.allclose(handle.position, VISER_FIRST_POSITION, atol=1e-3)


def point(
    client: viser.ClientHandle,
    camera: Camera,
    ortho_fov: float | None = ORTHO_FIELD_OF_VIEW,
) -> None:
    """Send a page a camera of the fixed frame.

    Args:
        client: the page.
        camera: where to look from.
        ortho_fov: the field of view that an orthographic camera is drawn with [rad];
            None draws it from 500 m above (`Camera.as_perspective`).
    """
    handle = client.camera
    drawn = camera.as_perspective(max(1, handle.image_height), ortho_fov)
    if camera.orthographic:
        drawn = leaning(drawn)
    with client.atomic():
        handle.min_orbit_distance = 0.001
        handle.max_orbit_distance = float("inf")
        handle.up_direction = components(drawn.up)
        handle.position = components(drawn.position)
        if drawn.distance < CLOSE:
            handle.look_at = components(drawn.look_at + 1.0)
        handle.look_at = components(drawn.look_at)
        handle.near = drawn.near
        handle.far = drawn.far
        handle.fov = drawn.fov
    client.flush()


def camera_of(handle: viser.CameraHandle) -> Camera | None:
    """Return the camera that a page has reported last, in the fixed frame.

    Returns:
        None for an invalid one: viser does not check the messages of browsers. Any
        number may be NaN or missing, and the camera may be at the point it looks at.
    """
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
    return camera.as_orthographic(max(1, handle.image_height)) if from_above else camera


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

"""Clicks and rectangles as browsers report them, as rays of the fixed frame."""

from __future__ import annotations

import numpy as np
import viser

from sambot_viz.geometry import rotation_from_xyzw
from sambot_viz.tools.picking.rays import Array, RayGrid
from sambot_viz.tools.tool import Click

SAMPLES = 24
"""Rays across a rectangle in each direction: what is thinner may be missed."""


def click_of(event: viser.SceneClickEvent) -> Click | None:
    """A click as a browser reports it; None when its numbers are not a ray."""
    origin, direction = _numbers(event.ray_origin), _numbers(event.ray_direction)
    if origin.shape != (3,) or direction.shape != (3,):
        return None
    length = float(np.linalg.norm(direction))
    if not (np.isfinite(origin).all() and np.isfinite(length) and length > 0.0):
        return None
    return Click(origin, direction / length, event.modifier)


def rays_of(event: viser.SceneRectSelectEvent) -> RayGrid | None:
    """Rays through a rectangle of the picture, given from 0 to 1 of its size.

    Returns:
        The rays; None when the browser's numbers are not a rectangle or a camera.
    """
    camera = event.client.camera
    corners = _numbers((event.screen_min, event.screen_max))
    lens = _numbers((camera.fov, camera.aspect))
    wxyz, position = _numbers(camera.wxyz), _numbers(camera.position)
    shapes = [values.shape for values in (corners, wxyz, position)]
    if shapes != [(2, 2), (4,), (3,)]:
        return None
    if not all(np.isfinite(v).all() for v in (corners, lens, wxyz, position)):
        return None
    corners = np.minimum(np.maximum(np.sort(corners, axis=0), 0.0), 1.0)
    (left, top), (right, bottom) = corners.tolist()
    half = float(np.tan(lens[0] / 2))
    steps = np.arange(SAMPLES) / (SAMPLES - 1)
    columns = (2 * (left + (right - left) * steps) - 1) * half * float(lens[1])
    rows = (2 * (top + (bottom - top) * steps) - 1) * half
    if not (half > 0.0 and lens[1] > 0.0 and wxyz.any()):
        return None
    w, x, y, z = wxyz.tolist()
    R = np.array(rotation_from_xyzw((x, y, z, w)))
    return RayGrid(position, R, columns, rows)


def _numbers(values: object) -> Array:
    """What a browser sent as an array; an empty one for what is not numbers."""
    try:
        return np.asarray(values, np.float64)
    except (TypeError, ValueError):
        return np.zeros(0)

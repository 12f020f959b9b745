"""Clicks and rectangles as browsers report them, as rays of the fixed frame."""

from __future__ import annotations

import numpy as np
import viser

from sambot_viz.tools.picking.picture import Picture
from sambot_viz.tools.picking.rays import Array, RayGrid
from sambot_viz.tools.tool import Click


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
    """The rays of a rectangle; None when its numbers or the camera's are nonsense."""
    picture = Picture.of(event.client.camera)
    if picture is None:
        return None
    return picture.pixels(event.screen_min, event.screen_max)


def _numbers(values: object) -> Array:
    """What a browser sent as an array; an empty one for what is not numbers."""
    try:
        return np.asarray(values, np.float64)
    except (TypeError, ValueError):
        return np.zeros(0)

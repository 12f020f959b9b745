"""Clicks and rectangles that a tool uses, as rays of the fixed frame."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Literal, cast

import numpy as np
import viser

from sambot_viz.displays.picking.rays import Array, RayGrid
from sambot_viz.session.worker import Worker
from sambot_viz.tools.picking.pixel_rays import Picture, ScreenPoint
from sambot_viz.tools.tool import Click, Tool

MODIFIERS: tuple[Literal["shift", "cmd/ctrl"] | None, ...] = (None, "shift", "cmd/ctrl")


def listen(
    client: viser.ClientHandle,
    tool: Tool,
    worker: Worker,
    clicked: Callable[[Tool, Click], None],
    drawn: Callable[[Tool, RayGrid, str | None], None],
) -> None:
    """Subscribe to the pointer events that a tool uses, and to no others.

    Args:
        client: the user of the tool.
        tool: the current tool.
        worker: acts on the events.
        clicked: called with a click.
        drawn: called with the rays of a rectangle, and a modifier.
    """
    scene, client_id = client.scene, client.client_id

    async def on_click(event: viser.SceneClickEvent) -> None:
        click = click_of(event)
        if click is not None:
            worker.post(partial(clicked, tool, click), client=client_id)

    async def on_rectangle(event: viser.SceneRectSelectEvent) -> None:
        rays = rays_of(event)
        if rays is not None:
            worker.post(partial(drawn, tool, rays, event.modifier), client=client_id)

    # viser runs coroutines too, on its loop; its types do not say so.
    scene.remove_click_callback()  # pyright: ignore[reportUnknownMemberType]
    scene.remove_rect_select_callback()  # pyright: ignore[reportUnknownMemberType]
    for modifier in MODIFIERS if tool.rectangles else (None,):
        if tool.clicks:
            scene.on_click(modifier=modifier)(cast(Any, on_click))
        if tool.rectangles:
            scene.on_rect_select(modifier=modifier)(cast(Any, on_rectangle))


def click_of(event: viser.SceneClickEvent) -> Click | None:
    """Return a click as a browser reports it; None when it is not a ray."""
    origin, direction = _numbers(event.ray_origin), _numbers(event.ray_direction)
    if origin.shape != (3,) or direction.shape != (3,):
        return None
    length = float(np.linalg.norm(direction))
    if not (np.isfinite(origin).all() and np.isfinite(length) and length > 0.0):
        return None
    picture = Picture.of(event.client.camera)
    if picture is None:
        return None
    return _click(picture, origin, direction / length, event.modifier)


def pointed_at(
    client: viser.ClientHandle, at: ScreenPoint, modifier: str | None = None
) -> Click | None:
    """Return the event of a click at a point of a browser's picture.

    Args:
        client: the browser.
        at: the point.
        modifier: a held key.

    Returns:
        None if the point is outside the picture, or the camera is invalid.
    """
    picture, point = Picture.of(client.camera), _numbers(at)
    if picture is None or point.shape != (2,):
        return None
    if not ((point >= 0.0) & (point <= 1.0)).all():
        return None
    x, y = point.tolist()
    return _click(picture, picture.eye, picture.direction((x, y)), modifier)


def _click(
    picture: Picture, origin: Array, direction: Array, modifier: str | None
) -> Click:
    pixel, up, forward = picture.pixel, picture.up, picture.forward
    return Click(origin, direction, pixel, up, forward, modifier)


def rays_of(event: viser.SceneRectSelectEvent) -> RayGrid | None:
    """The rays of a rectangle; None when its numbers or the camera's are nonsense."""
    picture = Picture.of(event.client.camera)
    if picture is None:
        return None
    return picture.pixels(event.screen_min, event.screen_max)


def _numbers(values: object) -> Array:
    """Return a browser's values as an array; an empty one if they are not numbers."""
    try:
        return np.asarray(values, np.float64)
    except (TypeError, ValueError):
        return np.zeros(0)

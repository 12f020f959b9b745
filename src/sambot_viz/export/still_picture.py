"""A small picture of a robot, drawn without a browser: what a saved notebook keeps.

The shapes of the links are filled with their colours, lit from the camera; lines, names
and textures are left out.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from contextlib import AbstractContextManager

import numpy as np
import numpy.typing as npt
from PIL import Image

from sambot_viz import limits
from sambot_viz.displays.picking.placed import PlacedMesh, PlacedShapes
from sambot_viz.displays.picking.rasterise import covered, nearness
from sambot_viz.displays.picking.rays import Array, Indices, RayGrid
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.export.page_file import ViewState
from sambot_viz.session.document.document_view import DocumentView
from sambot_viz.session.scene.scene import Scene
from sambot_viz.tools.picking.pixel_rays import Picture
from sambot_viz.views.camera import Camera

SIZE = (800, 500)
"""Of the picture [pixels]; with the shapes of a robot that is 10 to 50 kB."""
FINER = 2
"""Factor by which each side is drawn larger, for smooth edges."""
FACING, ASIDE = 1.0, 0.35
"""How bright a surface is that faces the camera, and one seen from its side."""


def still_picture(
    lock: AbstractContextManager[object], view: DocumentView, scene: Scene
) -> bytes | None:
    """Draw what a session shows, as it is seen when a page is opened.

    Args:
        lock: of the session.
        view: of its document.
        scene: what it draws.

    Returns:
        A PNG file; None when no shape of a robot is to be seen, or too many are.
    """
    with lock:
        camera = ViewState.at_first(view, scene.context.robot is not None).camera
        geometries = [d.pick_geometry() for d in scene.displays if d.shown]
        background = scene.context.background
    shapes = [
        placed
        for geometry in geometries
        if isinstance(geometry, PlacedShapes)
        for placed in geometry.placed
        if isinstance(placed, PlacedMesh) and placed.color is not None
    ]
    count = sum(len(placed.mesh.faces) for placed in shapes)
    if not 0 < count <= limits.NOTEBOOK_TRIANGLES.value:
        return None
    width, height = (side * FINER for side in SIZE)
    drawn = _draw(shapes, _pixels(camera, width, height), background)
    file = io.BytesIO()
    Image.fromarray(drawn).reduce(FINER).save(file, "PNG", optimize=True)
    return file.getvalue()


def _pixels(camera: Camera, width: int, height: int) -> RayGrid:
    camera = camera.as_perspective(height)
    axes = np.stack([camera.right, -camera.image_up, camera.forward], 1)
    half = float(np.tan(camera.fov / 2))
    pixels = Picture(camera.position, axes, half, width, height)
    all_of_them = pixels.pixels((0.0, 0.0), (1.0, 1.0))
    assert all_of_them is not None
    return all_of_them


def _draw(
    shapes: Sequence[PlacedMesh], pixels: RayGrid, background: Rgb
) -> npt.NDArray[np.uint8]:
    """Return (rows, columns, 3), RGB."""
    near = np.zeros((pixels.rows, pixels.columns))
    front = np.zeros(near.shape, np.int64)
    for number, placed in enumerate(shapes, 1):
        R, offset = placed.T[:3, :3], placed.T[:3, 3]
        turned: Array = np.einsum("ij,mkj->mki", R, placed.mesh.corners)
        for _, left, right, top, bottom in covered(
            pixels, pixels.seen(turned + offset, np.eye(4))
        ):
            part = pixels.part(left, top, right - left + 1, bottom - top + 1)
            drawn = nearness(part, placed.mesh, placed.T)
            window = np.s_[top : bottom + 1, left : right + 1]
            nearer = drawn > near[window]
            near[window][nearer] = drawn[nearer]
            front[window][nearer] = number
    colors = np.array([background, *(placed.color for placed in shapes)], np.float64)
    picture = colors[front]
    rows, columns = np.flatnonzero(front.any(1)), np.flatnonzero(front.any(0))
    if len(rows):
        top, left = int(rows[0]), int(columns[0])
        window = np.s_[top : rows[-1] + 1, left : columns[-1] + 1]
        part = pixels.part(left, top, *reversed(front[window].shape))
        light = _brightness(near[window], front[window], part)
        picture[window] *= np.where(front[window] == 0, 1.0, light)[..., None]
    return (picture + 0.5).astype(np.uint8)


def _brightness(near: Array, front: Indices, pixels: RayGrid) -> Array:
    """Return how bright each pixel of a surface is, by how much it faces the camera.

    In the plane of a triangle the nearness is ``a·column + b·row + c``; then (a, b, c)
    is at right angles to it, as the eye sees it (`RayGrid.seen`).
    """
    row: Array = np.arange(near.shape[0], dtype=np.float64)[:, None] + 0.0 * near
    column: Array = np.arange(near.shape[1], dtype=np.float64) + 0.0 * near
    slopes = [_slope(near, front, axis) for axis in (1, 0)]
    rest = near - slopes[0] * column - slopes[1] * row
    planes: Array = np.stack([*slopes, rest], axis=-1)
    normals: Array = planes @ np.linalg.inv(pixels.axes)
    ones: Array = np.ones(near.shape)
    numbers: Array = np.stack([column, row, ones], axis=-1)
    rays: Array = np.einsum("ij,rcj->rci", pixels.axes, numbers)
    lengths = np.linalg.norm(normals, axis=-1) * np.linalg.norm(rays, axis=-1)
    facing = np.abs(np.einsum("ijk,ijk->ij", normals, rays)) / np.maximum(
        lengths, 1e-300
    )
    return ASIDE + (FACING - ASIDE) * facing


def _slope(near: Array, front: Indices, axis: int) -> Array:
    """Return the change of the nearness to a neighbour of the same surface.

    Of the two neighbours, that counts to which the change is smaller: beyond the edge
    of a surface it would be a jump.
    """
    step = np.diff(near, axis=axis)
    step[np.diff(front, axis=axis) != 0] = np.inf
    after = np.pad(step, _at_end(axis, 1), constant_values=np.inf)
    before = np.pad(step, _at_end(axis, 0), constant_values=np.inf)
    best = np.where(np.abs(after) < np.abs(before), after, before)
    return np.where(np.isfinite(best), best, 0.0)


def _at_end(axis: int, end: int) -> list[tuple[int, int]]:
    widths = [(0, 0), (0, 0)]
    widths[axis] = (1 - end, end)
    return widths

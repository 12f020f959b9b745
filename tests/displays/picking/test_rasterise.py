"""Triangles in pixels: the same as one ray through the middle of each."""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import numpy as np
import pytest

from sambot_viz.displays.picking.rasterise import nearness
from sambot_viz.displays.picking.rays import Array, RayGrid
from sambot_viz.displays.picking.triangle_mesh import TriangleMesh
from sambot_viz.meshes.primitives import unit_box, unit_cylinder, unit_sphere
from sambot_viz.robot.parts import Origin
from sambot_viz.tools.picking.pixel_rays import Picture

HERE = np.eye(4)
SQUARE = TriangleMesh.of(
    np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.float32),
    np.array([(0, 1, 2), (0, 2, 3)]),
)
SHAPES = {
    name: TriangleMesh.of(shape.vertices, shape.faces)
    for name, shape in {
        "box": unit_box(),
        "cylinder": unit_cylinder(),
        "sphere": unit_sphere(),
    }.items()
}


def scaled(x: float, y: float, z: float) -> Array:
    T = np.eye(4)
    T[0, 0], T[1, 1], T[2, 2] = x, y, z
    return T


def distance(
    mesh: TriangleMesh,
    origin: tuple[float, ...],
    direction: tuple[float, ...],
    T: Array = HERE,
) -> float:
    """How far along a single ray a mesh is, inf where it is not met."""
    ray = RayGrid.through(np.array(origin, float), np.array(direction, float))
    near = float(nearness(ray, mesh, T)[0, 0])
    return 1.0 / near if near > 0.0 else math.inf


def brute_force(grid: RayGrid, mesh: TriangleMesh, T: Array) -> Any:
    """The same as `nearness`, each ray with each triangle."""
    near: Any = np.zeros((grid.rows, grid.columns))
    solve: Any = np.linalg.solve
    vertices: Any = mesh.vertices[mesh.faces]
    corners: Any = vertices @ np.transpose(T[:3, :3]) + T[:3, 3] - grid.origin
    a, b, c = (corners[:, i] for i in range(3))
    normals = np.cross(b - a, c - a) * np.linalg.det(T[:3, :3])
    for row, column in product(range(grid.rows), range(grid.columns)):
        ray = grid.axes @ (column, row, 1.0)
        # a + u (b - a) + v (c - a) = t ray
        sides: Any = np.stack([b - a, c - a, np.broadcast_to(-ray, a.shape)], axis=2)
        solved = solve(sides, -a[..., None])
        u, v, t = (solved[:, i, 0] for i in range(3))
        met = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0) & (normals @ ray < 0)
        near[row, column] = max(1 / t[met], default=0.0)
    return near


def looking(at: tuple[float, ...], columns: int, rows: int, spread: float) -> RayGrid:
    """Pixels around the direction from a place to the origin."""
    eye = np.array(at, float)
    ahead = -eye / np.linalg.norm(eye)
    right = np.cross(ahead, (0.1, 0.2, 1.0))
    right /= np.linalg.norm(right)
    down = np.cross(ahead, right)
    step = 2 * spread / max(columns, rows)
    first = ahead - (columns - 1) / 2 * step * right - (rows - 1) / 2 * step * down
    axes = np.stack([right * step, down * step, first], axis=1)
    return RayGrid(eye, axes, columns, rows)


@pytest.mark.parametrize(
    ("height", "spread", "size"), [(6.0, 0.4, 0.5), (0.05, 1.4, 0.5), (40.0, 0.03, 0.1)]
)
def test_pixels_meet_what_single_rays_meet(
    height: float, spread: float, size: float
) -> None:
    """From inside, some triangles are behind the eye, and some cross its plane."""
    rng = np.random.default_rng(1)
    middles = np.repeat(rng.uniform(-1.0, 1.0, (150, 3)), 3, axis=0)
    vertices = middles + rng.uniform(-size, size, (450, 3))
    mesh = TriangleMesh.of(
        vertices.astype(np.float32), np.reshape(np.arange(450), (150, 3))
    )
    T = Origin((0.1, -0.2, 0.1), (0.4, 0.3, 2.0)).matrix @ scaled(1.0, 1.3, 0.8)
    for mirror in (1.0, -1.0):
        T[:3, 1] *= mirror
        grid = looking((0.0, 0.0, height), 23, 17, spread)
        found = nearness(grid, mesh, T)
        wanted = brute_force(grid, mesh, T)
        assert 0 < np.count_nonzero(wanted) < wanted.size
        np.testing.assert_allclose(found, wanted, rtol=1e-9)


@pytest.mark.parametrize("name", SHAPES)
def test_a_closed_shape_has_no_holes(name: str) -> None:
    T = Origin((0.0, 0.0, 0.0), (0.3, 0.2, 0.1)).matrix
    grid = looking((1.0, 2.0, 3.0), 101, 101, 0.2)
    found: Any = nearness(grid, SHAPES[name], T) > 0.0
    for line in (*found, *np.transpose(found)):
        covered = np.flatnonzero(line)
        if len(covered):
            assert len(covered) == covered[-1] - covered[0] + 1


def test_no_ray_slips_through_the_edge_between_two_triangles() -> None:
    for x in np.linspace(-0.99, 0.99, 101):
        found = distance(SQUARE, (0.3, -0.2, 7.0), (x - 0.3, x + 0.2, -7.0))
        assert found == pytest.approx(1.0), x


def test_only_the_side_that_is_drawn_is_met() -> None:
    assert distance(SQUARE, (0.5, 0.3, 5), (0, 0, -1)) == 5.0
    assert distance(SQUARE, (0.5, 0.3, -5), (0, 0, 1)) == math.inf
    assert distance(SQUARE, (0.5, 0.3, 5), (0, 0, 1)) == math.inf
    assert distance(SQUARE, (0.5, 1.3, 5), (0, 0, -1)) == math.inf
    # From inside of a box one looks out, as in the picture.
    assert distance(SHAPES["box"], (0, 0, 0), (0, 0, 1)) == math.inf


def test_a_scaled_and_mirrored_mesh_is_met_where_it_is_drawn() -> None:
    T = scaled(3.0, -2.0, 1.0)
    T[2, 3] = 1.0
    assert distance(SQUARE, (2.9, 1.9, 5), (0, 0, -1), T) == pytest.approx(4.0)
    assert distance(SQUARE, (2.9, 2.1, 5), (0, 0, -1), T) == math.inf
    low, high = SQUARE.box(T)
    assert (low.tolist(), high.tolist()) == ([-3, -2, 1], [3, 2, 1])


def test_a_mesh_that_is_scaled_flat_is_met_as_it_is_drawn() -> None:
    flat = scaled(1.0, 1.0, 0.0)
    assert distance(SHAPES["box"], (0.2, 0.3, 5), (0, 0, -1), flat) == 5.0
    line = scaled(0.0, 1.0, 0.0)
    assert distance(SHAPES["box"], (0, 0.3, 5), (0, 0, -1), line) == math.inf


def test_a_turned_box_has_a_larger_box_around_it() -> None:
    T = Origin((5.0, 0.0, 0.0), (0.0, 0.0, math.pi / 4)).matrix @ scaled(2, 2, 2)
    low, high = SHAPES["box"].box(T)
    assert low == pytest.approx((5 - math.sqrt(2), -math.sqrt(2), -1))
    assert high == pytest.approx((5 + math.sqrt(2), math.sqrt(2), 1))


def test_an_empty_mesh_is_never_met() -> None:
    empty = TriangleMesh.of(np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int64))
    assert distance(empty, (0, 0, 1), (0, 0, -1)) == math.inf


# Rectangles of a picture.

AXES = np.array(((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0)))
PICTURE = Picture(np.array((0.0, 0.0, 5.0)), AXES, 0.5, 640, 480)
"""From 5 m above the origin, x to the right and y up; 480 pixels see 5 m."""


def test_the_pixels_of_a_rectangle_are_those_that_it_touches() -> None:
    whole = PICTURE.pixels((0.0, 0.0), (1.0, 1.0))
    assert whole is not None
    assert (whole.columns, whole.rows) == (640, 480)
    some = PICTURE.pixels((0.502, 0.75), (0.5, 0.7))
    assert some is not None
    assert (some.columns, some.rows) == (2, 24)
    part = whole.part(320, 336, 2, 24)
    np.testing.assert_allclose(some.axes, part.axes, atol=1e-12)
    one = PICTURE.pixels((0.5, 0.5), (0.5, 0.5))
    assert one is not None
    assert (one.columns, one.rows) == (1, 1)
    ray = one.axes[:, 2] / np.linalg.norm(one.axes[:, 2])
    middle = PICTURE.direction((320.5 / 640, 240.5 / 480))
    np.testing.assert_allclose(ray, middle, atol=1e-12)
    outside = PICTURE.pixels((-3.0, 2.0), (9.0, 7.0))
    assert outside is not None
    assert (outside.columns, outside.rows) == (640, 1)


def test_a_huge_picture_is_looked_at_in_steps() -> None:
    huge = Picture(PICTURE.eye, PICTURE.axes, 0.5, 100_000, 100_000)
    whole = huge.pixels((0.0, 0.0), (1.0, 1.0))
    assert whole is not None
    assert whole.columns * whole.rows <= 4_000_000
    first, last = whole.axes[:, 2], whole.axes @ (whole.columns - 1, whole.rows - 1, 1)
    assert first == pytest.approx((-0.5, 0.5, -1.0), abs=1e-3)
    assert last == pytest.approx((0.5, -0.5, -1.0), abs=1e-3)


def test_numbers_that_are_no_rectangle_have_no_pixels() -> None:
    assert PICTURE.pixels((math.nan, 0.0), (1.0, 1.0)) is None
    assert PICTURE.pixels((0.0, 0.0), (1.0,)) is None  # pyright: ignore[reportArgumentType]


def test_the_ray_through_a_corner_of_the_picture() -> None:
    along = PICTURE.direction((0.0, 0.0))
    assert along / -along[2] == pytest.approx((-0.5 * 640 / 480, 0.5, -1.0))

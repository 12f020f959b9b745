"""Rays and shapes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sambot_viz.robot.model import Box, Capsule, Cylinder, Sphere
from sambot_viz.robot.origin import Origin
from sambot_viz.tools.picking.raycast import Collider, bounds, cast, cast_plane
from sambot_viz.tools.picking.rays import RayGrid, TriangleMesh

HERE = np.eye(4)
SQUARE = TriangleMesh.of(
    np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.float32),
    np.array([(0, 1, 2), (0, 2, 3)]),
)


def ray(origin: tuple[float, ...], direction: tuple[float, ...]) -> RayGrid:
    return RayGrid.through(np.array(origin, float), np.array(direction, float))


def meet(
    collider: Collider,
    origin: tuple[float, ...],
    direction: tuple[float, ...],
    T: np.ndarray = HERE,
) -> float:
    return float(cast(collider, T, ray(origin, direction))[0])


def looking_down(at: np.ndarray, height: float) -> RayGrid:
    """Rays from above the origin that meet z = 0 at the coordinates `at`, squared."""
    axes = np.diag((1.0, -1.0, -1.0))
    return RayGrid(np.array((0.0, 0.0, height)), axes, at / height, at / height)


@pytest.mark.parametrize(
    ("collider", "distance"),
    [
        (Box((2.0, 4.0, 6.0)), 7.0),
        (Sphere(2.0), 8.0),
        (Cylinder(1.0, 4.0), 8.0),
        (Capsule(1.0, 4.0), 7.0),
        (SQUARE, 10.0),
    ],
)
def test_a_ray_from_above_meets_the_top(collider: Collider, distance: float) -> None:
    found = meet(collider, (0.1, 0.05, 10), (0, 0, -1))
    assert found == pytest.approx(distance, abs=0.01)
    assert meet(collider, (9, 9, 10), (0, 0, -1)) == math.inf
    assert meet(collider, (0.1, 0.05, 10), (0, 0, 1)) == math.inf


@pytest.mark.parametrize(
    "collider", [Cylinder(1.0, 4.0), Capsule(1.0, 4.0), Sphere(1.0)]
)
def test_a_ray_from_the_side_meets_the_round(collider: Collider) -> None:
    assert meet(collider, (-10, 0, 0.0), (1, 0, 0)) == pytest.approx(9.0)


def test_a_box_is_met_along_its_face_and_from_inside() -> None:
    box = Box((2.0, 2.0, 2.0))
    assert meet(box, (0, 0, 0), (0, 0, 1)) == pytest.approx(1.0)
    assert meet(box, (0.5, 0.5, 5), (0, 0, -1)) == pytest.approx(4.0)


def test_a_turned_and_moved_box_is_met_where_it_is() -> None:
    T = Origin((5.0, 0.0, 0.0), (0.0, 0.0, math.pi / 4)).matrix
    box = Box((2.0, 2.0, 2.0))
    assert meet(box, (0, 0, 0), (1, 0, 0), T) == pytest.approx(5 - math.sqrt(2))
    low, high = bounds(box, T)
    assert low == pytest.approx((5 - math.sqrt(2), -math.sqrt(2), -1))
    assert high == pytest.approx((5 + math.sqrt(2), math.sqrt(2), 1))


def test_a_scaled_and_mirrored_mesh_is_met_where_it_is_drawn() -> None:
    T = np.diag((3.0, -2.0, 1.0, 1.0))
    T[2, 3] = 1.0
    assert meet(SQUARE, (2.9, 1.9, 5), (0, 0, -1), T) == pytest.approx(4.0)
    assert meet(SQUARE, (2.9, 2.1, 5), (0, 0, -1), T) == math.inf
    assert bounds(SQUARE, T)[0] == pytest.approx((-3, -2, 1))


def test_a_mesh_that_is_scaled_to_nothing_is_never_met() -> None:
    T = np.diag((0.0, 1.0, 1.0, 1.0))
    assert meet(SQUARE, (0, 0, 5), (0, 0, -1), T) == math.inf


def test_each_ray_of_a_rectangle_has_its_own_answer() -> None:
    rays = looking_down(np.array([-3.0, 0.0, 0.5]), 5.0)
    found = cast(SQUARE, HERE, rays)
    inf = math.inf
    assert found.tolist() == pytest.approx([inf, inf, inf, inf, 5, 5, inf, 5, 5])


def test_a_rectangle_meets_what_single_rays_meet() -> None:
    rng = np.random.default_rng(1)
    middles = np.repeat(rng.uniform(-1.0, 1.0, (200, 3)), 3, axis=0)
    vertices = middles + rng.uniform(-0.2, 0.2, (600, 3))
    mesh = TriangleMesh.of(vertices.astype(np.float32), np.arange(600).reshape(200, 3))
    # From inside: some triangles are behind the eye, some cross its plane.
    for height, spread in ((0.05, 1.4), (4.0, 0.4)):
        rays = looking_down(np.linspace(-spread, spread, 9) * height, height)
        singly = [
            cast(mesh, HERE, RayGrid.through(rays.origin, direction))[0]
            for direction in rays.directions
        ]
        assert np.isfinite(singly).any() and np.isinf(singly).any()
        assert cast(mesh, HERE, rays) == pytest.approx(np.array(singly))


def test_no_ray_slips_through_the_edge_between_two_triangles() -> None:
    for x in np.linspace(-0.99, 0.99, 101):
        origin = (0.3, -0.2, 7.0)
        direction = (x - 0.3, x + 0.2, -7.0)
        assert meet(SQUARE, origin, direction) == pytest.approx(1.0), x


def test_a_plane_has_no_end_and_a_parallel_ray_never_meets_it() -> None:
    origins = np.array([(100.0, 0.0, 2.0), (0.0, 0.0, 2.0)])
    directions = np.array([(0.0, 0.0, -1.0), (1.0, 0.0, 0.0)])
    found = cast_plane(origins, directions, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    assert found.tolist() == [2.0, math.inf]


def test_an_empty_mesh_is_never_met() -> None:
    empty = TriangleMesh.of(np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int64))
    assert meet(empty, (0, 0, 1), (0, 0, -1)) == math.inf

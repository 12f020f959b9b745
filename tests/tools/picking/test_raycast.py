"""Rays and shapes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sambot_viz.robot.model import Box, Capsule, Cylinder, Origin, Sphere
from sambot_viz.tools.picking.raycast import Solid, Triangles, bounds, cast, cast_plane

HERE = np.eye(4)
SQUARE = Triangles(
    np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], np.float64),
    np.array([(0, 1, 2), (0, 2, 3)]),
)


def meet(
    solid: Solid, origin: tuple[float, ...], direction: tuple[float, ...]
) -> float:
    d = np.array([direction], np.float64)
    return float(cast(solid, HERE, np.array([origin], np.float64), d)[0])


@pytest.mark.parametrize(
    ("solid", "distance"),
    [
        (Box((2.0, 4.0, 6.0)), 7.0),
        (Sphere(2.0), 8.0),
        (Cylinder(1.0, 4.0), 8.0),
        (Capsule(1.0, 4.0), 7.0),
        (SQUARE, 10.0),
    ],
)
def test_a_ray_from_above_meets_the_top(solid: Solid, distance: float) -> None:
    assert meet(solid, (0.1, 0.05, 10), (0, 0, -1)) == pytest.approx(distance, abs=0.01)
    assert meet(solid, (9, 9, 10), (0, 0, -1)) == math.inf
    assert meet(solid, (0.1, 0.05, 10), (0, 0, 1)) == math.inf


@pytest.mark.parametrize("solid", [Cylinder(1.0, 4.0), Capsule(1.0, 4.0), Sphere(1.0)])
def test_a_ray_from_the_side_meets_the_round(solid: Solid) -> None:
    assert meet(solid, (-10, 0, 0.0), (1, 0, 0)) == pytest.approx(9.0)


def test_a_box_is_met_along_its_face_and_from_inside() -> None:
    box = Box((2.0, 2.0, 2.0))
    assert meet(box, (0, 0, 0), (0, 0, 1)) == pytest.approx(1.0)
    assert meet(box, (0.5, 0.5, 5), (0, 0, -1)) == pytest.approx(4.0)


def test_a_turned_and_moved_box_is_met_where_it_is() -> None:
    T = Origin((5.0, 0.0, 0.0), (0.0, 0.0, math.pi / 4)).matrix
    box = Box((2.0, 2.0, 2.0))
    ray = np.array([(0.0, 0.0, 0.0)]), np.array([(1.0, 0.0, 0.0)])
    assert cast(box, T, *ray)[0] == pytest.approx(5 - math.sqrt(2))
    low, high = bounds(box, T)
    assert low == pytest.approx((5 - math.sqrt(2), -math.sqrt(2), -1))
    assert high == pytest.approx((5 + math.sqrt(2), math.sqrt(2), 1))


def test_many_rays_at_once_are_as_many_answers() -> None:
    origins = np.array([(x, 0.0, 5.0) for x in (-3.0, 0.0, 0.5, 3.0)])
    directions = np.tile((0.0, 0.0, -1.0), (4, 1))
    found = cast(SQUARE, HERE, origins, directions)
    assert found.tolist() == [math.inf, 5.0, 5.0, math.inf]


def test_a_plane_has_no_end_and_a_parallel_ray_never_meets_it() -> None:
    origins = np.array([(100.0, 0.0, 2.0), (0.0, 0.0, 2.0)])
    directions = np.array([(0.0, 0.0, -1.0), (1.0, 0.0, 0.0)])
    found = cast_plane(origins, directions, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    assert found.tolist() == [2.0, math.inf]


def test_an_empty_mesh_is_never_met() -> None:
    empty = Triangles(np.zeros((0, 3)), np.zeros((0, 3), np.int64))
    assert meet(empty, (0, 0, 1), (0, 0, -1)) == math.inf

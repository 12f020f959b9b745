"""Points of all styles in pixels: each ray meets what is drawn there."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from sambot_viz.displays.picking.placed import PlacedShapes
from sambot_viz.displays.picking.placed_points import (
    Outline,
    PlacedPoints,
    PointOutline,
)
from sambot_viz.displays.picking.selectable import Hit, Selectable
from sambot_viz.matrices import matrix_from_wxyz
from sambot_viz.tools.picking.pick_scene import PickSnapshot
from sambot_viz.tools.picking.pixel_rays import Picture

CLOUD = Selectable("points", "cloud", "~1/1")
AXES = np.array(((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0)))
HERE = np.eye(4)
DOWN = np.array((0.0, 0.0, -1.0))
PIXEL = 0.002


def snapshot(points: object, look: PointOutline, T: np.ndarray = HERE) -> PickSnapshot:
    at = np.array(points, np.float32)
    placed = PlacedPoints(CLOUD, at, T, look, np.arange(len(at)))
    return PickSnapshot((PlacedShapes((placed,)),))


def from_above(of: PickSnapshot, x: float, y: float, pixel: float = 0.0) -> Hit:
    return of.first_hit(np.array((x, y, 5.0)), DOWN, pixel)


@pytest.mark.parametrize(
    ("outline", "inside", "beside"),
    [
        ("square", (0.14, 0.04), (0.14, 0.06)),
        ("disc", (0.09, 0.025), (0.14, 0.04)),
        ("tile", (0.14, 0.04), (0.16, 0.0)),
        ("box", (0.14, 0.04), (0.0, 0.06)),
        ("text", (0.14, 0.04), (0.0, 0.06)),
    ],
)
def test_a_point_is_met_where_it_is_drawn(
    outline: Outline, inside: tuple[float, float], beside: tuple[float, float]
) -> None:
    look = PointOutline(outline, (0.3, 0.1, 0.2))
    scene = snapshot([(5, 5, 5), (1, 0, 0)], look)
    up = np.array((0.0, 1.0, 0.0))
    for sign in (1, -1):
        x, y = 1 + sign * inside[0], sign * inside[1]
        hit = scene.first_hit(np.array((x, y, 5.0)), DOWN, 0.0, up)
        assert (hit.item, hit.number) == (CLOUD, 1)
        x, y = 1 + sign * beside[0], sign * beside[1]
        assert scene.first_hit(np.array((x, y, 5.0)), DOWN, 0.0, up).item is None
    assert from_above(scene, 1.0, 0.0).point is not None
    upwards = scene.first_hit(np.array((1.0, 0.0, 5.0)), -DOWN, PIXEL)
    assert upwards.point is None


def test_a_mark_that_faces_the_eye_means_its_point_and_a_box_its_surface() -> None:
    size = (0.4, 0.4, 0.4)
    flat = snapshot([(1, 0, 0)], PointOutline("square", size))
    assert from_above(flat, 1.1, 0.1).point == pytest.approx((1, 0, 0))
    solid = snapshot([(1, 0, 0)], PointOutline("box", size))
    assert from_above(solid, 1.1, 0.1).point == pytest.approx((1.1, 0.1, 0.2))


def test_a_dot_has_a_size_on_the_screen() -> None:
    scene = snapshot([(1, 0, 0)], PointOutline("dot", (20.0, 20.0, 20.0)))
    reach = 10 * PIXEL * 5.0
    assert from_above(scene, 1.0 + 0.95 * reach, 0.0, PIXEL).number == 0
    assert from_above(scene, 1.0 + 1.05 * reach, 0.0, PIXEL).item is None


def test_a_small_point_is_met_from_three_pixels_and_the_nearest_of_several() -> None:
    look = PointOutline("square", (0.001, 0.001, 0.001))
    scene = snapshot([(0, 0, 0), (0.02, 0, 0), (0.02, 0, -2)], look)
    pixel = PIXEL * 5.0
    hit = from_above(scene, -2.9 * pixel, 0.0, PIXEL)
    assert (hit.number, hit.point) == (0, pytest.approx((0, 0, 0)))
    assert from_above(scene, -3.1 * pixel, 0.0, PIXEL).item is None
    assert from_above(scene, 0.014, 0.0, PIXEL).number == 1


def test_a_ray_meets_the_point_that_is_in_front() -> None:
    look = PointOutline("square", (0.1, 0.1, 0.1))
    scene = snapshot([(0, 0, 0), (0, 0, 1), (0, 0, 0.5)], look)
    assert from_above(scene, 0.0, 0.0).number == 1


@pytest.mark.parametrize("outline", ["square", "disc", "tile", "box"])
def test_a_rectangle_has_what_the_rays_through_its_pixels_meet(
    outline: Outline,
) -> None:
    rng = np.random.default_rng(3)
    points = rng.uniform((-2, -1.5, 0), (2, 1.5, 2), (60, 3))
    turn = np.array((0.9, 0.2, -0.3, 0.25))
    w, x, y, z = (turn / np.linalg.norm(turn)).tolist()
    T = matrix_from_wxyz((w, x, y, z), (0.1, -0.2, 0.3))
    scene = snapshot(points, PointOutline(outline, (0.5, 0.35, 0.4)), T)
    coarse = Picture(np.array((0.0, 0.0, 6.0)), AXES, 0.5, 40, 30)
    grid = coarse.pixels((0.1, 0.2), (0.8, 0.9))
    assert grid is not None
    one_by_one = {
        scene.first_hit(grid.origin, ray / np.linalg.norm(ray), 0.0).number
        for column, row in product(range(grid.columns), range(grid.rows))
        for ray in [grid.axes @ (column, row, 1.0)]
    } - {None}
    (met,) = scene.items_met(grid).values()
    assert met is not None
    assert set(met.tolist()) == one_by_one
    assert 10 < len(one_by_one) < 60


def test_points_between_the_pixels_are_in_a_rectangle() -> None:
    rng = np.random.default_rng(4)
    points = np.column_stack([rng.uniform(-1, 1, (200, 2)), np.zeros(200)])
    scene = snapshot(points, PointOutline("square", (1e-4, 1e-4, 1e-4)))
    picture = Picture(np.array((0.0, 0.0, 5.0)), AXES, 0.5, 640, 480)
    grid = picture.pixels((0.0, 0.0), (1.0, 1.0))
    assert grid is not None
    (met,) = scene.items_met(grid).values()
    assert met is not None
    # Two of them may share a pixel.
    assert len(met) > 190


def test_many_points_are_looked_at_without_one_step_for_each() -> None:
    points = np.random.default_rng(5).uniform(-1, 1, (200_000, 3))
    scene = snapshot(points, PointOutline("dot", (3.0, 3.0, 3.0)))
    hit = from_above(scene, 0.0, 0.0, PIXEL)
    assert hit.number is not None
    aside = np.linalg.norm(points[:, :2], axis=1)
    within = np.flatnonzero(aside <= 1.5 * PIXEL * (5 - points[:, 2]))
    assert hit.number == within[np.argmax(points[within, 2])]

"""Which links and frames can be seen in a rectangle of a picture."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from sambot_viz.displays.grid import GridLines
from sambot_viz.displays.picking.placed import PlacedMesh, PlacedShapes
from sambot_viz.displays.picking.rays import Array, RayGrid
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.triangle_mesh import Part, TriangleMesh, TurnedBox
from sambot_viz.meshes.primitives import unit_box, unit_cylinder, unit_sphere
from sambot_viz.robot.parts import Origin
from sambot_viz.tools.picking.pick_scene import PickSnapshot
from sambot_viz.tools.picking.pixel_rays import Picture

SHAPES = [
    TriangleMesh.of(shape.vertices, shape.faces)
    for shape in (unit_box(), unit_cylinder(), unit_sphere())
]
BOX = SHAPES[0]
AXES = np.array(((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0)))
METRE = 96
"""Pixels of the picture per metre, on the ground."""
PICTURE = Picture(np.array((0.0, 0.0, 5.0)), AXES, 0.5, 640, 480)
"""From 5 m above the origin, x to the right and y up."""
PIXEL = PICTURE.pixel


def link(name: str) -> Selectable:
    return Selectable("link", name)


def box(name: str | None, at: tuple[float, ...], size: tuple[float, ...]) -> PlacedMesh:
    T = np.eye(4)
    T[:3, :3] *= size
    T[:3, 3] = at
    return PlacedMesh(None if name is None else link(name), BOX, T)


def pixels(
    low: tuple[float, float] = (0.0, 0.0), high: tuple[float, float] = (1.0, 1.0)
) -> RayGrid:
    grid = PICTURE.pixels(low, high)
    assert grid is not None
    return grid


def seen(*placed: PlacedMesh, grid: RayGrid | None = None) -> set[str]:
    found = PickSnapshot((PlacedShapes(placed),)).items_met(grid or pixels())
    return {item.name for item in found}


def test_a_rectangle_has_what_the_rays_through_its_pixels_meet_first() -> None:
    rng = np.random.default_rng(2)
    placed: list[PlacedMesh] = []
    for number in range(30):
        x, y, z = rng.uniform((-1.5, -1.0, 0.0), (1.5, 1.0, 2.0)).tolist()
        roll, pitch, yaw = rng.uniform(-3.0, 3.0, 3).tolist()
        T = np.array(Origin((x, y, z), (roll, pitch, yaw)).matrix)
        T[:3, :3] *= rng.uniform(0.02, 0.9, 3)
        item = None if number % 10 == 0 else link(str(number))
        placed.append(PlacedMesh(item, SHAPES[number % 3], T))
    snapshot = PickSnapshot((PlacedShapes(tuple(placed)),))
    coarse = replace(PICTURE, width=32, height=24)
    for low, high in (((0.1, 0.1), (0.9, 0.9)), ((0.4, 0.3), (0.6, 0.5))):
        grid = coarse.pixels(low, high)
        assert grid is not None
        one_by_one = {
            snapshot.first_hit(grid.origin, ray / np.linalg.norm(ray), PIXEL).item
            for column, row in product(range(grid.columns), range(grid.rows))
            for ray in [grid.axes @ (column, row, 1.0)]
        }
        assert 4 < len(one_by_one) < 30
        assert set(snapshot.items_met(grid)) == one_by_one - {None}


def test_a_link_behind_another_is_not_selected() -> None:
    cover = box("cover", (0.0, 0.0, 1.0), (1.0, 1.0, 0.2))
    behind = box("behind", (0.0, 0.0, 0.0), (0.9, 0.9, 0.2))
    assert seen(cover, behind) == seen(behind, cover) == {"cover"}
    larger = box("larger", (0.0, 0.0, 0.0), (1.5, 0.5, 0.2))
    assert seen(larger, cover) == {"cover", "larger"}
    covered = ((0.45, 0.45), (0.55, 0.55))
    assert seen(larger, cover, grid=pixels(*covered)) == {"cover"}


def test_what_is_not_selectable_hides_too() -> None:
    cover = box(None, (0.0, 0.0, 1.0), (1.0, 1.0, 0.2))
    behind = box("behind", (0.0, 0.0, 0.0), (0.9, 0.9, 0.2))
    assert seen(cover, behind) == set()


@pytest.mark.parametrize("at", [-1.234, 0.0, 0.777])
def test_an_edge_of_two_pixels_is_found_in_any_rectangle(at: float) -> None:
    thin = box("thin", (at, 0.0, 0.0), (2 / METRE, 3.0, 0.01))
    base = box("base", (0.0, 0.0, -0.5), (3.0, 3.0, 0.2))
    assert seen(thin, base) == {"thin", "base"}
    column = (at * METRE + 320) / 640
    beside = ((column - 0.1, 0.4), (column - 0.01, 0.6))
    assert seen(thin, base, grid=pixels(*beside)) == {"base"}
    touching = ((column - 0.1, 0.4), (column, 0.6))
    assert seen(thin, base, grid=pixels(*touching)) == {"thin", "base"}


def test_what_is_behind_the_eye_or_beside_the_picture_is_not_selected() -> None:
    assert seen(box("behind", (0.0, 0.0, 7.0), (1.0, 1.0, 1.0))) == set()
    assert seen(box("beside", (9.0, 0.0, 0.0), (1.0, 1.0, 1.0))) == set()
    assert seen(box("half", (3.5, 0.0, 0.0), (1.0, 1.0, 1.0))) == {"half"}


def test_a_grid_is_hit_at_its_lines_where_nothing_else_is() -> None:
    T = Origin((1.0, 0.0, 0.5), (0.0, 0.0, 0.0)).matrix
    grid = GridLines(
        T, np.array((0.0, 0.0, 1.0)), np.array((0.0, 0.0, 0.1)), cells=4, cell=1.0
    )
    low = box("low", (0.0, 0.0, 0.0), (0.2, 0.2, 0.2))
    snapshot = PickSnapshot((grid, PlacedShapes((low,))))
    down = np.array((0.0, 0.0, -1.0))

    def point(*origin: float, direction: Array = down) -> Array | None:
        return snapshot.first_hit(np.array(origin), direction, PIXEL).point

    # From 4.4 m above, a pixel is 4.4 · PIXEL, and a line is met from three of them.
    near, beside = 2.8 * 4.4 * PIXEL, 3.2 * 4.4 * PIXEL
    for x, y in ((2.0, 0.4), (2.0 - near, 0.4), (1.4, 1.0 + near), (3.0 + near, 0.3)):
        assert point(x, y, 5.0) == pytest.approx((x, y, 0.6)), (x, y)
    for x, y in ((1.5, 0.5), (2.0 + beside, 0.4), (3.0 + beside, 0.3), (7.0, 1.0)):
        assert point(x, y, 5.0) is None, (x, y)
    assert point(2.0, 1.0, 5.0, direction=-down) is None
    below = snapshot.first_hit(np.array((0.0, 0.0, 5.0)), down, PIXEL)
    assert below.point == pytest.approx((0.0, 0.0, 0.1))
    assert below.item == link("low")
    along = np.array((1.0, 0.0, 0.0))
    assert point(-5.0, 0.0, 0.6, direction=along) is None


def test_ribbons_of_a_grid_are_hit_in_all_their_width() -> None:
    z = np.array((0.0, 0.0, 1.0))
    grid = GridLines(np.eye(4), z, np.zeros(3), cells=2, cell=1.0, thickness=0.4)
    hit = PickSnapshot((grid,)).first_hit(np.array((0.19, 0.5, 5.0)), -z, 1e-6)
    assert hit.point == pytest.approx((0.19, 0.5, 0.0))


def test_a_box_turns_with_shapes_that_share_their_axes() -> None:
    T_fixed_link = np.array(Origin((1.0, 2.0, 3.0), (0.3, -0.4, 0.9)).matrix)
    T_link_shape = np.array(Origin((0.1, 0.0, 0.0), (0.0, 0.7, 0.2)).matrix)
    turned = T_link_shape.copy()
    turned[:3, :3] *= (2.0, 0.4, 0.1)
    found = TurnedBox.around([Part(BOX, T_fixed_link, turned)])
    assert found.high - found.low == pytest.approx((2.0, 0.4, 0.1))
    middle = found.T @ (*(found.low + found.high) / 2, 1.0)
    assert middle[:3] == pytest.approx((T_fixed_link @ (0.1, 0.0, 0.0, 1.0))[:3])
    assert found.T[:3, :3] == pytest.approx((T_fixed_link @ T_link_shape)[:3, :3])
    # Two shapes with axes of their own: along the axes of their link.
    two = TurnedBox.around(
        [Part(BOX, T_fixed_link, turned), Part(BOX, T_fixed_link, np.eye(4))]
    )
    assert two.T[:3, :3] == pytest.approx(T_fixed_link[:3, :3])
    assert (two.high - two.low >= 1.0 - 1e-9).all()


def test_a_rectangle_takes_what_is_seen_through_others() -> None:
    glass = replace(box("glass", (0.0, 0.0, 1.0), (1.0, 1.0, 0.1)), is_clear=True)
    behind = box("behind", (0.0, 0.0, 0.5), (0.3, 0.3, 0.1))
    wall = box("wall", (0.0, 0.0, 0.2), (2.0, 2.0, 0.1))
    below = replace(box("below", (0.0, 0.0, 0.0), (0.3, 0.3, 0.1)), is_clear=True)
    assert seen(glass, behind, wall, below) == {"glass", "behind", "wall"}
    # What is cut off by the rectangle counts only where it is in front.
    middle = pixels((0.49, 0.49), (0.51, 0.51))
    assert seen(glass, behind, wall, below, grid=middle) == {"glass"}

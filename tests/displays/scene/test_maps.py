"""Maps: their palettes, and which of their squares is sent when."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from sambot_viz.displays.scene.maps import TILE, MapNode, packed, palette

if TYPE_CHECKING:
    from conftest import Drawn

Numbers = Callable[[bytes, str], "np.ndarray[Any, Any]"]
Document = Callable[[bytes], dict[str, Any]]
GREEN, UNKNOWN = [0, 255, 0, 255], [112, 137, 134, 255]
WHITE, BLACK = [255] * 4, [0, 0, 0, 255]
RECORDED = json.loads((Path(__file__).parent / "map_palettes.json").read_text())


@pytest.mark.parametrize("scheme", ["map", "costmap", "raw"])
def test_each_value_has_the_colour_that_rviz_drew(scheme: str) -> None:
    colors = palette(scheme).astype(float)
    over = colors[:, 3:] / 255
    shown = colors[:, :3] * over + 48 * (1 - over)
    assert len(RECORDED[scheme]) == 256
    assert np.abs(shown - RECORDED[scheme]).max() <= 1


def test_value_0_of_a_costmap_is_transparent() -> None:
    assert palette("costmap")[0].tolist() == [0, 0, 0, 0]
    assert palette("costmap", is_binary=True)[0].tolist() == [0, 0, 255, 255]


@pytest.mark.parametrize(
    ("scheme", "low", "high", "wrong", "unknown"),
    [
        ("map", WHITE, BLACK, GREEN, UNKNOWN),
        ("costmap", [0, 0, 255, 255], [255, 0, 0, 255], GREEN, UNKNOWN),
        ("raw", BLACK, WHITE, WHITE, WHITE),
    ],
)
def test_a_binary_map_has_two_colours_round_its_threshold(
    scheme: str, low: list[int], high: list[int], wrong: list[int], unknown: list[int]
) -> None:
    colors = palette(scheme, is_binary=True, threshold=65).tolist()
    assert colors[:65] == 65 * [low]
    assert colors[65:101] == 36 * [high]
    assert colors[101:128] == 27 * [wrong]
    assert colors[255] == unknown
    assert palette("raw", is_binary=True, threshold=0).tolist() == 256 * [WHITE]


@pytest.mark.parametrize("runs", [1, 2, 255, 256, 257, 600])
def test_cells_are_packed_as_runs_when_that_is_less(runs: int) -> None:
    cells = np.repeat(np.array([7, 0, 255, 7], np.uint8), runs).reshape(2, -1)
    sent = packed(cells)
    assert len(sent) <= cells.size
    if len(sent) < cells.size:
        assert np.array_equal(
            np.repeat(sent[::2], 1 + sent[1::2].astype(int)), cells.ravel()
        )
    else:
        assert runs <= 2


class Floor:
    """A map of three by two squares, drawn."""

    def __init__(self, drawn: Drawn) -> None:
        self.drawn = drawn
        self.cells = np.random.default_rng(0).integers(
            0, 100, (TILE + 10, 2 * TILE + 5), np.uint8
        )
        self.node = MapNode(drawn.scene, "/m")
        self.draw()
        self.first = drawn.files()

    def draw(self, **changed: Any) -> None:
        given = {"colors": palette("map"), "resolution": 0.05, **changed}
        self.node.draw(given.pop("cells", self.cells), **given)


@pytest.fixture
def floor(drawn: Drawn) -> Floor:
    return Floor(drawn)


def test_a_map_is_sent_once(floor: Floor) -> None:
    assert len(floor.first) == 6 + 1
    floor.draw()
    assert floor.drawn.taken() == []


def test_a_pose_is_one_message(floor: Floor) -> None:
    floor.draw(position=(1.0, 2.0, 0.0))
    assert floor.drawn.sent() == ["SetPositionMessage"]


@pytest.mark.parametrize(
    "changed", [{"alpha": 0.5}, {"is_behind": True}, {"colors": palette("costmap")}]
)
def test_another_look_does_not_send_the_cells(
    floor: Floor, changed: dict[str, Any]
) -> None:
    floor.draw(**changed)
    assert 0 < floor.drawn.bytes() < 3000


def test_an_update_sends_the_squares_that_it_touches(floor: Floor) -> None:
    floor.node.update(TILE - 1, 3, np.array([[101, 102]], np.uint8))
    assert len(floor.drawn.files()) == 2
    floor.node.update(TILE - 1, 3, np.array([[101, 102]], np.uint8))
    assert floor.drawn.taken() == []
    floor.cells[3, TILE - 1 : TILE + 1] = 101, 102
    floor.draw()
    assert floor.drawn.taken() == []
    floor.cells[-1, -1] = 101
    floor.draw()
    assert len(floor.drawn.files()) == 1


def test_another_shape_or_resolution_is_another_map(floor: Floor) -> None:
    floor.draw(resolution=0.1)
    assert len(floor.drawn.files()) == 6
    floor.draw(cells=floor.cells[:5, :5], resolution=0.1)
    assert len(floor.drawn.files()) == 1


def test_the_first_row_is_at_the_bottom(
    drawn: Drawn, numbers: Numbers, document: Document
) -> None:
    MapNode(drawn.scene, "/m").draw(np.zeros((2, 3), np.uint8), palette("map"), 0.5)
    (tile,) = (
        file
        for file in drawn.files().values()
        if document(file)["meshes"][0]["extras"]["drawAs"] == "mapTile"
    )
    # The first row of a picture is v = 0.
    assert numbers(tile, "POSITION").tolist() == [
        [0, 0, 0],
        [1.5, 0, 0],
        [0, 1, 0],
        [1.5, 1, 0],
    ]
    assert numbers(tile, "TEXCOORD_0")[:, 1].tolist() == [0, 0, 1, 1]


def test_a_large_map_is_sent_in_less_than_a_twentieth_of_its_size(drawn: Drawn) -> None:
    cells = np.full((4000, 4000), 255, np.uint8)
    cells[500:3500, 700:3300] = 0
    cells[500:3500:90, 700:3300] = 100
    MapNode(drawn.scene, "/m").draw(cells, palette("map"), 0.05)
    messages = drawn.taken()
    assert sum(size for _, size in messages) < cells.size / 20
    made = [message["name"] for message, _ in messages if "props" in message]
    assert len(made) == len(set(made)) == 64 + 2


@pytest.mark.parametrize("resolution", [0.0, np.nan, np.inf, 1e30])
def test_cells_without_a_size_are_not_drawn(floor: Floor, resolution: float) -> None:
    floor.draw(resolution=resolution)
    assert set(floor.drawn.sent()) == {"RemoveSceneNodeMessage"}


def test_a_map_that_went_with_the_node_above_is_drawn_again(drawn: Drawn) -> None:
    above = drawn.scene.add_frame("/a")
    node = MapNode(drawn.scene, "/a/m")
    node.draw(np.zeros((2, 3), np.uint8), palette("map"), 0.5)
    above.remove()
    assert node.is_gone
    drawn.scene.add_frame("/a")
    drawn.taken()
    node.draw(np.zeros((2, 3), np.uint8), palette("map"), 0.5)
    assert len(drawn.files()) == 2

"""Lines and ribbons: what is sent once, what again, and what never."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from sambot_viz.displays.scene.lines import LineNode, chain_segments
from sambot_viz.displays.scene.ribbons import RibbonNode

if TYPE_CHECKING:
    from conftest import Drawn

Numbers = Callable[[bytes, str], "np.ndarray[Any, Any]"]
Document = Callable[[bytes], dict[str, Any]]
CORNER = np.array([[0, 0, 0], [1, 0, 0], [1, 2, 0]], np.float32)
RED = (255, 0, 0)


def test_what_is_the_same_is_not_sent_again(drawn: Drawn) -> None:
    lines = LineNode(drawn.scene, "/lines")
    ribbons = RibbonNode(drawn.scene, "/ribbons")
    for _ in range(2):
        drawn.taken()
        lines.draw(chain_segments(CORNER), RED, alpha=0.5)
        ribbons.draw(CORNER, 0.1, RED)
    assert drawn.taken() == []


def test_a_pose_is_sent_without_the_lines(drawn: Drawn) -> None:
    many = np.zeros((10_000, 2, 3), np.float32)
    node = LineNode(drawn.scene, "/lines")
    node.draw(many, RED)
    assert drawn.bytes() > many.nbytes
    node.draw(many, RED, position=(1, 0, 0))
    assert drawn.sent() == ["SetPositionMessage"]
    node.draw(many, RED, position=(1, 0, 0), wxyz=(0, 1, 0, 0))
    assert drawn.bytes() < 100


@pytest.mark.parametrize("count", [2, 3, 10_000])
def test_a_chain_sends_each_point_once(
    drawn: Drawn, count: int, document: Document, numbers: Numbers
) -> None:
    points = np.arange(3 * count, dtype=np.float32).reshape(-1, 3)
    node = LineNode(drawn.scene, "/c")
    node.draw_chain(points, (51, 0, 255), alpha=0.4)
    file = drawn.files()["/c"]
    assert np.array_equal(numbers(file, "POSITION"), points)
    (primitive,) = document(file)["meshes"][0]["primitives"]
    assert (primitive["mode"], list(primitive["attributes"])) == (3, ["POSITION"])
    (material,) = document(file)["materials"]
    color = material["pbrMetallicRoughness"]["baseColorFactor"]
    assert (color, material["alphaMode"]) == ([0.2, 0.0, 1.0, 0.4], "BLEND")
    (placed,) = node.placed(np.eye(4), None)
    assert np.array_equal(placed.segments, chain_segments(points))


def test_no_line_of_a_chain_goes_to_what_is_not_finite(
    drawn: Drawn, numbers: Numbers
) -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [1e300, 0, 0], [2, 0, 0], [3, 0, 0]])
    LineNode(drawn.scene, "/c").draw_chain(points, RED)
    ends = numbers(drawn.files()["/c"], "POSITION")
    assert ends[:, 0].tolist() == [0, 1, 2, 3]


def test_other_lines_are_one_message(drawn: Drawn) -> None:
    node = RibbonNode(drawn.scene, "/r")
    node.draw(CORNER, 0.1, RED)
    drawn.taken()
    node.draw(2 * CORNER, 0.1, RED)
    assert drawn.sent() == ["SceneNodeUpdateMessage"]


def test_nothing_to_draw_takes_the_node_away(drawn: Drawn) -> None:
    for node in (LineNode(drawn.scene, "/l"), RibbonNode(drawn.scene, "/r")):
        draw: Callable[[Any], None] = (
            (lambda points, n=node: n.draw(chain_segments(points), RED))
            if isinstance(node, LineNode)
            else (lambda points, n=node: n.draw(points, 0.1, RED))
        )
        draw(CORNER)
        drawn.taken()
        draw(CORNER[:1])
        assert drawn.sent() == ["RemoveSceneNodeMessage"]
        draw(CORNER)
        assert drawn.files()


def test_a_node_that_went_with_the_one_above_is_drawn_again(drawn: Drawn) -> None:
    above = drawn.scene.add_frame("/a")
    node = LineNode(drawn.scene, "/a/l")
    node.draw(chain_segments(CORNER), RED)
    above.remove()
    assert node.is_gone
    drawn.scene.add_frame("/a")
    drawn.taken()
    node.draw(chain_segments(CORNER), RED)
    assert "/a/l" in drawn.files()


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e300])
def test_what_is_not_finite_is_never_sent(
    drawn: Drawn, numbers: Numbers, bad: float
) -> None:
    points = np.array(CORNER, np.float64).repeat(2, axis=0)
    points[2, 1] = bad
    LineNode(drawn.scene, "/l").draw(
        chain_segments(points), RED, position=(bad, 0, 0), wxyz=(bad, 0, 0, 0)
    )
    RibbonNode(drawn.scene, "/r").draw(points, 0.1, RED)
    # In JSON it would not be a number.
    assert "nan" not in repr([m for m, _ in drawn._messages]).lower()
    for glb in drawn.files().values():
        assert np.isfinite(numbers(glb, "POSITION")).all()


def test_a_ribbon_is_broken_where_a_point_is_missing(
    drawn: Drawn, numbers: Numbers
) -> None:
    points = [[0, 0, 0], [1, 0, 0], [np.nan, 0, 0], [2, 0, 0], [3, 0, 0]]
    RibbonNode(drawn.scene, "/r").draw(points, 0.1, RED)
    corners = numbers(drawn.files()["/r"], "indices").reshape(-1, 6)
    assert corners.min(axis=1).tolist() == [0, 4]


def test_a_ribbon_goes_along_its_neighbours(drawn: Drawn, numbers: Numbers) -> None:
    RibbonNode(drawn.scene, "/r").draw(
        np.concatenate([CORNER, CORNER + 5]), 0.1, RED, counts=[3, 3]
    )
    aside = numbers(drawn.files()["/r"], "_ASIDE")
    along = [[1, 0, 0], [1, 2, 0], [0, 2, 0]]
    assert aside[::2, :3].tolist() == along + along
    assert aside[:, 3].tolist() == 6 * [-1, 1]


def test_the_last_point_decides_whether_ribbons_are_blended(
    drawn: Drawn, document: Document
) -> None:
    half, full = (255, 0, 0, 128), (255, 0, 0, 255)
    for colors, mode in (([half, full], "OPAQUE"), ([full, half], "BLEND")):
        RibbonNode(drawn.scene, "/r").draw(CORNER[:2], 0.1, colors)
        assert document(drawn.files()["/r"])["materials"][0]["alphaMode"] == mode


def test_colours_of_ends_are_sent_as_they_are(drawn: Drawn, numbers: Numbers) -> None:
    colors = np.array([[[10, 20, 30, 255], [40, 50, 60, 128]]])
    LineNode(drawn.scene, "/l").draw(CORNER[None, :2], colors, alpha=0.5)
    sent = numbers(drawn.files()["/l"], "COLOR_0")
    assert sent.tolist() == [[10, 20, 30, 128], [40, 50, 60, 64]]


def test_a_closed_chain_returns_to_its_first_point() -> None:
    assert len(chain_segments(CORNER)) == 2
    assert chain_segments(CORNER, closed=True)[-1].tolist() == [[1, 2, 0], [0, 0, 0]]

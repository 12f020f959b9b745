"""Arrows, axes and unit shapes in batches."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from sambot_viz.displays.scene.batch_node import BatchNode
from sambot_viz.displays.scene.solid_nodes import (
    ArrowsNode,
    AxesNode,
    Solid,
    SolidsNode,
)
from sambot_viz.displays.scene.solids import box

if TYPE_CHECKING:
    from conftest import Drawn

MANY = 500
TURNS = np.tile([1.0, 0.0, 0.0, 0.0], (MANY, 1))
PLACES = np.arange(3.0 * MANY).reshape(MANY, 3)
RED = (255, 0, 0)
SIZE = (0.23, 0.01), (0.07, 0.03)


def test_arrows_are_one_node_and_sent_once(drawn: Drawn) -> None:
    node = ArrowsNode(drawn.scene, "/a")
    node.draw(TURNS, PLACES, *SIZE, RED)
    assert drawn.sent().count("BatchedMeshesMessage") == 1
    node.draw(TURNS, PLACES, *SIZE, RED)
    assert drawn.taken() == []


def test_of_arrows_only_what_changed_is_sent(drawn: Drawn) -> None:
    node = ArrowsNode(drawn.scene, "/a")
    node.draw(TURNS, PLACES, *SIZE, RED)
    drawn.taken()
    node.draw(TURNS, PLACES, *SIZE, RED, position=(1, 0, 0))
    assert drawn.bytes() < 100
    node.draw(TURNS, PLACES + 1, *SIZE, RED)
    assert drawn.bytes() < 12 * MANY + 300
    node.draw(TURNS, PLACES + 1, (1.0, 0.1), (0.2, 0.2), RED)
    assert drawn.bytes() < 3000
    node.draw(TURNS[:2], PLACES[:2], (1.0, 0.1), (0.2, 0.2), RED)
    assert 0 < drawn.bytes() < 1000


def test_arrows_point_along_x_and_are_as_long_as_both_parts(drawn: Drawn) -> None:
    ArrowsNode(drawn.scene, "/a").draw(TURNS[:1], PLACES[:1], *SIZE, RED)
    corners = Seen(drawn, "/a").props.vertices
    # RViz's head begins 0.9 % of its length before the end of the shaft.
    assert corners[:, 0].max() == pytest.approx(0.23 + 0.991 * 0.07)
    assert corners[:, 0].min() == pytest.approx(0.0)


class Seen:
    """What a batch has on its way to the page."""

    def __init__(self, drawn: Drawn, name: str) -> None:
        self.props = drawn.scene._handle_from_node_name[name]


def test_axes_are_three_cylinders_in_the_colours_of_the_axes(drawn: Drawn) -> None:
    half = 0.5**0.5
    AxesNode(drawn.scene, "/x").draw(
        [(half, 0, 0, half)], [(1, 2, 3)], 0.3, 0.01, alpha=0.5
    )
    seen = Seen(drawn, "/x").props
    # Turned by 90° about z: x goes along y, y along −x.
    assert np.allclose(
        seen.batched_positions, [(1, 2.15, 3), (0.85, 2, 3), (1, 2, 3.15)]
    )
    assert seen.batched_colors.tolist() == [[255, 0, 0], [0, 255, 0], [0, 0, 255]]
    assert seen.batched_scales.tolist() == pytest.approx(
        np.array(3 * [(0.01, 0.01, 0.3)])
    )
    assert seen.batched_opacities.tolist() == [0.5] * 3


def test_opaque_copies_write_depth(drawn: Drawn) -> None:
    node = BatchNode(drawn.scene, "/b")
    node.show(box(), TURNS, PLACES, (1, 1, 1), RED)
    assert Seen(drawn, "/b").props.batched_opacities is None
    node.show(box(), TURNS, PLACES, (1, 1, 1), RED, 0.5)
    assert Seen(drawn, "/b").props.batched_opacities.tolist() == [0.5] * MANY
    node.show(box(), TURNS, PLACES, (1, 1, 1), RED)
    assert Seen(drawn, "/b").props.batched_opacities is None


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e300])
def test_copies_that_are_not_finite_are_left_out(drawn: Drawn, bad: float) -> None:
    places = PLACES[:3].copy()
    places[1, 2] = bad
    node = BatchNode(drawn.scene, "/b")
    turns = [(1, 0, 0, 0), (1, 0, 0, 0), (0, 0, 0, 0)]
    node.show(box(), turns, places, (1, 1, 1), RED, position=(bad, 0, 0))
    assert Seen(drawn, "/b").props.batched_positions.tolist() == [[0, 1, 2]]
    drawn.taken()
    node.show(box(), turns[1:], places[1:], (1, 1, 1), RED)
    assert drawn.sent() == ["RemoveSceneNodeMessage"]


def test_each_kind_of_shape_is_one_node(drawn: Drawn) -> None:
    place, size = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
    shapes = [
        Solid(kind, (1, 0, 0, 0), place, size, RED)
        for kind in ("box", "sphere", "box", "cylinder")
    ]
    node = SolidsNode(drawn.scene, "/s")
    node.draw(shapes)
    assert drawn.sent().count("BatchedMeshesMessage") == 3
    node.draw(shapes[:1])
    assert drawn.sent().count("RemoveSceneNodeMessage") == 2
    node.remove()
    assert drawn.sent() == ["RemoveSceneNodeMessage"]


def test_solids_of_negative_sizes_are_turned_and_not_inside_out(drawn: Drawn) -> None:
    """A cone of a negative height points down, in a copy that is not mirrored."""
    SolidsNode(drawn.scene, "/m").draw(
        [
            Solid("cone", (1.0, 0.0, 0.0, 0.0), (0, 0, 0), (1.0, 1.0, -2.0), RED),
            Solid("cone", (1.0, 0.0, 0.0, 0.0), (0, 0, 0), (-1.0, 1.0, 2.0), RED),
        ]
    )
    seen = Seen(drawn, "/mco").props
    assert (seen.batched_scales > 0).all()
    assert np.abs(seen.batched_wxyzs).tolist() == [[0, 1, 0, 0], [1, 0, 0, 0]]


def test_one_that_can_be_seen_through_is_placed_by_its_node(drawn: Drawn) -> None:
    """The page sorts nodes by their places, as RViz does its objects."""
    half = 0.5**0.5
    for alpha, at in ((1.0, (0, 0, 3)), (0.5, (0, 2, 3))):
        SolidsNode(drawn.scene, "/m").draw(
            [Solid("box", (half, 0.0, 0.0, half), (2, 0, 0), (1, 1, 1), RED, alpha)],
            wxyz=(half, 0.0, 0.0, half),
            position=(0.0, 0.0, 3.0),
        )
        node = drawn.scene._handle_from_node_name["/mbo"]
        assert np.allclose(node.position, at)
        assert np.allclose(node.batched_positions, [(2 if alpha == 1 else 0, 0, 0)])
        turn = (half, 0, 0, half) if alpha == 1 else (0, 0, 0, 1)
        assert np.allclose(node.wxyz, turn)

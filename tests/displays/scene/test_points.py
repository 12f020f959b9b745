"""Points: what is sent once, what again, and what never."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from sambot_viz.displays.scene.points import PointNode, PointStyle

if TYPE_CHECKING:
    from conftest import Drawn

Numbers = Callable[[bytes, str], "np.ndarray[Any, Any]"]
Document = Callable[[bytes], dict[str, Any]]
FLAT = PointStyle("Flat Squares", (0.1, 0.1, 0.1))
WHITE = np.array([[255, 255, 255]], np.uint8)
MANY = np.zeros((10_000, 3), np.float32)


def test_points_are_sent_once_and_a_pose_without_them(drawn: Drawn) -> None:
    node = PointNode(drawn.scene, "/p")
    node.draw(MANY, WHITE, FLAT)
    assert MANY.nbytes < drawn.bytes() < MANY.nbytes + 2000
    node.draw(MANY, WHITE, FLAT)
    assert drawn.taken() == []
    node.draw(MANY, WHITE, FLAT, position=(1, 0, 0))
    assert drawn.sent() == ["SetPositionMessage"]


def test_other_points_are_one_message_for_the_same_node(drawn: Drawn) -> None:
    node = PointNode(drawn.scene, "/p")
    node.draw(MANY, WHITE, FLAT)
    drawn.taken()
    node.draw(MANY + 1, WHITE, FLAT)
    assert drawn.sent() == ["SceneNodeUpdateMessage"]


def test_one_other_point_or_colour_is_another_cloud(drawn: Drawn) -> None:
    node, colors = PointNode(drawn.scene, "/p"), np.full((10_000, 3), 9, np.uint8)
    node.draw(MANY, colors, FLAT)
    drawn.taken()
    node.draw(MANY.copy(), colors.copy(), FLAT)
    assert drawn.sent() == []
    for points, looks in ((MANY.copy(), colors), (MANY, colors.copy())):
        (points if points is not MANY else looks)[-1, 0] += 1
        node.draw(points, looks, FLAT)
        assert drawn.sent() == ["SceneNodeUpdateMessage"]


def test_what_is_nowhere_is_left_out_with_its_colour(
    drawn: Drawn, numbers: Numbers
) -> None:
    points = np.array(
        [(0, 0, 0), (np.nan, 0, 0), (0, np.inf, 0), (1e300, 0, 0), (1, 2, 3)]
    )
    colors = np.arange(15, dtype=np.uint8).reshape(5, 3)
    PointNode(drawn.scene, "/p").draw(points, colors, FLAT)
    glb = drawn.files()["/p"]
    assert numbers(glb, "POSITION").tolist() == [[0, 0, 0], [1, 2, 3]]
    assert numbers(glb, "COLOR_0").tolist() == [[0, 1, 2, 255], [12, 13, 14, 255]]


def test_no_points_are_no_node(drawn: Drawn) -> None:
    node = PointNode(drawn.scene, "/p")
    node.draw(MANY[:0], WHITE, FLAT)
    assert drawn.taken() == []
    node.draw(MANY, WHITE, FLAT)
    drawn.taken()
    node.draw(np.full((3, 3), np.nan), WHITE, FLAT)
    assert drawn.sent() == ["RemoveSceneNodeMessage"]


def test_what_is_opaque_is_not_blended(drawn: Drawn, document: Document) -> None:
    def mode(style: PointStyle, colors: np.ndarray[Any, Any]) -> str:
        PointNode(drawn.scene, "/p").draw(MANY, colors, style)
        return document(drawn.files()["/p"])["materials"][0]["alphaMode"]

    assert mode(FLAT, WHITE) == "OPAQUE"
    assert mode(replace(FLAT, alpha=0.9999), WHITE) == "OPAQUE"
    assert mode(replace(FLAT, alpha=0.5), WHITE) == "BLEND"
    assert mode(FLAT, np.array([[1, 2, 3, 255]], np.uint8)) == "BLEND"

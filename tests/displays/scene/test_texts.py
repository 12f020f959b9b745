"""Texts: what of them is sent, and when."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest

from sambot_viz import limits
from sambot_viz.displays.scene.text_node import SPACE, TextNode

if TYPE_CHECKING:
    from conftest import Drawn

Document = Callable[[bytes], dict[str, Any]]


def said(drawn: Drawn, document: Document) -> dict[str, Any]:
    """What a text says to the page."""
    return document(drawn.files()["/t"])["meshes"][0]["extras"]


def test_a_text_says_its_lines_size_and_colour(
    drawn: Drawn, document: Document
) -> None:
    TextNode(drawn.scene, "/t").draw("two\nlines", 0.3, (255, 0, 51), alpha=0.5)
    assert said(drawn, document) == {
        "drawAs": "text",
        "lines": ["two", "lines"],
        "height": 0.3,
        "space": pytest.approx(SPACE * 0.3),
        "color": [1.0, 0.0, 0.2],
        "alpha": 0.5,
    }


def test_a_text_is_sent_once_and_moves_alone(drawn: Drawn) -> None:
    node = TextNode(drawn.scene, "/t")
    node.draw("name", 0.3)
    drawn.taken()
    node.draw("name", 0.3)
    assert drawn.taken() == []
    node.draw("name", 0.3, position=(1, 2, 3))
    assert drawn.sent() == ["SetPositionMessage"]
    node.draw("other", 0.3, position=(1, 2, 3))
    assert drawn.sent() == ["SceneNodeUpdateMessage"]


@pytest.mark.parametrize(
    ("text", "height", "alpha"),
    [
        ("", 1.0, 1.0),
        (" \n ", 1.0, 1.0),
        ("a", 0.0, 1.0),
        ("a", float("nan"), 1.0),
        ("a", float("inf"), 1.0),
        ("a", 1.0, 0.0),
        ("a", 1.0, float("nan")),
    ],
)
def test_nothing_to_see_is_not_drawn(
    drawn: Drawn, text: str, height: float, alpha: float
) -> None:
    node = TextNode(drawn.scene, "/t")
    node.draw("before", 1.0)
    drawn.taken()
    node.draw(text, height, alpha=alpha)
    assert drawn.sent() == ["RemoveSceneNodeMessage"]


def test_no_text_can_harm_the_page(drawn: Drawn, document: Document) -> None:
    TextNode(drawn.scene, "/t").draw("\ud800\u202e\x00" + 9999 * "a\n", 1.0)
    sent = said(drawn, document)
    assert sent["lines"][0] == "\ufffd\ufffd\ufffda"
    assert sum(len(line) + 1 for line in sent["lines"]) <= limits.MARKER_TEXT.value + 1


def test_a_space_may_have_a_width_of_its_own(drawn: Drawn, document: Document) -> None:
    TextNode(drawn.scene, "/t").draw("a b", 1.0, space=0.2)
    assert said(drawn, document)["space"] == 0.2

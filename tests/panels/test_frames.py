"""The Frames panel: the answer as HTML, and static transforms by hand."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from urllib.parse import urlsplit

import pytest
from inside import viser_server
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.frames import FrameTree, Transform
from sambot_viz.frames.explain import explain
from sambot_viz.panels.frames import answer_html


@pytest.fixture
def viz() -> Iterator[Visualizer]:
    with Visualizer(port=0) as viz:
        yield viz


@pytest.fixture
def client(
    viz: Visualizer, protocol: Callable[[int], ProtocolClient]
) -> ProtocolClient:
    client = protocol(urlsplit(viz.url).port or 0)
    client.settle(viser_server(viz))
    return client


def said(client: ProtocolClient) -> str:
    """All HTML that the client got so far."""
    parts: list[str] = []
    for message in client.messages:
        for key in ("props", "updates"):
            parts.append(str(message.fields.get(key, {}).get("content", "")))
    return "\n".join(parts)


def press(client: ProtocolClient, label: str) -> None:
    client.set_value(client.uuid_of(label), True)


def test_the_answer_has_every_hop_and_the_product_in_four_forms() -> None:
    tree = FrameTree()
    tree.set_static("base_link", "mast", Transform.from_xyz_rpy((0, 0, 1), (0, 0, 0)))
    tree.set("mast", "laser", Transform.from_xyz_rpy((1, 0, 0), (0, 0, 0.5)))
    html = answer_html(explain(tree, "base_link", "laser"))
    assert "laser is a child of mast (transform)" in html
    assert "mast is a child of base_link (static transform)" in html
    assert "<td>1.0000 0.0000 1.0000</td>" in html
    assert "<td>0.0000 0.0000 28.648</td>" in html or "28.648" in html
    assert "0.2474" in html
    assert "0.8776  -0.4794" in html


def test_no_answer_says_why_and_shows_nothing_raw() -> None:
    tree = FrameTree()
    tree.declare("a")
    html = answer_html(explain(tree, "a", "<script>"))
    assert "<script>" not in html
    assert "no frame &#x27;&lt;script&gt;&#x27;" in html
    assert "canTransform argument source_frame" in html


@pytest.mark.parametrize(
    "arguments",
    [
        "0.1 0 0.2 0 0 0 base_link base_laser",
        "--x 0.1 --z 0.2 --frame-id base_link --child-frame-id base_laser",
    ],
)
def test_a_static_transform_is_added_and_removed_by_hand(
    viz: Visualizer, client: ProtocolClient, arguments: str
) -> None:
    client.set_value(client.uuid_of("Arguments"), arguments)
    press(client, "Add transform")
    client.wait_until(lambda: "base_link → base_laser is set" in said(client))
    T = viz.frames.lookup("base_link", "base_laser")
    assert T.translation.tolist() == [0.1, 0.0, 0.2]
    press(client, "Remove transform")
    client.wait_until(lambda: "base_laser is removed" in said(client))
    assert "base_laser" not in viz.frames


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ("0 0 0", "Extra unparsed arguments on command-line"),
        ("0 0 0 0 0 0 front_caster base_link", "would form a ring"),
    ],
)
def test_a_static_transform_that_cannot_be_is_refused_in_words(
    client: ProtocolClient, arguments: str, reason: str
) -> None:
    client.set_value(client.uuid_of("Arguments"), arguments)
    press(client, "Add transform")
    client.wait_until(lambda: reason in said(client))


def test_the_numbers_follow_a_joint_that_moves(
    viz: Visualizer, client: ProtocolClient
) -> None:
    client.set_value(client.uuid_of("From"), "base_link")
    client.set_value(client.uuid_of("To"), "drivewhl_l_link")
    viz.set_joint_positions({"drivewhl_l_joint": 0.5})
    client.wait_until(lambda: "0.0000 0.5000 0.0000" in said(client))

"""`viz.link` and `viz.frame`: colours of links, and nodes that move with frames."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest
from inside import session_of, viser_server
from PIL import Image
from protocol_client import ProtocolClient

from sambot_viz import Robot, UsageError, Visualizer, load_robot
from sambot_viz.errors import FrameError

Protocol = Callable[..., ProtocolClient]
LEFT = "drivewhl_l_link"


@pytest.fixture
def client(viz: Visualizer, protocol: Protocol) -> ProtocolClient:
    client = protocol(urlsplit(viz.url).port or 0)
    client.settle(viser_server(viz))
    return client


def without_wheels(robot: Robot) -> Robot:
    """The same robot with one link."""
    assert robot.root == "base_link"
    return load_robot('<robot name="sam_bot"><link name="base_link"/></robot>')


def sent(client: ProtocolClient, node: str, mark: int = 0) -> dict[str, Any]:
    """Where a node is, and whether it is shown, as far as that was sent."""
    found: dict[str, Any] = {}
    for message in client.since(mark):
        if message.fields.get("name") == node:
            for field in ("position", "wxyz", "visible"):
                if field in message.fields:
                    found[field] = message.fields[field]
    return found


def colors(client: ProtocolClient, mark: int) -> list[Any]:
    """The colours that nodes were given."""
    updates = [m.fields.get("updates", {}) for m in client.since(mark)]
    return [update["color"] for update in updates if "color" in update]


def test_a_node_of_a_link_moves_with_it(
    viz: Visualizer, client: ProtocolClient
) -> None:
    link = viz.link(LEFT)
    viz.viser.scene.add_box(f"{link.node}/box", dimensions=(0.1, 0.1, 0.1))
    client.settle(viz.viser)
    T = viz.frames.lookup("base_link", LEFT).matrix
    assert sent(client, link.node)["position"] == pytest.approx(T[:3, 3])
    mark = client.mark()
    viz.set_joint_positions({"drivewhl_l_joint": math.pi / 2})
    client.settle(viz.viser)
    R = viz.frames.lookup("base_link", LEFT).matrix[:3, :3]
    w, x, y, z = sent(client, link.node, mark)["wxyz"]
    column = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)]
    assert column == pytest.approx(R[:, 0].tolist(), abs=1e-6)
    mark = client.mark()
    viz.set_joint_positions({"drivewhl_r_joint": 1.0})
    client.settle(viz.viser)
    assert sent(client, link.node, mark) == {}


def test_a_node_of_a_frame_stays_when_the_frame_is_hung_elsewhere(
    viz: Visualizer, client: ProtocolClient
) -> None:
    viz.set_static_transform("base_link", "arm/laser", (0.0, 0.0, 1.0))
    node = viz.frame("arm/laser").node
    viz.viser.scene.add_label(f"{node}/text", "laser")
    client.settle(viz.viser)
    mark = client.mark()
    viz.set_static_transform(LEFT, "arm/laser", (0.0, 0.0, 1.0))
    client.settle(viz.viser)
    there = viz.frames.lookup("base_link", "arm/laser").matrix[:3, 3]
    assert sent(client, node, mark)["position"] == pytest.approx(there)
    gone = [m for m in client.since(mark) if "Remove" in m.type]
    assert not any(str(m.fields["name"]).startswith(node) for m in gone)
    assert node.count("/") == 1


def test_nodes_and_colours_stay_when_the_model_is_loaded_again(
    viz: Visualizer, client: ProtocolClient, sam_bot: Robot
) -> None:
    link = viz.link(LEFT)
    link.color = (255, 0, 0)
    client.settle(viz.viser)
    mark = client.mark()
    viz.server.sessions.show_robot(without_wheels(sam_bot))
    client.settle(viz.viser)
    assert sent(client, link.node, mark) == {"visible": False}
    with pytest.raises(UsageError, match=f"no RobotModel shows a link '{LEFT}'"):
        link.alpha = 0.5
    mark = client.mark()
    viz.server.sessions.show_robot(sam_bot)
    client.settle(viz.viser)
    assert sent(client, link.node, mark)["visible"] is True
    assert link.color == (255, 0, 0)
    assert [255, 0, 0] in [[*color] for color in colors(client, mark)]


def test_a_link_is_coloured_highlighted_and_has_its_own_look_again(
    viz: Visualizer, client: ProtocolClient
) -> None:
    link = viz.link("base_link")

    def drawn(change: Callable[[], object]) -> list[tuple[int, ...]]:
        mark = client.mark()
        change()
        client.settle(viz.viser)
        return [tuple(color) for color in colors(client, mark)]

    def paint(color: Any) -> None:
        link.color = color

    assert drawn(lambda: paint(np.array([255, 0, 0]))) == [(255, 0, 0)]
    assert drawn(link.highlight) == [(255, 224, 0)]
    assert drawn(lambda: paint((0, 255, 0))) == []
    assert drawn(lambda: link.highlight(False)) == [(0, 255, 0)]
    assert drawn(lambda: paint(None)) == [(0, 255, 255)]
    assert link.color is None
    assert not session_of(viz).history.modified.value
    wrong: list[Any] = ["red!", (1, 2), (1.5, "a", 0), 7]
    for color in wrong:
        with pytest.raises(UsageError, match="color"):
            link.color = color


def test_a_texture_is_back_when_the_colour_is_gone(
    tmp_path: Path, protocol: Protocol
) -> None:
    Image.new("RGB", (4, 4), (9, 9, 9)).save(tmp_path / "t.png")
    file = tmp_path / "box.urdf"
    file.write_text(
        '<robot name="box"><link name="box"><visual><geometry><box size="1 1 1"/>'
        '</geometry><material name="m"><texture filename="file://t.png"/></material>'
        "</visual></link></robot>".replace("file://", f"file://{tmp_path}/")
    )
    with Visualizer(file, port=0) as viz:
        client = protocol(urlsplit(viz.url).port or 0)
        client.wait_until(lambda: "GlbMessage" in client.types())
        client.settle(viz.viser)
        link = viz.link("box")

        def drawn(color: Any) -> set[str]:
            mark = client.mark()
            link.color = color
            client.settle(viz.viser)
            kinds = {"GlbMessage", "BoxMessage", "MeshMessage"}
            return {m.type for m in client.since(mark)} & kinds

        assert drawn((255, 0, 0)) == {"BoxMessage"}
        assert drawn((0, 255, 0)) == set()
        assert drawn(None) == {"GlbMessage"}


def test_alpha_and_box_of_a_link_are_its_rows(
    viz: Visualizer, client: ProtocolClient
) -> None:
    link = viz.link(LEFT)
    assert (link.visible, link.alpha) == (True, 1.0)
    link.alpha = 0.25
    link.visible = False
    assert (link.visible, link.alpha) == (False, 0.25)
    assert repr(link) == f"<link '{LEFT}'>"
    found = session_of(viz).document.config.displays[1]
    display = session_of(viz).scene.display_of(found)
    assert display is not None
    links = {entries.title: entries for entries in display.entries()}["Links"]
    assert links.item(LEFT).get("Alpha") == 0.25
    with pytest.raises(UsageError, match="must be a number"):
        link.alpha = "half"  # type: ignore[assignment]


def test_a_wrong_name_is_answered_with_the_nearest(viz: Visualizer) -> None:
    with pytest.raises(UsageError, match="no link 'bse_link'; did you mean"):
        viz.link("bse_link")
    with pytest.raises(FrameError, match="no frame 'bse_link'; did you mean"):
        viz.frame("bse_link")


def test_each_private_session_has_its_own_anchor(
    make_viz: Callable[..., Visualizer], protocol: Protocol
) -> None:
    viz = make_viz(session="private")
    pages = [protocol(urlsplit(viz.url).port or 0)]
    pages[0].settle(viz.viser)
    node = viz.link(LEFT).node
    pages.append(protocol(urlsplit(viz.url).port or 0))
    for page in pages:
        page.settle(viz.viser)
        assert "position" in sent(page, node)


def test_a_private_copy_has_the_colours(viz: Visualizer) -> None:
    viz.link(LEFT).color = (1, 2, 3)
    viz.link("base_link").highlight()
    copy = session_of(viz).copy()
    assert copy.link_colors == {LEFT: (1, 2, 3)}
    assert copy.highlighted == {"base_link"}

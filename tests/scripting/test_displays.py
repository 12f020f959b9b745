"""`viz.displays`: what a program sets is drawn, and the Displays panel shows it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pytest
from inside import session_of, viser_server
from protocol_client import ProtocolClient, Received

from sambot_viz import UsageError, Visualizer
from sambot_viz.errors import ServerError

Protocol = Callable[..., ProtocolClient]


@pytest.fixture
def client(viz: Visualizer, protocol: Protocol) -> ProtocolClient:
    client = protocol(urlsplit(viz.url).port or 0)
    client.settle(viser_server(viz))
    return client


def test_displays_are_found_by_name_and_listed_in_order(viz: Visualizer) -> None:
    names = [display.name for display in viz.displays]
    assert names[:3] == ["Grid", "RobotModel", "TF"]
    assert len(viz.displays) == len(names)
    assert "TF" in viz.displays and "tf" not in viz.displays
    assert viz.displays["TF"].kind == "rviz_default_plugins/TF"
    assert repr(viz.displays["TF"]) == "<display 'TF'>"
    with pytest.raises(UsageError, match=r"no display 'Girds'; did you mean 'Grid'\?"):
        viz.displays["Girds"]


def test_a_value_is_set_drawn_and_shown_in_its_row(
    viz: Visualizer, client: ProtocolClient
) -> None:
    tf = viz.displays["TF"]
    assert tf.get("Show Names") is True
    mark = client.mark()
    tf.set("Show Names", np.bool_(False))
    client.settle(viz.viser)
    gone = [m for m in client.since(mark) if "Remove" in m.type]
    assert len(gone) == 5
    assert client.shown("displays", "TF", "Show Names") is False
    assert tf.values["Show Names"] is False
    viz.displays["Grid"].set("Color", np.array([10, 20, 30]))
    viz.displays["Grid"].set("Line Style/Line Width", np.float32(0.5))
    viz.displays["Grid"].enabled = False
    client.settle(viz.viser)
    assert viz.displays["Grid"].get("Color") == (10, 20, 30)
    assert client.shown("displays", "Grid") is False
    assert not viz.displays["Grid"].enabled


def test_a_link_of_a_display_has_values_too(
    viz: Visualizer, client: ProtocolClient
) -> None:
    model, name = viz.displays["RobotModel"], "base_link"
    model.set(f"Links/{name}/Alpha", 0.5)
    viz.displays["TF"].set("Frames/front_caster/Value", False)
    client.settle(viz.viser)
    session = session_of(viz)
    found = session.scene.display_of(session.document.config.displays[1])
    assert found is not None
    links = {entries.title: entries for entries in found.entries()}["Links"]
    assert links.item(name).get("Alpha") == 0.5
    with pytest.raises(UsageError, match="has no link 'base_lnk'"):
        model.set("Links/base_lnk/Alpha", 0.5)


def test_what_is_wrong_is_said_with_the_nearest_name(viz: Visualizer) -> None:
    tf = viz.displays["TF"]
    with pytest.raises(UsageError, match="did you mean 'Show Names'"):
        tf.set("Show Nmes", False)
    with pytest.raises(UsageError, match="did you mean 'Show Names'"):
        tf.get("Show Nmes")
    with pytest.raises(UsageError, match="'Show Names' must be"):
        tf.set("Show Names", 5)
    with pytest.raises(UsageError, match="no display type 'Grd'; did you mean 'Grid'"):
        viz.displays.add("Grd")
    with pytest.raises(UsageError, match="did you mean 'Length'"):
        viz.displays.add("Axes", "tool", {"Lenght": 1.0})
    assert "tool" not in viz.displays


def test_a_display_is_added_and_removed(
    viz: Visualizer, client: ProtocolClient
) -> None:
    before = len(viz.displays)
    axes = viz.displays.add(
        "Axes", "tool", {"Reference Frame": "front_caster", "Length": 0.1}
    )
    client.settle(viz.viser)
    assert (axes.name, axes.enabled, axes.get("Length")) == ("tool", True, 0.1)
    assert client.shown("displays", "tool", "Reference Frame") == "front_caster"
    again = viz.displays.add("Axes", "tool")
    again.set("Length", 0.2)
    assert (axes.get("Length"), again.get("Length")) == (0.1, 0.2)
    viz.displays.remove("tool")
    viz.displays.remove("tool")
    client.settle(viz.viser)
    assert len(viz.displays) == before
    assert "tool" not in {row.get("name") for row in client.rows.values()}
    with pytest.raises(UsageError, match="no display 'tool'"):
        axes.set("Length", 1.0)


def test_a_user_undoes_only_what_the_user_has_done(
    viz: Visualizer, client: ProtocolClient
) -> None:
    client.edit(client.id_of("displays", "TF", "Show Axes"), False)
    client.settle(viz.viser)
    viz.displays["TF"].set("Show Names", False)
    client.act("edit/undo")
    client.settle(viz.viser)
    assert client.shown("displays", "TF", "Show Axes") is True
    assert client.shown("displays", "TF", "Show Names") is False


def sizes(message: Received) -> list[float]:
    """The dimensions of a box that was sent."""
    return [*message.fields.get("props", {}).get("dimensions", ())]


def test_a_program_shows_a_robot_from_any_file(
    viz: Visualizer, tmp_path: Path, client: ProtocolClient
) -> None:
    file = tmp_path / "box.urdf"
    file.write_text(
        '<robot name="box"><link name="box"><visual><geometry><box size="1 1 1"/>'
        "</geometry></visual></link></robot>"
    )
    viz.displays.add(
        "RobotModel",
        "second",
        {"Description Source": "File", "Description File": str(file)},
    )
    client.wait_until(
        lambda: [1.0, 1.0, 1.0] in [sizes(m) for m in client.since(0)], timeout=30.0
    )


def test_displays_of_private_sessions_change_in_all_of_them(
    make_viz: Callable[..., Visualizer], protocol: Protocol
) -> None:
    viz = make_viz(session="private")
    with pytest.raises(ServerError, match="no browser"):
        viz.displays["TF"]
    pages = [protocol(urlsplit(viz.url).port or 0) for _ in range(2)]
    for page in pages:
        page.settle(viz.viser)
    viz.displays["TF"].set("Show Names", False)
    for page in pages:
        page.settle(viz.viser)
        assert page.shown("displays", "TF", "Show Names") is False

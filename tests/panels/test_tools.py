"""The toolbar and the Tool Properties panel of one browser."""

from __future__ import annotations

import pytest
from panel_rows import data_of, edit, panel_of, rows_of

from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.errors import UsageError
from sambot_viz.panels.tools import ToolPropertiesPanel, ToolsPanel
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client

TOOLS = ("Interact", "Move Camera", "Select", "Focus Camera", "Measure")


@pytest.fixture
def panel(session: Session, client: Client) -> ToolsPanel:
    return panel_of(ToolsPanel, session, client)


def current(panel: ToolsPanel) -> list[str]:
    """The tools that are shown as pressed."""
    return [tool["name"] for tool in data_of(panel)["tools/list"] if tool["current"]]


def test_there_is_a_button_and_a_key_for_each_tool(panel: ToolsPanel) -> None:
    keys = {tool["name"]: tool["key"] for tool in data_of(panel)["tools/list"]}
    assert keys == dict(zip(TOOLS, "imscn", strict=True))


@pytest.mark.parametrize("first", TOOLS)
@pytest.mark.parametrize("second", TOOLS)
def test_a_button_always_chooses_its_tool(
    panel: ToolsPanel, first: str, second: str
) -> None:
    edit(panel, "tools/choose", [first])
    edit(panel, "tools/choose", [second])
    assert current(panel) == [second]


@pytest.mark.parametrize("first", TOOLS)
@pytest.mark.parametrize("second", TOOLS)
def test_a_key_chooses_its_tool_and_leaves_it_again(
    panel: ToolsPanel, first: str, second: str
) -> None:
    default = current(panel)
    edit(panel, "tools/choose", [first])
    edit(panel, "tools/press", [second])
    assert current(panel) == (default if first == second else [second])


def test_escape_goes_back_to_the_default_tool(panel: ToolsPanel) -> None:
    default = current(panel)
    edit(panel, "tools/choose", ["Measure"])
    edit(panel, "tools/escape", [])
    assert current(panel) == default


def test_the_hint_is_that_of_the_tool(panel: ToolsPanel) -> None:
    edit(panel, "tools/choose", ["Select"])
    data = data_of(panel)
    (select,) = (tool for tool in data["tools/list"] if tool["name"] == "Select")
    assert data["tools/hint"]["text"] == select["help"]


def test_controls_of_interactive_markers_are_visible_with_their_tool(
    panel: ToolsPanel, session: Session
) -> None:
    edit(panel, "tools/choose", ["Interact"])
    assert data_of(panel)["tools/controls"]
    edit(panel, "tools/choose", ["Select"])
    assert not data_of(panel)["tools/controls"]
    kind = "rviz_default_plugins/Interact"
    session.document.set_tool_property(kind, "Hide Inactive Objects", False)
    assert data_of(panel)["tools/controls"]


def test_fingers_have_a_hint_of_their_own(panel: ToolsPanel) -> None:
    hint = data_of(panel)["tools/hint"]
    assert "Left" in hint["text"]
    assert hint["touch"].startswith("One finger")


def test_what_is_selected_is_named(panel: ToolsPanel, client: Client) -> None:
    assert data_of(panel)["tools/selected"] == []
    client.tools.select({Selectable("link", "base_link")}, None)
    assert data_of(panel)["tools/selected"] == ["base_link"]


def test_there_is_no_such_tool(panel: ToolsPanel) -> None:
    with pytest.raises(UsageError, match="no tool 'Paint'"):
        edit(panel, "tools/press", ["Paint"])


def test_the_colour_of_measure_is_a_row(session: Session, client: Client) -> None:
    panel = panel_of(ToolPropertiesPanel, session, client)
    rows = rows_of(panel)
    assert rows["tool_properties/Measure"].name == "Measure"
    color = rows["tool_properties/Measure/Line color"]
    assert tuple(color.value) == (128, 128, 0)
    edit(panel, color.id, "255; 0; 0")
    assert tuple(rows_of(panel)[color.id].value) == (255, 0, 0)


def test_two_clicks_on_a_link_name_the_joint_that_moves_it(
    session: Session, client: Client, panel: ToolsPanel
) -> None:
    left, body = Selectable("link", "drivewhl_l_link"), Selectable("link", "base_link")
    for number, (item, row) in enumerate(
        ((left, "j/drivewhl_l_joint"), (body, None), (None, None)), 1
    ):
        client.tools.pointed = item, number
        told = data_of(panel)["tools/pointed"]
        assert (told["number"], told["row"]) == (number, row)
    caster = session.robot.joint_of("front_caster")
    assert caster is None, "a fixed joint moves nothing"

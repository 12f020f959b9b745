"""The toolbar and the Tool Properties panel of one browser."""

from __future__ import annotations

import pytest
from panel_rows import edit, rows_of

from sambot_viz.errors import UsageError
from sambot_viz.panels.tools import ToolPropertiesPanel, ToolsPanel
from sambot_viz.session import Session
from sambot_viz.session.browser.browser import Browser
from sambot_viz.tools.picking.hit import Selectable

TOOLS = ("Interact", "Move Camera", "Select", "Focus Camera", "Measure")


@pytest.fixture
def panel(session: Session, browser: Browser) -> ToolsPanel:
    return ToolsPanel(session, browser)


def current(panel: ToolsPanel) -> list[str]:
    """The tools that are shown as pressed."""
    return [row.name for row in panel.rows() if row.value is True]


def test_there_is_a_button_and_a_key_for_each_tool(panel: ToolsPanel) -> None:
    rows = rows_of(panel)
    keys = {name: (rows[f"tool/{name}"].extra or {})["key"] for name in TOOLS}
    assert keys == dict(zip(TOOLS, "imscn", strict=True))


@pytest.mark.parametrize("first", TOOLS)
@pytest.mark.parametrize("second", TOOLS)
def test_a_button_always_chooses_its_tool(
    panel: ToolsPanel, first: str, second: str
) -> None:
    edit(panel, f"tool/{first}", [])
    edit(panel, f"tool/{second}", [])
    assert current(panel) == [second]


@pytest.mark.parametrize("first", TOOLS)
@pytest.mark.parametrize("second", TOOLS)
def test_a_key_chooses_its_tool_and_leaves_it_again(
    panel: ToolsPanel, first: str, second: str
) -> None:
    default = current(panel)
    edit(panel, f"tool/{first}", [])
    edit(panel, "tools/press", [second])
    assert current(panel) == (default if first == second else [second])


def test_escape_goes_back_to_the_default_tool(panel: ToolsPanel) -> None:
    default = current(panel)
    edit(panel, "tool/Measure", [])
    edit(panel, "tools/escape", [])
    assert current(panel) == default


def test_the_hint_is_that_of_the_tool(panel: ToolsPanel) -> None:
    edit(panel, "tool/Select", [])
    assert rows_of(panel)["tools/hint"].value == rows_of(panel)["tool/Select"].help


def test_fingers_have_a_hint_of_their_own(panel: ToolsPanel) -> None:
    rows = rows_of(panel)
    assert "Left" in rows["tools/hint"].value
    assert (rows["tools/hint"].extra or {})["touch"].startswith("One finger")


def test_what_is_selected_is_named(panel: ToolsPanel, browser: Browser) -> None:
    assert rows_of(panel)["tools/selected"].value == []
    browser.tools.select({Selectable("link", "base_link")}, None)
    assert rows_of(panel)["tools/selected"].value == ["base_link"]


def test_there_is_no_such_tool(panel: ToolsPanel) -> None:
    with pytest.raises(UsageError, match="no tool 'Paint'"):
        edit(panel, "tools/press", ["Paint"])


def test_the_colour_of_measure_is_a_row(session: Session, browser: Browser) -> None:
    panel = ToolPropertiesPanel(session, browser)
    rows = rows_of(panel)
    assert rows["tool_properties/Measure"].name == "Measure"
    color = rows["tool_properties/Measure/Line color"]
    assert tuple(color.value) == (128, 128, 0)
    edit(panel, color.id, "255; 0; 0")
    assert tuple(rows_of(panel)[color.id].value) == (255, 0, 0)

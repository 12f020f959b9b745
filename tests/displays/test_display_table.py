"""docs/displays.md says what the declarations say."""

from __future__ import annotations

from pathlib import Path

from display_table import display_table

PAGE = Path(__file__).parents[2] / "docs" / "displays.md"


def test_the_page_of_displays_is_made_from_the_declarations() -> None:
    assert PAGE.read_text("utf-8") == display_table(), "write docs/displays.md again"


def test_the_page_names_every_display_and_its_levels() -> None:
    table = display_table()
    assert "## RobotModel" in table
    assert "| Marker Scale | `1` | shown |" in table
    assert "| Tree |  | kept |" in table

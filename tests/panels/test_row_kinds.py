"""Every kind of row that a panel can send is drawn by the page."""

import re
from pathlib import Path
from typing import get_args

from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.panels.rows.row import Kind

SAME_ICON = [{"PointCloud", "PointCloud2"}]
"""Displays that draw the same."""
WITHOUT_CELL = {"group", "note", "lines"}
"""Rows that are a name, or a text over the whole width."""


def test_the_page_has_a_cell_for_every_kind_of_row(repository: Path):
    script = repository / "src/sambot_viz/page/cells/cells.js"
    table = re.search(
        r"const CELLS = \{(.*?)^\};", script.read_text("utf-8"), re.S | re.M
    )
    assert table is not None
    drawn = set(re.findall(r"^  (\w+):", table[1], re.M))
    assert drawn == set(get_args(Kind)) - WITHOUT_CELL


def test_every_class_of_displays_has_an_icon_of_its_own(repository: Path):
    script = repository / "src/sambot_viz/page/window/display_icons.js"
    found = re.findall(r"^  (\w+):\s+([^,]+),$", script.read_text("utf-8"), re.M)
    assert {name for name, _ in found} == {kind.rpartition("/")[2] for kind in DISPLAYS}
    names: dict[str, set[str]] = {}
    for name, picture in found:
        names.setdefault(picture, set()).add(name)
    assert [same for same in names.values() if len(same) > 1] == SAME_ICON

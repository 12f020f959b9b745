"""Every kind of row that a panel can send is drawn by the page."""

import re
from pathlib import Path
from typing import get_args

from sambot_viz.panels.rows.row import Kind

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

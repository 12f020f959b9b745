"""A panel as a page uses it: its rows by id, and edits through the gate."""

from __future__ import annotations

from typing import Any

from sambot_viz.panels import gate
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Row


def rows_of(panel: Panel) -> dict[str, Row]:
    """The rows that it has now, by id; each comes after the row above it."""
    rows: dict[str, Row] = {}
    for row in panel.rows():
        assert row.id not in rows, f"two rows {row.id}"
        assert not row.above or row.above in rows, f"{row.id} is above nothing"
        rows[row.id] = row
    return rows


def row_named(panel: Panel, name: str) -> Row:
    """The only row with this label."""
    (row,) = (row for row in panel.rows() if row.name == name)
    return row


def edit(panel: Panel, row_id: str, value: Any) -> None:
    """Set a row to a value that a browser has sent.

    Raises:
        SambotVizError: the value is refused.
    """
    row = rows_of(panel)[row_id]
    checked = gate.checked(row, value)
    assert row.set is not None
    row.set(checked)

"""A panel as a page uses it: its rows, data and commands, and edits with validation."""

from __future__ import annotations

from typing import Any

from sambot_viz.panels import validation
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Row


def rows_of(panel: Panel) -> dict[str, Row]:
    """The rows that it has now, by id; each comes after the row above it."""
    rows: dict[str, Row] = {}
    for row in panel.rows():
        assert row.id not in rows, f"two rows {row.id}"
        assert not row.parent or row.parent in rows, f"{row.id} has no parent"
        rows[row.id] = row
    return rows


def data_of(panel: Panel) -> dict[str, Any]:
    """The values of the data that it has now, by id."""
    return {data.id: data.value for data in panel.data()}


def commands_of(panel: Panel) -> set[str]:
    """The ids of the commands that can be called now."""
    return {command.id for command in panel.commands()}


def row_named(panel: Panel, name: str) -> Row:
    """The only row with this label."""
    (row,) = (row for row in panel.rows() if row.name == name)
    return row


def edit(panel: Panel, item_id: str, value: Any = None) -> object:
    """Set a row to a value that a browser has sent, or call a command.

    Raises:
        SambotVizError: the value is refused.
    """
    items = {item.id: item for item in panel.items()}
    return validation.accept(items[item_id], value, may_edit=True)()

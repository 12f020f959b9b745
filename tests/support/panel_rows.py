"""A panel as a page uses it: its rows, data and commands, and edits with validation."""

from __future__ import annotations

from collections.abc import Callable
from inspect import signature
from typing import Any, TypeVar

from sambot_viz.panels import validation
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Row
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client
from sambot_viz.session.scene.joint_arrow import JointArrow

P = TypeVar("P", bound=Panel)


def panel_of(
    kind: Callable[..., P], session: Session, client: Client | None = None, **more: Any
) -> P:
    """Make a panel: its arguments have the names of the session's parts.

    Args:
        kind: its class.
        session: what it shows.
        client: for whom.
        more: other arguments; without them it says and remakes nothing.
    """
    given = {
        "client": client,
        "client_id": client and client.client_id,
        "arrow": JointArrow(session.scene, session.worker),
        "say": lambda sentence, level: None,
        "remake": lambda panel: None,
        "folders": True,
        **more,
    }
    names = signature(kind).parameters
    return kind(**{n: given[n] if n in given else getattr(session, n) for n in names})


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

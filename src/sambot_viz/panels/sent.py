"""Read the messages of browsers, before they are checked.

A message is a list: the id of a row and its new value, or the id of a command and its
arguments; and, for one continuous gesture (a drag, a held key), the number of that
gesture. `panels.validation` checks the value.

This module imports no panels, so that the port is open before they are imported.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

from sambot_viz import limits

if TYPE_CHECKING:
    from sambot_viz.panels.rows.row import Json


@dataclass(frozen=True, slots=True)
class Sent:
    """A value that a browser wants a row to have, or a command to be called with.

    Attributes:
        id: of the row or command.
        value: not checked yet.
        gesture: the same number for all values of one drag; None for a single one.
    """

    id: str
    value: Json
    gesture: int | None


def read(message: object) -> Sent | None:
    """Read a message of a browser; None if it is not an edit."""
    if not isinstance(message, list) or not 2 <= len(cast("list[Any]", message)) <= 3:
        return None
    parts = cast("list[Any]", message)
    gesture = parts[2] if len(parts) == 3 else None
    if not isinstance(parts[0], str) or len(parts[0]) > limits.PAGE_ID.value:
        return None
    if isinstance(gesture, bool) or not isinstance(gesture, int | None):
        return None
    return Sent(parts[0], parts[1], gesture)

"""The rows that a page has, from what its channel has brought."""

from __future__ import annotations

import gzip
import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from sambot_viz.panels.rows.row_store import COMPRESSED

Row = dict[str, Any]
"""As the page gets it, what differs from the defaults by name; and its "panel"."""


def decode(message: str | bytes) -> Any:
    """What a message of the channel says, from a text or a binary frame."""
    if isinstance(message, bytes):
        assert message.startswith(COMPRESSED), message[:20]
        return json.loads(gzip.decompress(message[len(COMPRESSED) :]))
    return json.loads(message)


class PageRows:
    """The rows of the session and of one client, with all patches in them."""

    def __init__(self) -> None:
        self.scopes: dict[str, dict[str, list[Row]]] = {}

    def take(self, patch: Mapping[str, Any]) -> None:
        """Apply a patch."""
        scope = patch["of"]
        if patch.get("all"):
            self.scopes[scope] = {}
        panels = self.scopes[scope]
        panels.update(patch.get("panels", {}))
        changes = patch.get("rows", {})
        for name, rows in panels.items():
            if any(row["id"] in changes for row in rows):
                panels[name] = [_patched(row, changes.get(row["id"])) for row in rows]

    def by_id(self) -> dict[str, Row]:
        """The rows by id, in the order of their panels."""
        return {
            row["id"]: {**row, "panel": name}
            for panels in list(self.scopes.values())
            for name, rows in list(panels.items())
            for row in rows
        }


def _patched(row: Row, patch: Row | None) -> Row:
    # A page lays its trees out when it is sent all rows of a panel.
    assert "in" not in (patch or {}), f"{row} is not moved by {patch}"
    new = row | (patch or {})
    return {key: value for key, value in new.items() if value is not None}


def named(rows: Mapping[str, Row], names: Sequence[str]) -> Row:
    """The row with the last of some names, below rows with those before it.

    Args:
        rows: all rows.
        names: of the row, before it of rows above, first of the panel.

    Raises:
        AssertionError: there is none, or more than one.
    """
    found = [row for row in rows.values() if _fits(row, rows, list(names))]
    if len(found) != 1:
        panel = [row for row in rows.values() if row["panel"] == names[0]]
        known = sorted({row.get("name", "") for row in panel})
        raise AssertionError(f"{len(found)} rows {names}; there are {known}")
    return found[0]


def _fits(row: Row, rows: Mapping[str, Row], names: list[str]) -> bool:
    if row.get("name") != names[-1]:
        return False
    panel, *left = names[:-1]
    if row["panel"] != panel:
        return False
    for above in _above(row, rows):
        if left and above.get("name") == left[-1]:
            left.pop()
    return not left


def _above(row: Row, rows: Mapping[str, Row]) -> Iterator[Row]:
    while row["in"]:
        row = rows[row["in"]]
        yield row

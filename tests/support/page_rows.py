"""The rows that a page has, from the elements that carry them to it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

Row = dict[str, Any]
"""As the page gets it, what differs from the defaults by name; and its "panel"."""

_ELEMENT = re.compile(
    r'<script type="application/json" data-sambot="(?P<what>\w+)" '
    r'data-of="(?P<scope>\w+)">(?P<data>.*)</script>',
    re.DOTALL,
)


def rows_in(contents: Iterable[str]) -> dict[str, Row]:
    """The rows by id, in the order of their panels.

    Args:
        contents: of viser's HTML elements, as they are now. Those that carry no rows
            are left out.
    """
    parts: dict[tuple[str, str], Any] = {}
    for content in contents:
        found = _ELEMENT.fullmatch(content)
        if found:
            parts[found["scope"], found["what"]] = json.loads(found["data"])
    rows: dict[str, Row] = {}
    for (scope, what), part in parts.items():
        if what == "rows":
            rows |= _merged(part, parts.get((scope, "changes")))
    return rows


def _merged(whole: Any, changes: Any) -> dict[str, Row]:
    panels: dict[str, list[Row]] = dict(whole["panels"])
    patches: dict[str, Row] = {}
    if changes is not None and changes["base"] == whole["base"]:
        panels |= changes["panels"]
        patches = changes["rows"]
    rows = {
        row["id"]: {**row, "panel": name}
        for name, panel in panels.items()
        for row in panel
    }
    for row_id, patch in patches.items():
        if row_id in rows:
            new = rows[row_id] | patch
            rows[row_id] = {
                key: value for key, value in new.items() if value is not None
            }
    return rows


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

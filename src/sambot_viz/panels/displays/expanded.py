"""Which rows are unfolded, as RViz keeps it in the file.

RViz lists them as paths below the Displays panel, such as "/TF1/Frames1": each name is
followed by its number among the rows of the same name.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace

from sambot_viz.panels.row import Row
from sambot_viz.rviz import RvizConfig

_SHOWN = {"Global Status": "Status"}
"""Rows whose name in a path is another one."""


def row_paths(rows: Iterable[Row]) -> Iterator[tuple[Row, str]]:
    """Each row with the path that RViz gives it."""
    paths: dict[str, str] = {}
    seen: Counter[tuple[str, str]] = Counter()
    for row in rows:
        name = _SHOWN.get(row.name, row.name)
        seen[row.above, name] += 1
        paths[row.id] = f"{paths.get(row.above, '')}/{name}{seen[row.above, name]}"
        yield row, paths[row.id]


def mark_expanded(
    rows: Iterable[Row], expanded: Collection[str] | None
) -> Iterator[Row]:
    """The rows, unfolded as the file says, if it says anything."""
    if expanded is None:
        yield from rows
        return
    listed = frozenset(expanded)
    for row, path in row_paths(rows):
        unfolded = path in listed or bool(row.level and row.expanded)
        yield row if unfolded == row.expanded else replace(row, expanded=unfolded)


def keep_expanded(
    config: RvizConfig, rows: Iterable[Row], unfolded: Collection[str]
) -> None:
    """Write into a document which rows are unfolded.

    Paths below rows that only RViz has, such as those of a display that is not shown
    here, stay as they are.

    Args:
        config: the document.
        rows: of the Displays panel, all of them.
        unfolded: the ids of the unfolded ones.
    """
    paths = {path: row.id in unfolded for row, path in row_paths(rows)}
    before = config.expanded or ()
    kept = [p for p in before if paths.get(p, _has_a_row_above(p, paths))]
    new = [p for p, is_open in paths.items() if is_open and p not in kept]
    if kept + new != list(before):
        config.expanded = (*kept, *new)


def _has_a_row_above(path: str, paths: Collection[str]) -> bool:
    return any(path.startswith(f"{known}/") for known in paths)

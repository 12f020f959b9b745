"""The unfolded rows: as RViz lists them in the file, and as pages request them.

RViz lists them as paths below the Displays panel, such as "/TF1/Frames1": each name is
followed by its number among the rows of the same name. A page requests the rows below
one with a command, so that no invisible rows are made.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import replace

from sambot_viz.panels.command import TEXT, Command
from sambot_viz.panels.rows.row import Row
from sambot_viz.rviz import RvizConfig

_SHOWN = {"Global Status": "Status"}
"""Rows whose name in a path is another one."""


class LazyRows:
    """Build child rows on demand, when a client expands their parent.

    Args:
        unfold_id: the id of the command with which a page asks for the rows below one.
        remake: makes the rows of the panel again.
    """

    def __init__(self, unfold_id: str, remake: Callable[[], None]) -> None:
        self._unfold_id = unfold_id
        self._remake = remake
        self._lazy: set[str] = set()
        self._unfolded: set[str] = set()

    def clear(self) -> None:
        """Forget which rows there are, before they are made again."""
        self._lazy.clear()

    def is_unfolded(self, row_id: str) -> bool:
        """Return whether a page wants the rows below this one; if not, it may ask."""
        self._lazy.add(row_id)
        return row_id in self._unfolded

    def command(self) -> Command:
        """Return the command with which a page asks."""
        return Command(self._unfold_id, (TEXT,), self._unfold, client_local=True)

    def _unfold(self, row_id: str) -> None:
        if row_id in self._lazy and row_id not in self._unfolded:
            self._unfolded.add(row_id)
            self._remake()


def row_paths(rows: Iterable[Row]) -> Iterator[tuple[Row, str]]:
    """Yield each row with the path that RViz gives it."""
    paths: dict[str, str] = {}
    seen: Counter[tuple[str, str]] = Counter()
    for row in rows:
        name = _SHOWN.get(row.name, row.name)
        seen[row.parent, name] += 1
        paths[row.id] = f"{paths.get(row.parent, '')}/{name}{seen[row.parent, name]}"
        yield row, paths[row.id]


def listed_rows(
    rows: Iterable[Row], expanded: Collection[str] | None
) -> frozenset[str] | None:
    """Return the ids of the rows that the file unfolds; None when it says nothing."""
    if expanded is None:
        return None
    paths = frozenset(expanded)
    return frozenset(row.id for row, path in row_paths(rows) if path in paths)


def mark_expanded(row: Row, listed: Collection[str] | None) -> Row:
    """Return the row, unfolded as the file says, if it says anything."""
    if listed is None:
        return row
    unfolded = row.id in listed or bool(row.level and row.expanded)
    return row if unfolded == row.expanded else replace(row, expanded=unfolded)


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
    kept = [p for p in before if paths.get(p, _has_a_parent(p, paths))]
    new = [p for p, is_open in paths.items() if is_open and p not in kept]
    if kept + new != list(before):
        config.expanded = (*kept, *new)


def _has_a_parent(path: str, paths: Collection[str]) -> bool:
    return any(path.startswith(f"{known}/") for known in paths)

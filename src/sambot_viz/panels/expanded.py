"""Which rows are unfolded, as RViz keeps it in the file.

RViz lists them as paths below the Displays panel, such as "/TF1/Frames1": each name is
followed by its number among the rows of the same name.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace

from sambot_viz.panels.row import Row
from sambot_viz.rviz import RvizConfig

_PANEL, _TREE, _KEY = "Displays", "Property Tree Widget", "Expanded"


def expanded_rows(config: RvizConfig) -> frozenset[str] | None:
    """The paths that the file lists; None when it has no such list."""
    panels = config.panels
    for panel in panels if isinstance(panels, list) else ():
        if not isinstance(panel, dict):
            continue
        if str(panel.get("Class", "")).rpartition("/")[2] != _PANEL:
            continue
        tree = panel.get(_TREE)
        listed = tree.get(_KEY) if isinstance(tree, dict) else None
        if isinstance(listed, list):
            return frozenset(str(path) for path in listed)
    return None


def row_paths(rows: Iterable[Row]) -> Iterator[tuple[Row, str]]:
    """Each row with the path that RViz gives it."""
    paths: dict[str, str] = {}
    seen: Counter[tuple[str, str]] = Counter()
    for row in rows:
        seen[row.above, row.name] += 1
        number = seen[row.above, row.name]
        paths[row.id] = f"{paths.get(row.above, '')}/{row.name}{number}"
        yield row, paths[row.id]


def mark_expanded(
    rows: Iterable[Row], expanded: frozenset[str] | None
) -> Iterator[Row]:
    """The rows, unfolded as the file says, if it says anything."""
    for row, path in row_paths(rows):
        if expanded is not None and not row.level:
            yield replace(row, expanded=path in expanded)
        elif expanded is not None:
            yield replace(row, expanded=row.expanded or path in expanded)
        else:
            yield row

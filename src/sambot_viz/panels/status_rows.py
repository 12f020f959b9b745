"""The rows of statuses: RViz's sentences, and which frames there are instead."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sambot_viz.displays.display import Display
from sambot_viz.panels.row import Level, Row
from sambot_viz.session import Session

LEVELS: dict[str, Level] = {"Ok": "ok", "Warn": "warn", "Error": "error"}
MOST_NAMES = 12
_STATUS = "status"


def global_status_rows(session: Session) -> Iterator[Row]:
    """RViz's Global Status."""
    status = session.drawn.global_status()
    yield _head(_STATUS, "", "Global Status", status.level, lazy=False)
    there = fixed_frame_missing(session)
    yield Row(
        f"{_STATUS}/Fixed Frame",
        _STATUS,
        "status",
        "Fixed Frame",
        value=there or status.text,
        level=LEVELS[status.level],
    )


def status_rows(
    session: Session, display: Display, row_id: str, above: str, *, all_rows: bool
) -> Iterator[Row]:
    """The status of a display, bad rows first.

    Args:
        session: whose display it is.
        display: one that is shown.
        row_id: the id of its status.
        above: the id of its row.
        all_rows: False leaves out the rows of a status that is Ok.
    """
    status = display.status
    lazy = status.level == "Ok" and not all_rows and bool(status.rows)
    yield _head(row_id, above, "Status", status.level, lazy=lazy)
    if lazy:
        return
    missing = fixed_frame_missing(session)
    if missing and status.level != "Ok":
        level = LEVELS[status.level]
        fixed = f"{row_id}/:fixed"
        yield Row(fixed, row_id, "status", "Fixed Frame", missing, level=level)
    for key, row in sorted(status.rows.items(), key=lambda item: item[1].level == "Ok"):
        level = LEVELS[row.level]
        yield Row(f"{row_id}/{key}", row_id, "status", key, row.text, level=level)


def _head(row_id: str, above: str, name: str, level: str, *, lazy: bool) -> Row:
    return Row(
        row_id,
        above,
        "status",
        name,
        value=level,
        level=LEVELS[level],
        expanded=level != "Ok",
        extra={"whole": True, "lazy": lazy},
    )


def fixed_frame_missing(session: Session) -> str:
    """That the fixed frame does not exist, and which frames do; "" when it does."""
    fixed, frames = session.context.fixed_frame, session.tree.frames
    if fixed in frames or not frames:
        return ""
    return f"Frame [{fixed}] does not exist. There are: {listed(sorted(frames))}"


def listed(names: Sequence[str], most: int = MOST_NAMES) -> str:
    """Some names in a sentence; of many only the first ones."""
    shown = ", ".join(names[:most])
    return f"{shown} and {len(names) - most} more" if len(names) > most else shown

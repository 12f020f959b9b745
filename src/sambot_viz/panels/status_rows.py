"""The rows of statuses: RViz's sentences, and which frames there are instead."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import PurePath

from sambot_viz.displays.display import Display
from sambot_viz.errors import Problem
from sambot_viz.panels.row import Json, Level, Row
from sambot_viz.session.scene.scene import Scene
from sambot_viz.text import text

LEVELS: dict[str, Level] = {"Ok": "ok", "Warn": "warn", "Error": "error"}
MOST_NAMES = 12
FIXED_FRAME = "options/Fixed Frame"
"""The id of the row that sets it."""
_STATUS = "status"
_LONGEST_FILE = 60


def global_status_rows(scene: Scene) -> Iterator[Row]:
    """RViz's Global Status."""
    status = scene.global_status()
    yield _head(_STATUS, "", "Global Status", status.level, lazy=False)
    there = fixed_frame_missing(scene)
    yield Row(
        f"{_STATUS}/Fixed Frame",
        _STATUS,
        "status",
        "Fixed Frame",
        value=there or status.text,
        level=LEVELS[status.level],
        extra=_other_fixed_frame(scene) if there else None,
    )


def status_rows(
    display: Display,
    row_id: str,
    parent: str,
    scene: Scene,
    mistakes: Sequence[Problem],
    *,
    all_rows: bool,
) -> Iterator[Row]:
    """Yield the rows of a display's status, bad ones first.

    Args:
        display: one that is shown.
        row_id: the id of its status.
        parent: the id of its row.
        scene: where it is drawn.
        mistakes: problems of the model, while there is no robot for them.
        all_rows: False leaves out the rows of a status that is Ok.
    """
    status = display.status
    lazy = status.level == "Ok" and not all_rows and bool(status.rows)
    yield _head(row_id, parent, "Status", status.level, lazy=lazy)
    if lazy:
        return
    missing = fixed_frame_missing(scene)
    if missing and status.level != "Ok":
        level = LEVELS[status.level]
        fixed = f"{row_id}/:fixed"
        yield Row(
            fixed,
            row_id,
            "status",
            "Fixed Frame",
            missing,
            level=level,
            extra=_other_fixed_frame(scene),
        )
    own_robot = display.robot_display and display.robot_display.own_robot
    if own_robot is None and status.level != "Ok":
        yield from _why_no_robot(mistakes, row_id)
    for key, row in sorted(status.rows.items(), key=lambda item: item[1].level == "Ok"):
        level = LEVELS[row.level]
        yield Row(f"{row_id}/{key}", row_id, "status", key, row.text, level=level)


def _why_no_robot(mistakes: Sequence[Problem], parent: str) -> Iterator[Row]:
    """Yield the mistakes of the model, each at its line, while there is no robot."""
    errors = [problem for problem in mistakes if problem.severity == "error"]
    for index, problem in enumerate(errors[:MOST_NAMES]):
        where = place_of(problem)
        said = f"{where}: {problem.message}" if where else problem.message
        row_id = f"{parent}/:model{index}"
        yield Row(row_id, parent, "status", "Model", said, level="error")


def place_of(problem: Problem) -> str:
    """Return the name of a problem's file, and the line."""
    if problem.file is None:
        return ""
    name = text(PurePath(problem.file).name, _LONGEST_FILE)
    return name if problem.line is None else f"{name}:{problem.line}"


def _head(row_id: str, parent: str, name: str, level: str, *, lazy: bool) -> Row:
    return Row(
        row_id,
        parent,
        "status",
        name,
        value=level,
        level=LEVELS[level],
        expanded=level != "Ok",
        extra={"whole": True, "lazy": lazy},
    )


def fixed_frame_missing(scene: Scene) -> str:
    """Say that the fixed frame does not exist, and which do; "" when it does."""
    fixed, frames = scene.context.fixed_frame, scene.context.tree.frames
    if fixed in frames or not frames:
        return ""
    return f"Frame [{fixed}] does not exist. There are: {listed(sorted(frames))}"


def _other_fixed_frame(scene: Scene) -> dict[str, Json]:
    """Offer the root of the largest tree of frames: the page sets it by a button."""
    tree = scene.context.tree
    roots: dict[str, str] = {}
    for frame in sorted(tree.frames):
        below: list[str] = []
        root = frame
        while root not in roots and (above := tree.parent(root)) is not None:
            below.append(root)
            root = above
        roots |= dict.fromkeys((*below, root), roots.get(root, root))
    most = Counter(roots.values()).most_common(1)[0][0]
    return {"repair": [f"Use {most}", FIXED_FRAME, most]}


def listed(names: Sequence[str], most: int = MOST_NAMES) -> str:
    """Return some names in a sentence; of many only the first ones."""
    shown = ", ".join(names[:most])
    return f"{shown} and {len(names) - most} more" if len(names) > most else shown

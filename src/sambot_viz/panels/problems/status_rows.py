"""The rows of statuses: RViz's sentences, and which frames there are instead."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from sambot_viz.displays.display import Display
from sambot_viz.displays.robot_display import Repair
from sambot_viz.errors import Problem, nearest
from sambot_viz.panels.problems.problems_panel import place_of, rows_by_place
from sambot_viz.panels.rows.row import Json, Level, Row
from sambot_viz.rviz import TfFrameProperty
from sambot_viz.session.scene.scene import Scene

LEVELS: dict[str, Level] = {"Ok": "ok", "Warn": "warn", "Error": "error"}
MOST_NAMES = 12
FEW_FRAMES = 4
"""A wall of names would hide what follows it; the field of the frame lists them all."""
FIXED_FRAME = "options/Fixed Frame"
"""The id of the row that sets it."""
STATUS = "status"
"""The id of the row of RViz's Global Status."""
_TRANSFORM = "Transform"
_PLACE = re.compile(r"[^\s:]{1,60}:\d{1,9}")
"""A line of a file in a sentence; the file's name is as long as in `place_of`."""
_LONGEST_SENTENCE = 2000
_LONGEST_NAME = 200
"""Of a longer frame no near name is looked for, which would take long."""


def global_status_rows(scene: Scene) -> Iterator[Row]:
    """RViz's Global Status."""
    status = scene.global_status()
    yield _head(STATUS, "", "Global Status", status.level, lazy=False)
    there = fixed_frame_missing(scene)
    yield Row(
        f"{STATUS}/Fixed Frame",
        STATUS,
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
    problems: Sequence[Problem],
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
        problems: those that have rows, which a status that names their line leads to.
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
    rows = dict[str, str]() if status.level == "Ok" else rows_by_place(problems)
    if own_robot is None and status.level != "Ok":
        yield from _why_no_robot(mistakes, row_id, rows)
    frame = _other_frame(display, parent, scene)
    repairs = display.repairs()
    for key, row in sorted(status.rows.items(), key=lambda item: item[1].level == "Ok"):
        level = LEVELS[row.level]
        extra = None
        if row.level != "Ok":
            extra = frame if key == _TRANSFORM else _lines_of(row.text, rows)
            if key in repairs:
                extra = _button(repairs[key], parent)
        yield Row(
            f"{row_id}/{key}", row_id, "status", key, row.text, level=level, extra=extra
        )


def _why_no_robot(
    mistakes: Sequence[Problem], parent: str, rows: Mapping[str, str]
) -> Iterator[Row]:
    """Yield the mistakes of the model, each at its line, while there is no robot."""
    errors = [problem for problem in mistakes if problem.severity == "error"]
    for index, problem in enumerate(errors[:MOST_NAMES]):
        where = place_of(problem)
        said = f"{where}: {problem.message}" if where else problem.message
        row_id = f"{parent}/:model{index}"
        extra = _lines_of(where, rows)
        yield Row(row_id, parent, "status", "Model", said, level="error", extra=extra)


def _lines_of(sentence: str, rows: Mapping[str, str]) -> dict[str, Json] | None:
    """Lead to the problem whose line a sentence names."""
    for place in _PLACE.findall(sentence[:_LONGEST_SENTENCE]):
        if place in rows:
            line = place.rpartition(":")[2]
            return {"leads": [f"Show line {line}", "problems", rows[place]]}
    return None


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
    if len(scene.context.meant(fixed)) > 1:
        return scene.global_status().text
    names = listed(sorted(frames), FEW_FRAMES)
    return f"Frame [{fixed}] does not exist. There are: {names}"


def _other_fixed_frame(scene: Scene) -> dict[str, Json]:
    """Offer the frame with the nearest name, or the root of the largest tree of frames.

    The page sets it by a button.
    """
    tree = scene.context.tree
    if near := _nearest(scene.context.fixed_frame, scene):
        return _use(near, FIXED_FRAME)
    roots: dict[str, str] = {}
    for frame in sorted(tree.frames):
        below: list[str] = []
        root = frame
        while root not in roots and (above := tree.parent(root)) is not None:
            below.append(root)
            root = above
        roots |= dict.fromkeys((*below, root), roots.get(root, root))
    most = Counter(roots.values()).most_common(1)[0][0]
    return _use(most, FIXED_FRAME)


def _use(frame: str, row_id: str) -> dict[str, Json]:
    return {"repair": [f"Use {frame}", row_id, frame]}


def use_other_frame(
    frame: str, row_id: str, other: str, scene: Scene
) -> dict[str, Json] | None:
    """Offer a frame in place of one that does not exist.

    Args:
        frame: the name that a row has.
        row_id: the id of that row.
        other: what may take its place where no name is near.
        scene: has the frames.
    """
    frames = scene.context.tree.frames
    if frame in (other, scene.context.fixed_frame) or frame in frames:
        return None
    return _use(_nearest(frame, scene) or other, row_id)


def _button(repair: Repair, parent: str) -> dict[str, Json]:
    row_id = f"{parent}/{repair.path}"
    return {"repair": [repair.label, row_id, repair.value]}


def _nearest(frame: str, scene: Scene) -> str | None:
    if len(frame) > _LONGEST_NAME:
        return None
    frames = scene.context.tree.frames
    return nearest(frame, [name for name in frames if len(name) <= _LONGEST_NAME])


def _other_frame(display: Display, parent: str, scene: Scene) -> dict[str, Json] | None:
    """Offer another frame for a display whose own one does not exist."""
    config = display.config
    for path, declared in config.declared.items():
        prop = declared.property
        if isinstance(prop, TfFrameProperty):
            row_id, frame = f"{parent}/{path}", str(config.get(path))
            return use_other_frame(frame, row_id, prop.default, scene)
    return None


def listed(names: Sequence[str], most: int = MOST_NAMES) -> str:
    """Return some names in a sentence; of many only the first ones."""
    shown = ", ".join(names[:most])
    return f"{shown} and {len(names) - most} more" if len(names) > most else shown

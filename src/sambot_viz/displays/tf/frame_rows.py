"""The rows of single frames of a TF display."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.entries import EntryList, is_on, numbers
from sambot_viz.displays.scene.poses import position_of
from sambot_viz.geometry import Matrix, wxyz_from_matrix
from sambot_viz.rviz import BoolProperty, DisplayConfig, Property

ALL_ENABLED = "Frames/All Enabled"
ALL_FRAMES = ""
"""Stands for the frames a file does not name."""

FRAME_PROPERTIES: tuple[Property, ...] = (
    BoolProperty("Value", default=True, help="Show the frame and its arrow."),
)


def frame_boxes(config: DisplayConfig) -> dict[str, bool]:
    """The box of every frame the file names, and of all others.

    A frame without a "Value" counts as off, as in RViz.
    """
    boxes = {ALL_FRAMES: bool(config.get(ALL_ENABLED))}
    for frame, entry in config.dynamic("Frames").items():
        if frame != "All Enabled":
            value = entry.get("Value") if isinstance(entry, dict) else entry
            boxes[frame] = is_on(value, default=False)
    return boxes


def set_all_frames(config: DisplayConfig) -> None:
    """Tick or untick the frames that the file names, as All Enabled stands."""
    enabled = bool(config.get(ALL_ENABLED))
    for frame in config.dynamic("Frames"):
        if frame != "All Enabled":
            config.set_dynamic(("Frames", frame, "Value"), enabled)


def frame_entries(context: DisplayContext, config: DisplayConfig) -> EntryList:
    """All frames, in the order in which they became known."""

    def rows(frame: str) -> Mapping[str, Any]:
        boxes = frame_boxes(config)
        return {"Value": boxes.get(frame, boxes[ALL_FRAMES])}

    def set_row(frame: str, row: str, value: Any) -> None:
        config.set_dynamic(("Frames", frame, row), bool(value))

    return EntryList(
        "Frames",
        "frame",
        context.tree.frames,
        FRAME_PROPERTIES,
        rows,
        set_row,
        lambda frame: _facts(context, frame),
    )


def _facts(context: DisplayContext, frame: str) -> Mapping[str, str]:
    tree, fixed = context.tree, context.fixed_frame
    parent = tree.parent(frame)
    facts = {"Parent": parent or "none: it is a root"}
    if context.nodes.connected(frame):
        facts |= _pose("", tree.lookup(fixed, frame).matrix)
    else:
        facts["Position"] = f"no transform to {fixed}"
    if parent is not None:
        facts |= _pose("Relative ", tree.hop(frame).transform.matrix)
    return facts


def _pose(what: str, T: Matrix) -> dict[str, str]:
    w, x, y, z = wxyz_from_matrix(T)
    return {
        f"{what}Position": numbers(position_of(T)),
        f"{what}Orientation": numbers((x, y, z, w)),
    }

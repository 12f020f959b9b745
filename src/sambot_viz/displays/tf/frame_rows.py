"""The properties of a TF display and of its frames, and the rows of single frames."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sambot_viz.displays.display import DisplayContext, EntryList, numbers
from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.geometry import Matrix, wxyz_from_matrix
from sambot_viz.rviz import (
    BoolProperty,
    DisplayConfig,
    EntryItem,
    FloatProperty,
    GroupProperty,
    KeptProperty,
    Property,
    RegexProperty,
)

ALL_ENABLED = "Frames/All Enabled"
BOX = "Value"
"""The property that shows or hides a frame."""

FRAME_PROPERTIES: tuple[Property, ...] = (
    BoolProperty(BOX, default=False, help="Show the frame and its arrow."),
)

TF_PROPERTIES: tuple[Property, ...] = (
    BoolProperty("Show Names", default=False, help="Write each frame's name below it."),
    BoolProperty("Show Axes", default=True, help="Draw the axes of each frame."),
    BoolProperty(
        "Show Arrows", default=True, help="Draw an arrow from each frame to its parent."
    ),
    FloatProperty("Marker Scale", default=1.0, help="Size of names, axes and arrows."),
    FloatProperty(
        "Update Interval",
        default=0.0,
        minimum=0.0,
        unit="s",
        help="Seconds between updates; frames move at once here.",
        support="approximate",
    ),
    FloatProperty(
        "Frame Timeout",
        default=15.0,
        minimum=1.0,
        unit="s",
        help="Seconds after which a frame that messages no longer move vanishes; it "
        "fades from a third of them on. Frames without messages never grow old.",
    ),
    RegexProperty(
        "Filter (whitelist)",
        default="",
        help="Show only frames whose name matches; empty shows all.",
    ),
    RegexProperty(
        "Filter (blacklist)",
        default="",
        help="Hide frames whose name matches; empty hides none.",
    ),
    GroupProperty(
        "Frames",
        help="The frames, each with a box to show or hide it.",
        children=(
            BoolProperty("All Enabled", default=True, help="Show or hide all frames."),
        ),
        open_keys=True,
    ),
    KeptProperty("Tree", note="RViz writes the tree of frames but never reads it"),
    KeptProperty(
        "Marker Alpha", support="none", note="of ROS 1; RViz for ROS 2 ignores it"
    ),
)


class FrameEntries:
    """The frames of one TF display as items of the document.

    A frame that the file lists without a "Value" is off, as in RViz; a frame that it
    does not list follows "All Enabled".

    Args:
        config: the display.
    """

    def __init__(self, config: DisplayConfig) -> None:
        self._config = config
        named = config.dynamic("Frames").keys() - {"All Enabled"}
        self._items = {frame: self._read(frame) for frame in named}
        self._named = frozenset(self._items)

    def item(self, frame: str) -> EntryItem:
        """Return the item of a frame."""
        item = self._items.get(frame)
        if item is None:
            item = self._items[frame] = self._read(frame)
        if frame not in self._named:
            item.assume(BOX, bool(self._config.get(ALL_ENABLED)))
        return item

    def is_on(self, frame: str) -> bool:
        """Return whether the box of a frame is ticked."""
        return bool(self.item(frame).get(BOX))

    def set(self, frame: str, path: str, value: object) -> Any:
        """Set a property of a frame, and return the value it has now."""
        return self.item(frame).set(path, value)

    def set_all(self, enabled: bool) -> None:
        """Tick or untick the frames that the document names."""
        for frame, item in self._items.items():
            if frame in self._named or item.is_given(BOX):
                item.set(BOX, enabled)

    def _read(self, frame: str) -> EntryItem:
        return EntryItem(self._config, ("Frames", frame), FRAME_PROPERTIES)


def frame_list(context: DisplayContext, entries: FrameEntries) -> EntryList:
    """Return all frames, in the order in which they became known."""
    return EntryList(
        "Frames",
        "frame",
        context.tree.frames,
        entries.item,
        entries.set,
        lambda frame: _facts(context, frame),
    )


def _facts(context: DisplayContext, frame: str) -> Mapping[str, str]:
    tree, fixed = context.tree, context.fixed_frame
    parent = tree.parent(frame)
    facts = {"Parent": parent or "none: it is a root"}
    if context.nodes.connected(frame):
        facts |= _pose("", tree.drawn(fixed, frame).matrix)
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

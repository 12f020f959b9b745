"""The selected items, one by one, with the facts about them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from sambot_viz.displays.picking.rays import Array, Indices
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.selected import Fact
from sambot_viz.frames import LookupRefused
from sambot_viz.frames.robot_frames import distance_between
from sambot_viz.panels.frames.frame_answer import shown_numbers
from sambot_viz.panels.selection.robot_facts import facts_of
from sambot_viz.session.clients.client_tools import ClientTools
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene


@dataclass(frozen=True, slots=True, eq=False)
class SelectedEntry:
    """One selected link, frame, point, marker or pose.

    Attributes:
        id: of its row.
        kind: of the item; the icon of its row.
        title: of its rows.
        name: by which distances call it.
        facts: the rows.
        position: of data in the fixed frame, (3,) [m]; None for a link or a frame.
    """

    id: str
    kind: str
    title: str
    name: str
    facts: Sequence[Fact]
    position: Array | None = None


class SelectedEntries:
    """Makes entries out of a selection.

    Args:
        tools: have the selection.
        scene: where it is drawn.
        robot: has the links.
    """

    def __init__(self, tools: ClientTools, scene: Scene, robot: RobotState) -> None:
        self._tools = tools
        self._scene = scene
        self._robot = robot

    @property
    def count(self) -> int:
        """How many items are selected; each point is one."""
        numbers = self._tools.selection.values()
        return sum(1 if one is None else len(one) for one in numbers)

    def first(self, most: int, frame: str) -> list[SelectedEntry]:
        """Return the first of the selected items.

        Args:
            most: number of items.
            frame: the frame in which poses of links and frames are shown.
        """
        found: list[SelectedEntry] = []
        for item, numbers in self._tools.selection.items():
            if len(found) < most:
                some = None if numbers is None else numbers[: most - len(found)]
                found.extend(self._of(item, some, frame))
        return found

    def _of(
        self, item: Selectable, numbers: Indices | None, frame: str
    ) -> Iterator[SelectedEntry]:
        head = f"selected/{item.kind}/{item.of}{item.name}"
        if not item.is_data:
            facts = facts_of(self._scene.context.tree, self._robot, item.name, frame)
            title = f"{item.kind.capitalize()} {item.name}"
            yield SelectedEntry(head, item.kind, title, item.name, facts)
            return
        data = self._tools.data_of(item)
        if data is None:
            return
        ends = ("",) if numbers is None else (f"/{n}" for n in numbers.tolist())
        for end, one in zip(ends, data.facts(numbers), strict=True):
            title = one.title
            yield SelectedEntry(
                head + end, item.kind, title, title, one.facts, one.position
            )

    # How far they are apart

    def length(self, first: SelectedEntry, second: SelectedEntry) -> str:
        """Return the distance of two entries [m] in a few digits."""
        if first is second:
            return "-"
        try:
            return f"{np.linalg.norm(self._offset(first, second)):.4g}"
        except LookupRefused:
            return "?"

    def apart(self, first: SelectedEntry, second: SelectedEntry) -> Iterator[Fact]:
        """Yield the distance of two entries, and from where to where that is."""
        try:
            offset = self._offset(first, second)
        except LookupRefused as refused:
            yield "Distance", refused.rviz_text
            return
        length = float(np.linalg.norm(offset))
        yield "Distance", f"{length:.6g} m, from {first.name} to {second.name}"
        axes = self._scene.context.fixed_frame
        if _are_frames(first, second):
            axes = first.name
        yield "Offset", f"{shown_numbers(offset)} m, along the axes of {axes}"

    def _offset(self, first: SelectedEntry, second: SelectedEntry) -> Sequence[float]:
        """Return the way from one to the other [m].

        It is along the axes of the first of two frames, else of the fixed frame.

        Raises:
            LookupRefused: a frame is not known, or not connected.
        """
        if _are_frames(first, second):
            tree = self._scene.context.tree
            return distance_between(tree, first.name, second.name).offset
        way: Array = self._position(second) - self._position(first)
        return way.tolist()

    def _position(self, one: SelectedEntry) -> Array:
        if one.position is not None:
            return one.position
        context = self._scene.context
        return context.tree.lookup(context.fixed_frame, one.name).translation


def _are_frames(first: SelectedEntry, second: SelectedEntry) -> bool:
    return first.position is None and second.position is None

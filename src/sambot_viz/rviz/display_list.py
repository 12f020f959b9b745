"""The displays of a config: a tree that is read, added to, and put in order."""

from __future__ import annotations

from dataclasses import dataclass

from sambot_viz.errors import UsageError
from sambot_viz.rviz.class_items import DisplayConfig, new_map
from sambot_viz.rviz.declarations import GROUP, kind_of, short_name, written_in_ros1
from sambot_viz.rviz.visualization_manager import VisualizationManager
from sambot_viz.rviz.yaml.yaml_nodes import Entry, List, Map, copied_map, items_of


@dataclass(frozen=True, slots=True)
class Removed:
    """A display that was taken out of the document.

    Attributes:
        display: with all its members.
        entry: its entry in the document.
        group: the group that it was in; None at the top.
        index: its place there, from 0.
    """

    display: DisplayConfig
    entry: Entry
    group: DisplayConfig | None
    index: int


class DisplayList(VisualizationManager):
    """The displays of a config."""

    def _load_displays(self) -> None:
        self._displays: list[DisplayConfig] = []
        self._read_displays(self._manager, None)

    def _read_displays(self, node: Map, group: DisplayConfig | None) -> None:
        members = group.members if group else self._displays
        listed = node.get("Displays")
        if isinstance(listed, List):
            for entry in listed.entries:
                if not isinstance(entry.value, Map):
                    what = "an item of 'Displays' is not a map with a class; it is kept"
                    self._findings.warn("config-value", entry.value, what)
        for _, found in items_of(listed):
            members.append(self._display(found, group))

    def _display(self, node: Map, group: DisplayConfig | None) -> DisplayConfig:
        kind = kind_of(node.text("Class") or "")
        declared = self._declarations.display(kind)
        display = DisplayConfig(node, declared, self._findings, group)
        if kind == GROUP:
            self._read_displays(node, display)
        return display

    @property
    def displays(self) -> tuple[DisplayConfig, ...]:
        """The displays at the top, in order; groups have their own."""
        return tuple(self._displays)

    def add_display(
        self,
        kind: str,
        name: str | None = None,
        *,
        group: DisplayConfig | None = None,
        after: DisplayConfig | None = None,
    ) -> DisplayConfig:
        """Add a display with RViz's defaults, switched on.

        Args:
            kind: ROS 2 class id; a file of ROS 1 gets ROS 1's name for it.
            name: its label; by default the class's short name.
            group: the group to put it in; by default the top level.
            after: the display to insert it after; by default the last one.

        Raises:
            UsageError: `group` is not a group, or `after` is not in it.
        """
        class_id = written_in_ros1(kind) if self.ros1 else kind
        label = short_name(kind) if name is None else name
        node = new_map(class_id, label, enabled=True)
        if kind == GROUP:
            # RViz writes no "Value" for groups.
            node.remove("Value")
        display = DisplayConfig(
            node, self._declarations.display(kind), self._findings, group
        )
        display.fill()
        self._insert(display, Entry(None, node), group, self._index(group, after))
        return display

    def duplicate(self, display: DisplayConfig) -> DisplayConfig:
        """Insert a copy of a display with its members after it, with the same name."""
        node = copied_map(display.node)
        group = display.parent
        copy = self._display(node, group)
        self._insert(copy, Entry(None, node), group, self._index(group, display))
        return copy

    def remove(self, display: DisplayConfig) -> Removed:
        """Take a display out; a group with all its members.

        Returns:
            What `put_back` takes.
        """
        group = display.parent
        members = self._members(group)
        index = members.index(display) if display in members else 0
        return Removed(display, self._take_out(display), group, index)

    def put_back(self, removed: Removed) -> None:
        """Put a removed display back into its place.

        Raises:
            UsageError: its group is no longer in this config.
        """
        group = removed.group
        if group is not None and not self.holds(group):
            raise UsageError(f"{group.label} is no longer in this config")
        removed.display.parent = group
        self._insert(removed.display, removed.entry, group, removed.index)

    def holds(self, display: DisplayConfig) -> bool:
        """Return whether a display is in this config."""
        if display not in self._members(display.parent):
            return False
        return display.parent is None or self.holds(display.parent)

    def move(
        self, display: DisplayConfig, index: int, group: DisplayConfig | None = None
    ) -> None:
        """Put a display elsewhere.

        Args:
            display: what to move.
            index: its place there, counted without itself, from 0.
            group: the group to put it in; None is the top.

        Raises:
            UsageError: a group cannot go into itself or one of its members.
        """
        above = group
        while above is not None:
            if above is display:
                raise UsageError("a group cannot be moved into itself")
            above = above.parent
        self._members(group)
        entry = self._take_out(display)
        display.parent = group
        self._insert(display, entry, group, index)

    def _members(self, group: DisplayConfig | None) -> list[DisplayConfig]:
        if group is not None and group.kind != GROUP:
            raise UsageError(f"{group.label} is not a group of displays")
        return group.members if group is not None else self._displays

    def _index(self, group: DisplayConfig | None, after: DisplayConfig | None) -> int:
        members = self._members(group)
        if after is None:
            return len(members)
        if after not in members:
            raise UsageError(f"{after.label} is not in that group")
        return members.index(after) + 1

    def _list(self, group: DisplayConfig | None) -> List:
        owner = self._attached_manager() if group is None else group.node
        return owner.made("Displays", List)

    def _insert(
        self,
        display: DisplayConfig,
        entry: Entry,
        group: DisplayConfig | None,
        index: int,
    ) -> None:
        members, entries = self._members(group), self._list(group).entries
        index = min(max(index, 0), len(members))
        if index < len(members):
            at = _position(entries, members[index])
        else:
            at = _position(entries, members[-1]) + 1 if members else len(entries)
        entries.insert(at, entry)
        members.insert(index, display)

    def _take_out(self, display: DisplayConfig) -> Entry:
        members = self._members(display.parent)
        if display not in members:
            raise UsageError(f"{display.label} is not in this config")
        entries = self._list(display.parent).entries
        members.remove(display)
        return entries.pop(_position(entries, display))


def _position(entries: list[Entry], display: DisplayConfig) -> int:
    return next(i for i, e in enumerate(entries) if e.value is display.node)

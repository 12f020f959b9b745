"""The .rviz document with meaning: displays, options, views, tools."""

from __future__ import annotations

import os

from sambot_viz.errors import Problem, UsageError
from sambot_viz.rviz.class_name import GROUP, is_ros1, kind_of, written_in_ros1
from sambot_viz.rviz.declarations import Declarations
from sambot_viz.rviz.default import DEFAULT_TEXT
from sambot_viz.rviz.document import Document
from sambot_viz.rviz.entries import DisplayConfig, ToolConfig, new_map
from sambot_viz.rviz.item import ConfigItem, Findings, items_of
from sambot_viz.rviz.nodes import Collection, Entry, List, Map, Plain, copied, plain
from sambot_viz.rviz.view_list import ViewList

_MANAGER = "Visualization Manager"


class RvizConfig(ViewList):
    """A config: typed values in front, the untouched document behind.

    What is not understood is kept and saved: unknown classes, keys, panels, window
    geometry, comments, the order of keys (spec/rviz-core.md §12, 17).
    """

    def __init__(self, document: Document, declarations: Declarations):
        """Read a document; use `load`, `parse` or `default`."""
        self._document = document
        self._declarations = declarations
        self._findings = Findings(document.file)
        manager = document.root.get(_MANAGER)
        self._manager = manager if isinstance(manager, Map) else Map()
        self.ros1 = any(is_ros1(name) for name in _class_ids(self._manager))
        _report_duplicates(document.root, self._findings)
        self.global_options = self._read_global_options()
        self._displays: list[DisplayConfig] = []
        self._read_displays(self._manager, None)
        self.tools = tuple(
            ToolConfig(
                node,
                declarations.tools.get(kind_of(node.text("Class") or "")),
                self._findings,
            )
            for _, node in items_of(self._manager.get("Tools"))
        )
        super().__init__(self._manager, self._in_manager, self._findings, declarations)

    @classmethod
    def load(
        cls, path: str | os.PathLike[str], declarations: Declarations
    ) -> RvizConfig:
        """Read a file.

        Raises:
            ConfigError: the file cannot be read, or is no .rviz document at all.
        """
        return cls(Document.load(path), declarations)

    @classmethod
    def parse(
        cls, text: str, declarations: Declarations, *, file: str | None = None
    ) -> RvizConfig:
        """Read a text.

        Args:
            text: the content of an .rviz file.
            declarations: the classes that are known.
            file: the name for messages.

        Raises:
            ConfigError: the text is no .rviz document at all.
        """
        return cls(Document(text, file), declarations)

    @classmethod
    def default(cls, declarations: Declarations) -> RvizConfig:
        """The config RViz starts with: one Grid, an Orbit view."""
        return cls.parse(DEFAULT_TEXT, declarations)

    def _read_global_options(self) -> ConfigItem:
        found = self._manager.get("Global Options")
        declared = self._declarations.global_options
        if isinstance(found, Map):
            return GlobalOptions(found, declared, self._findings, ros1=self.ros1)
        return GlobalOptions(
            Map(),
            declared,
            self._findings,
            ros1=self.ros1,
            attach=lambda node: self._in_manager().put("Global Options", node),
        )

    def _in_manager(self) -> Map:
        """The manager's map, put into the document if it is missing."""
        root = self._document.root
        if root.get(_MANAGER) is not self._manager:
            root.put(_MANAGER, self._manager)
        return self._manager

    def _read_displays(self, node: Map, group: DisplayConfig | None) -> None:
        members = group.members if group else self._displays
        listed = node.get("Displays")
        if isinstance(listed, List):
            for entry in listed.entries:
                if not isinstance(entry.value, Map):
                    what = "an item of 'Displays' is no map with a class; it is kept"
                    self._findings.add("config-value", entry.value, what)
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

    @property
    def file(self) -> str | None:
        """The path it was read from or last saved to."""
        return self._document.file

    @property
    def panels(self) -> Plain:
        """RViz's panels as text; kept, never used."""
        return plain(self._document.root.get("Panels"))

    @property
    def raw(self) -> Plain:
        """The whole document as text: dicts, lists, str, None."""
        return plain(self._document.root)

    @property
    def problems(self) -> tuple[Problem, ...]:
        """What was doubtful in the file: warnings with their lines."""
        return (*self._document.problems, *self._findings.problems)

    @property
    def modified(self) -> bool:
        """Whether a save would change the file."""
        return self._document.modified

    def to_yaml(self) -> str:
        """The text that a save writes; the file's own one where nothing changed."""
        return self._document.to_yaml()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the file, whole or not at all.

        Raises:
            ConfigError: it cannot be written; an old file is untouched.
        """
        self._document.save(path)

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
            name: its label; the class's short name when not given.
            group: the group to put it in; the top when not given.
            after: the display behind which it goes; the end when not given.

        Raises:
            UsageError: `group` is none, or `after` is not in it.
        """
        class_id = written_in_ros1(kind) if self.ros1 else kind
        label = kind.rpartition("/")[2] if name is None else name
        node = new_map(class_id, label, enabled=True)
        if kind == GROUP:
            # RViz writes no "Value" for groups (spec/rviz-core.md §1.6).
            node.remove("Value")
        display = DisplayConfig(
            node, self._declarations.display(kind), self._findings, group
        )
        display.fill()
        self._insert(display, Entry(None, node), group, self._index(group, after))
        return display

    def duplicate(self, display: DisplayConfig) -> DisplayConfig:
        """Copy a display with all it holds, right behind it, under the same name."""
        node = copied(display.node)
        if not isinstance(node, Map):
            raise AssertionError("a display is a map")
        group = display.parent
        copy = self._display(node, group)
        self._insert(copy, Entry(None, node), group, self._index(group, display))
        return copy

    def remove(self, display: DisplayConfig) -> None:
        """Take a display out; a group with all its members."""
        self._take_out(display)

    def move(
        self,
        display: DisplayConfig,
        index: int,
        group: DisplayConfig | None = None,
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
            raise UsageError(f"{group.label} is no group of displays")
        return group.members if group is not None else self._displays

    def _index(self, group: DisplayConfig | None, after: DisplayConfig | None) -> int:
        members = self._members(group)
        if after is None:
            return len(members)
        if after not in members:
            raise UsageError(f"{after.label} is not in that group")
        return members.index(after) + 1

    def _list(self, group: DisplayConfig | None) -> List:
        owner = self._in_manager() if group is None else group.node
        found = owner.get("Displays")
        if isinstance(found, List):
            return found
        made = List()
        owner.put("Displays", made)
        return made

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


class GlobalOptions(ConfigItem):
    """Fixed Frame, Background Color, Frame Rate."""

    @property
    def label(self) -> str:
        """What it is called in messages."""
        return "Global Options"


def _position(entries: list[Entry], display: DisplayConfig) -> int:
    return next(i for i, e in enumerate(entries) if e.value is display.node)


def _class_ids(manager: Map) -> list[str]:
    """The classes of displays, tools and the view, as far as they stand at the top."""
    listed = [*items_of(manager.get("Displays")), *items_of(manager.get("Tools"))]
    return [node.text("Class") or "" for _, node in listed]


def _report_duplicates(node: Collection, findings: Findings) -> None:
    seen: set[str] = set()
    for entry in node.entries:
        if entry.key is not None and entry.key in seen:
            findings.add(
                "config-duplicate-key",
                entry.value,
                f"'{entry.key}' stands twice in one map; the later one holds",
                "remove the earlier one",
            )
        seen.add(entry.key or "")
        if isinstance(entry.value, Collection):
            _report_duplicates(entry.value, findings)

"""What users change in the document: properties, displays, their order.

Every method is recorded: a browser can undo what it has changed (see `undo`).
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from typing import Any

from sambot_viz.displays.display import Display
from sambot_viz.displays.entries import EntryList
from sambot_viz.errors import UsageError
from sambot_viz.rviz import DisplayConfig
from sambot_viz.rviz.class_name import short_name
from sambot_viz.rviz.display_list import Removed
from sambot_viz.rviz.undo_log import Restore
from sambot_viz.session.document.drawn_scene import walk
from sambot_viz.session.document.shown_document import ShownDocument
from sambot_viz.session.limits import MOST_DISPLAYS, require_room

_COUNTED = re.compile(r"^(.*) \(\d+\)$", re.DOTALL)
"""A name that ends with a number, as copies have it."""


class DisplayEdits(ShownDocument):
    """Base of `Session`: the edits of Global Options and of displays."""

    def display_of(self, config: DisplayConfig) -> Display | None:
        """What draws a display of the document; None for an unsupported one."""
        found = (d for d in self.displays if d.config is config)
        return next(found, None)

    # Values

    def set_global(self, name: str, value: Any) -> None:
        """Set one of the Global Options.

        Raises:
            UsageError: an unknown option, or a value that it cannot have.
        """
        label = f"Global Options: {name}"
        with self.history.setting(label, self._apply_options, merge=("option", name)):
            self._apply_options(lambda: self.config.global_options.set(name, value))

    def _apply_options(self, action: Callable[[], object]) -> None:
        context = self.context
        before = (context.fixed_frame, context.background)
        with self.change(self.signals.config):
            action()
            self.drawn.take_options()
            self._period_changed()
            if context.fixed_frame != before[0]:
                self._frames_changed()
            elif context.background != before[1]:
                self._redraw()

    def set_property(self, display: Display, path: str, value: Any) -> None:
        """Set one property of a display and draw what changes.

        Raises:
            UsageError: the value cannot be meant, or the display refuses it.
        """
        config = display.config
        with self.change(self.signals.status):
            robot_display = display.robot_display
            refusal = robot_display and robot_display.refusal(path, value)
            if refusal is None:
                with self._setting(config, path, path):
                    config.set(path, value)
                    display.property_changed(path)
        # Raised after the listeners were notified: the panel shows the old value again.
        if refusal is not None:
            raise UsageError(refusal)

    def set_entry(
        self, display: Display, title: str, name: str, path: str, value: Any
    ) -> None:
        """Set one property of a link, a joint or a frame of a display.

        Args:
            display: whose it is.
            title: "Links", "Joints" or "Frames".
            name: of the link, joint or frame.
            path: the property, such as "Alpha"; "Value" is the box.
            value: what it is to be; others may follow.

        Raises:
            UsageError: there is no such property, or the value cannot be meant.
        """
        entries = _entries_of(display, title)
        if name not in entries.names:
            raise UsageError(
                f"'{display.config.name}' has no {entries.singular} '{name}'"
            )
        with self.change(self.signals.status):
            with self._setting(display.config, f"{name}/{path}", (title, name, path)):
                entries.set(name, path, value)
                display.property_changed(f"{title}/{path}")

    def _setting(
        self, config: DisplayConfig, what: str, merge: object
    ) -> AbstractContextManager[None]:
        """Record the properties of a display that are set inside."""
        self._require(config)

        def apply(put_back: Restore) -> None:
            self._require(config)
            with self.change(self.signals.config, self.signals.status):
                put_back()
                display = self.display_of(config)
                if display is not None:
                    display.values_put_back()

        return self.history.setting(
            f"{config.name}: {what}", apply, merge=(id(config), merge)
        )

    def set_enabled(self, display: Display | DisplayConfig, enabled: bool) -> None:
        """Enable or disable a display; an unsupported one has a box too."""
        config = display.config if isinstance(display, Display) else display
        before = config.enabled

        def apply(on: bool) -> None:
            self._require(config)
            with self.change(self.signals.status):
                config.set_enabled(on)
                self.drawn.apply_enabled()

        apply(enabled)
        if enabled != before:
            self.history.record(
                f"{config.name}: {'on' if enabled else 'off'}",
                lambda: apply(before),
                lambda: apply(enabled),
                merge=(id(config), "enabled"),
            )

    def set_tool_property(self, kind: str, path: str, value: Any) -> None:
        """Set a property of a tool that the document lists, for all browsers.

        Raises:
            UsageError: the document does not list the tool, or the value cannot be
                meant.
        """
        config = next((tool for tool in self.config.tools if tool.kind == kind), None)
        if config is None:
            raise UsageError(f"the config has no tool '{kind}'")
        label = f"{short_name(kind)}: {path}"
        with self.history.setting(label, self._apply, merge=("tool", kind, path)):
            self._apply(lambda: config.set(path, value))

    # The tree of displays

    def add_display(
        self, kind: str, after: DisplayConfig | None = None, name: str | None = None
    ) -> DisplayConfig:
        """Add a display with RViz's defaults, switched on.

        Args:
            kind: ROS 2 class id.
            after: the display behind which it goes; the end of all when not given.
            name: its label; by default one after its class that no other display has.

        Raises:
            UsageError: `after` is not in the document, or there are too many.
        """
        self._require_room([])
        if after is not None:
            self._require(after)
        group = after.parent if after is not None else None
        label = self._free_name(short_name(kind)) if name is None else name
        with self.change():
            config = self.config.add_display(kind, label, group=group, after=after)
            self._added(f"Add {label}", config)
        return config

    def duplicate_display(self, config: DisplayConfig) -> DisplayConfig:
        """Add a copy of a display behind it, under a name that no other display has.

        Raises:
            UsageError: it is not in the document, or there are too many.
        """
        self._require(config)
        self._require_room(config.displays)
        with self.change():
            copy = self.config.duplicate(config)
            copy.rename(self._free_name(config.name))
            self._added(f"Duplicate {config.name}", copy)
        return copy

    def _require_room(self, members: Sequence[DisplayConfig]) -> None:
        """Refuse one more display, with its members, when there are too many."""
        count = 1 + sum(1 for one in (self.config.displays, members) for _ in walk(one))
        require_room(count, MOST_DISPLAYS, "displays")

    def _added(self, label: str, config: DisplayConfig) -> None:
        self.show_config()
        undo, redo = self._removal(config)
        self.history.record(label, undo, redo, touched=config)

    def remove_display(self, config: DisplayConfig) -> None:
        """Take a display out of the document; a group with all its members."""
        remove, put_back = self._removal(config)
        remove()
        self.history.record(f"Remove {config.name}", put_back, remove, touched=config)

    def _removal(self, config: DisplayConfig) -> tuple[Restore, Restore]:
        """Functions that take a display out, and put the same one back."""
        document = self.config
        places: list[Removed] = []

        def remove() -> None:
            self._require(config)
            with self.change():
                places[:] = [document.remove(config)]
                self.show_config()

        def put_back() -> None:
            with self.change():
                document.put_back(places[0])
                self.show_config()

        return remove, put_back

    def move_display(
        self, config: DisplayConfig, index: int, group: DisplayConfig | None
    ) -> None:
        """Put a display elsewhere.

        Args:
            config: the display.
            index: its place there, counted without itself, from 0.
            group: the group to put it in; None is the top.

        Raises:
            UsageError: a group cannot go into itself or one of its members.
        """
        self._require(config)
        before = (self._index_of(config), config.parent)

        def move(index: int, group: DisplayConfig | None) -> None:
            for item in (config, group):
                if item is not None:
                    self._require(item)
            with self.change():
                self.config.move(config, index, group)
                self.show_config()

        move(index, group)
        after = (self._index_of(config), config.parent)
        if after != before:
            self.history.record(
                f"Move {config.name}",
                lambda: move(*before),
                lambda: move(*after),
                touched=config,
            )

    def rename_display(self, config: DisplayConfig, name: str) -> None:
        """Give a display another name; an empty one changes nothing."""
        name, before = name.strip(), config.name

        def rename(name: str) -> None:
            self._require(config)
            with self.change():
                config.rename(name)
                self.show_config()

        if name and name != before:
            rename(name)
            self.history.record(
                f"Rename {before} to {name}",
                lambda: rename(before),
                lambda: rename(name),
                touched=config,
            )

    def _require(self, config: DisplayConfig) -> None:
        """Raise UsageError for a display that is not in the document any more."""
        if not self.config.holds(config):
            raise UsageError(f"the display '{config.name}' was removed")

    def _index_of(self, config: DisplayConfig) -> int:
        group = config.parent
        return list(group.displays if group else self.config.displays).index(config)

    def _free_name(self, name: str) -> str:
        """The name, or "name (2)" and so on when other displays have it."""
        taken = {item.name for item in walk(self.config.displays)}
        counted = _COUNTED.match(name)
        plain = counted.group(1) if counted and name in taken else name
        numbered = (f"{plain} ({n})" for n in itertools.count(2))
        return next(n for n in itertools.chain([name], numbered) if n not in taken)


def _entries_of(display: Display, title: str) -> EntryList:
    lists = {found.title: found for found in display.entries()}
    if title not in lists:
        raise UsageError(f"'{display.config.name}' has no {title}")
    return lists[title]

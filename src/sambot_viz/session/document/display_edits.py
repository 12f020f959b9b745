"""Edits of displays: properties, names, order, adding and removing.

Every method is recorded: a client can undo what it has changed (see `undo`).
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from typing import Any

from sambot_viz import limits
from sambot_viz.displays.display import Display, EntryList
from sambot_viz.errors import UsageError
from sambot_viz.rviz import (
    ColorProperty,
    Declared,
    DisplayConfig,
    FloatProperty,
    IntProperty,
    TopicProperty,
    VectorProperty,
)
from sambot_viz.rviz.declarations import short_name
from sambot_viz.rviz.display_list import Removed
from sambot_viz.rviz.undo_log import Restore
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.room import require_room
from sambot_viz.session.scene.scene import Scene, walk
from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.undo import History

_NUMBERS = (IntProperty, FloatProperty, VectorProperty, ColorProperty)
_COUNTED = re.compile(r"^(.*) \(\d+\)$", re.DOTALL)
"""A name that ends with a number, as copies have it."""


class DisplayEdits:
    """Changes displays as users do.

    Attributes:
        sizes_of: says which sizes a display of a type gets that is added, by path.
    """

    def __init__(
        self,
        document: ShownDocument,
        scene: Scene,
        history: History,
        change: Change,
    ) -> None:
        self._document = document
        self._scene = scene
        self._history = history
        self._change = change
        self.sizes_of: Callable[[str], Mapping[str, float]] = lambda _: {}

    # Values

    def set_property(self, display: Display, path: str, value: Any) -> None:
        """Set one property of a display and draw what changes.

        Raises:
            UsageError: the value cannot be meant, or the display refuses it.
        """
        config = display.config
        declared = config.declared.get(path)
        with self._change(*self._told(display, declared)):
            robot_display = display.robot_display
            refusal = robot_display and robot_display.refusal(path, value)
            if refusal is None:
                with self._setting(config, declared, path, path):
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
            display: the display.
            title: "Links", "Joints" or "Frames".
            name: the name of the link, joint or frame.
            path: the property, such as "Alpha"; "Value" is the box.
            value: the new value; others may follow.

        Raises:
            UsageError: there is no such property, or the value cannot be meant.
        """
        entries = _entries_of(display, title)
        if name not in entries.names:
            raise UsageError(
                f"'{display.config.name}' has no {entries.singular} '{name}'"
            )
        declared = entries.item(name).declared.get(path)
        with self._change(*self._told(display, declared)):
            label, merge = f"{name}/{path}", (title, name, path)
            with self._setting(display.config, declared, label, merge):
                entries.set(name, path, value)
                display.property_changed(f"{title}/{path}")

    def _told(
        self, display: Display | None, declared: Declared | None
    ) -> tuple[Signal[Any], ...]:
        """Return the facts that change with a value of a display.

        A number or a colour changes the picture and the status of its display; a frame,
        a file, a box or a setting of a topic may change the state of others.
        """
        if display is not None:
            display.revision += 1
        if declared is not None and isinstance(declared.property, _NUMBERS):
            above = declared.above
            if above is None or not isinstance(above.property, TopicProperty):
                return (self._document.values,)
        return (self._document.displays, self._scene.statuses)

    def _setting(
        self,
        config: DisplayConfig,
        declared: Declared | None,
        what: str,
        merge: object,
    ) -> AbstractContextManager[None]:
        """Record the properties of a display that are set inside."""
        self._require(config)

        def apply(put_back: Restore) -> None:
            self._require(config)
            display = self._scene.display_of(config)
            with self._change(*self._told(display, declared)):
                put_back()
                if display is not None:
                    display.values_put_back()

        return self._history.setting(
            f"{config.name}: {what}", apply, merge=(id(config), merge)
        )

    def set_enabled(self, display: Display | DisplayConfig, enabled: bool) -> None:
        """Enable or disable a display; an unsupported one has a box too."""
        config = display.config if isinstance(display, Display) else display
        before = config.enabled

        def apply(on: bool) -> None:
            self._require(config)
            with self._change(self._document.displays, self._scene.statuses):
                config.set_enabled(on)
                self._scene.apply_enabled()

        apply(enabled)
        if enabled != before:
            self._history.record(
                f"{config.name}: {'on' if enabled else 'off'}",
                lambda: apply(before),
                lambda: apply(enabled),
                merge=(id(config), "enabled"),
            )

    # The tree of displays

    def add_display(
        self,
        kind: str,
        after: DisplayConfig | None = None,
        name: str | None = None,
        values: Mapping[str, object] | None = None,
        place: tuple[int, DisplayConfig | None] | None = None,
    ) -> DisplayConfig:
        """Add a display with RViz's defaults, or the robot's size, switched on.

        Args:
            kind: ROS 2 class id.
            after: the display to insert it after; by default the last one.
            name: its label; by default one after its class that no other display has.
            values: values other than the defaults, by the paths of their properties.
            place: the index from 0, and the group or None for the top level.

        Raises:
            UsageError: `after` or the group is not in the document, or there are too
                many.
        """
        self._require_room([])
        group = None
        if after is not None:
            self._require(after)
            group = after.parent
        if place is not None and place[1] is not None:
            self._require(place[1])
        label = self._free_name(short_name(kind)) if name is None else name
        with self._change():
            config = self._document.config.add_display(
                kind, label, group=group, after=after
            )
            for path, value in {**self.sizes_of(kind), **(values or {})}.items():
                config.set(path, value)
            if place is not None:
                # A document adds new displays at the end.
                self._document.config.move(config, *place)
            self._added(f"Add {label}", config)
        return config

    def duplicate_display(self, config: DisplayConfig) -> DisplayConfig:
        """Add a copy of a display after it, under a name that no other display has.

        Raises:
            UsageError: it is not in the document, or there are too many.
        """
        self._require(config)
        self._require_room(config.displays)
        with self._change():
            copy = self._document.config.duplicate(config)
            copy.rename(self._free_name(config.name))
            self._added(f"Duplicate {config.name}", copy)
        return copy

    def _require_room(self, members: Sequence[DisplayConfig]) -> None:
        """Refuse one more display, with its members, when there are too many."""
        count = 1 + sum(
            1 for one in (self._document.config.displays, members) for _ in walk(one)
        )
        require_room(count, limits.SESSION_DISPLAYS.value, "displays")

    def _added(self, label: str, config: DisplayConfig) -> None:
        self._document.show()
        undo, redo = self._removal(config)
        self._history.record(label, undo, redo, touched=config)

    def remove_display(self, config: DisplayConfig) -> None:
        """Take a display out of the document; a group with all its members."""
        remove, put_back = self._removal(config)
        remove()
        self._history.record(f"Remove {config.name}", put_back, remove, touched=config)

    def remove_unasked(self) -> None:
        """Take out the displays of data that no config names: RViz shows none."""
        document = self._document.config
        there = [one for one in document.unasked if document.holds(one)]
        removals = [self._removal(one) for one in there]

        def remove() -> None:
            with self._change():
                for take_out, _ in removals:
                    take_out()

        def put_back() -> None:
            with self._change():
                for _, put in reversed(removals):
                    put()

        if removals:
            remove()
            self._history.record("Show only what the config says", put_back, remove)

    @property
    def has_unasked(self) -> bool:
        """Whether there are displays of data that no config names."""
        document = self._document.config
        return any(document.holds(one) for one in document.unasked)

    def _removal(self, config: DisplayConfig) -> tuple[Restore, Restore]:
        """Functions that take a display out, and put the same one back."""
        document = self._document.config
        places: list[Removed] = []

        def remove() -> None:
            self._require(config)
            with self._change():
                places[:] = [document.remove(config)]
                self._document.show()

        def put_back() -> None:
            with self._change():
                document.put_back(places[0])
                self._document.show()

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
            with self._change():
                self._document.config.move(config, index, group)
                self._document.show()

        move(index, group)
        after = (self._index_of(config), config.parent)
        if after != before:
            self._history.record(
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
            with self._change():
                config.rename(name)
                self._document.show()

        if name and name != before:
            rename(name)
            self._history.record(
                f"Rename {before} to {name}",
                lambda: rename(before),
                lambda: rename(name),
                touched=config,
            )

    def _require(self, config: DisplayConfig) -> None:
        """Raise UsageError for a display that is no longer in the document."""
        if not self._document.config.holds(config):
            raise UsageError(f"the display '{config.name}' was removed")

    def _index_of(self, config: DisplayConfig) -> int:
        group = config.parent
        return list(group.displays if group else self._document.config.displays).index(
            config
        )

    def _free_name(self, name: str) -> str:
        """The name, or "name (2)" and so on when other displays have it."""
        taken = {item.name for item in walk(self._document.config.displays)}
        counted = _COUNTED.match(name)
        plain = counted.group(1) if counted and name in taken else name
        numbered = (f"{plain} ({n})" for n in itertools.count(2))
        return next(n for n in itertools.chain([name], numbered) if n not in taken)


def _entries_of(display: Display, title: str) -> EntryList:
    lists = {found.title: found for found in display.entries()}
    if title not in lists:
        raise UsageError(f"'{display.config.name}' has no {title}")
    return lists[title]

"""A map of the document, or an entry below one, seen through declared properties."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import Any

from sambot_viz.rviz.declarations import Declared, UnknownPropertyError
from sambot_viz.rviz.item_map import ItemMap
from sambot_viz.rviz.properties.property import KeptProperty, Property
from sambot_viz.rviz.undo_log import DocumentPlace, FinishChange, Leaves, Restore, note
from sambot_viz.rviz.yaml.yaml_document import ConfigFindings
from sambot_viz.rviz.yaml.yaml_nodes import Map, Node, Scalar


class ConfigItem(ItemMap):
    """Typed values of one map: Global Options, a display, a view, a tool.

    Values are read once, kept typed, and written into the document when they are set.
    Keys that are not declared stay untouched; `raw` and `dynamic` give them as text.
    """

    def __init__(
        self,
        node: Map,
        declared: Sequence[Property],
        findings: ConfigFindings,
        *,
        ros1: bool = False,
        attach: Callable[[Map], None] | None = None,
    ):
        """Read the properties of a map.

        Args:
            node: the map; one that is not in the document is attached when needed.
            declared: the properties.
            findings: collects warnings.
            ros1: whether the map uses ROS 1's names, whose defaults differ.
            attach: puts the map into the document.
        """
        super().__init__(node, attach)
        self._ros1 = ros1
        self._findings = findings
        self._given: set[str] = set()
        self._unreadable: set[str] = set()
        for prop in declared:
            prop = prop if ros1 or not prop.ros1_only else _kept(prop)
            above, start = self._place(prop)
            self._read(prop, above, start, None)

    def _place(self, prop: Property) -> tuple[tuple[str, ...], Node | None]:
        """Return the keys and the node that a property of the first level is below."""
        del prop
        return (), self._node

    def _read(
        self,
        prop: Property,
        above: tuple[str, ...],
        node: Node | None,
        parent: Declared | None,
    ) -> None:
        key = prop.name
        found = node.get(key) if isinstance(node, Map) else None
        for alias in prop.aliases:
            if found is None and isinstance(node, Map):
                key, found = alias, node.get(alias)
        if found is None:
            key = prop.name
        path = prop.name if parent is None else f"{parent.path}/{prop.name}"
        declared = Declared(path, (*above, key), prop, parent)
        self._declared[path] = declared
        if prop.has_value:
            found_here = None if prop.read_only else found
            value = prop.read(found_here, self._report)
            self._note(path, prop, found_here, value)
        for child in prop.children:
            self._read(child, declared.keys, found, declared)

    def _note(self, path: str, prop: Property, found: Node | None, value: Any) -> None:
        """Keep a value that was read, or the default where there was none."""
        if value is not None:
            self._given.add(path)
        elif found is not None and not (
            isinstance(found, Map) and prop.components(prop.default) is None
        ):
            self._unreadable.add(path)
        self._values[path] = prop.default_in(self._ros1) if value is None else value

    def _report(self, node: Node, message: str, hint: str, right: str = "") -> None:
        self._findings.warn("config-value", node, message, hint, right)

    @property
    def findings(self) -> ConfigFindings:
        """Collects the warnings about the file."""
        return self._findings

    @property
    def label(self) -> str:
        """The label used in messages."""
        return "this item"

    @property
    def properties(self) -> Mapping[str, Any]:
        """Every value, by its path, such as "Line Style/Line Width"."""
        return MappingProxyType(self._values)

    @property
    def declared(self) -> Mapping[str, Declared]:
        """Every declared property, containers too, by its path."""
        return MappingProxyType(self._declared)

    def is_given(self, path: str) -> bool:
        """Return whether the value is in the file or was set: it is not a default."""
        return path in self._given

    def get(self, path: str) -> Any:
        """Return the value of a property: bool, int, float, str, or a tuple of numbers.

        Raises:
            UnknownPropertyError: no such property with a value is declared.
        """
        try:
            return self._values[path]
        except KeyError:
            raise self._unknown(path) from None

    def acting(self, path: str) -> Any:
        """Return the value of a property as it acts, within what can be drawn."""
        value = self.get(path)
        return self._declared[path].property.acting(value)

    def set(self, path: str, value: object) -> Any:
        """Change a property here and in the document.

        Args:
            path: keys from this item on, joined by "/".
            value: the value from a program or a browser.

        Returns:
            The value it has now: clamped, and of the property's type.

        Raises:
            UnknownPropertyError: no such property is declared.
            PropertyError: the value is of another type, or not one of the options.
        """
        if path not in self._values or self._declared[path].property.read_only:
            raise self._unknown(path)
        declared = self._declared[path]
        prop, new = declared.property, declared.property.coerce(value)
        if prop.agrees(new, self._values[path]) and path not in self._unreadable:
            self._values[path] = new
            return new
        note(self, path)
        self._write(declared, new)
        self._values[path] = new
        self._given.add(path)
        self._unreadable.discard(path)
        return new

    def begin_change(self, path: str) -> FinishChange:
        """Keep a property as it is now, here and in the document.

        Args:
            path: the property; it has a value.
        """
        declared = self._declared[path]
        children = {child.name for child in declared.property.children}
        place = DocumentPlace(*self.rooted(declared.keys), children)

        def state() -> tuple[Any, bool, bool, Leaves]:
            given, unreadable = path in self._given, path in self._unreadable
            return self._values[path], given, unreadable, place.leaves()

        def restore(wanted: tuple[Any, bool, bool, Leaves], written: Leaves) -> None:
            self._values[path], given, unreadable, leaves = wanted
            place.restore(leaves, written)
            for marks, holds in (self._given, given), (self._unreadable, unreadable):
                (marks.add if holds else marks.discard)(path)

        def finish() -> tuple[Restore, Restore]:
            after = state()
            return partial(restore, before, after[-1]), partial(
                restore, after, before[-1]
            )

        before = state()
        return finish

    def assume(self, path: str, value: Any) -> None:
        """Use another default for a property that is not given, or given as empty.

        Args:
            path: the property.
            value: of the property's own type.
        """
        if path not in self._given or self._values[path] == "":
            self._values[path] = value

    def is_shown(self, path: str) -> bool:
        """Return whether a property has a row now.

        It may depend on another one, and has none where that one has none.
        """
        declared: Declared | None = self._declared.get(path)
        if declared is None:
            raise self._unknown(path)
        while declared is not None:
            condition = declared.property.hidden_unless
            if condition is not None and not (
                self._holds(*condition) and self.is_shown(condition[0])
            ):
                return False
            declared = declared.above
        return True

    def _holds(self, path: str, wanted: object) -> bool:
        value = self.acting(path)
        return value in wanted if isinstance(wanted, tuple) else value == wanted

    def _unknown(self, path: str) -> UnknownPropertyError:
        declared = self._declared
        known = [one for one in self._values if not declared[one].property.read_only]
        return UnknownPropertyError(self.label, path, known)


def _kept(prop: Property) -> KeptProperty:
    """Return a property of ROS 1's RViz in a file of ROS 2."""
    return KeptProperty(prop.name, note="RViz for ROS 2 ignores it")


DETAILS = "Details"
"""In RViz's trees of links, all properties of an entry but "Value" are below this."""


class EntryItem(ConfigItem):
    """Typed values of one entry of another item, such as a link of a RobotModel.

    Reading writes nothing. The first value that is set adds the entry, and missing maps
    above it, to the document. An entry that is only a text ("base_link: false") is its
    "Value".
    """

    def __init__(
        self,
        owner: ConfigItem,
        keys: Sequence[str],
        declared: Sequence[Property],
        *,
        nested: bool = False,
        ros1: bool = False,
    ) -> None:
        """Read one entry.

        Args:
            owner: the item it is below.
            keys: its place there, such as ("Links", "base_link").
            declared: its properties.
            nested: further entries are below it, so its own properties belong below
                "Details".
            ros1: the entry is written in ROS 1's names.
        """
        self._owner = owner
        self._keys = tuple(keys)
        self._nested = nested
        found = owner.node_at(self._keys)
        node = found if isinstance(found, Map) else Map()
        if isinstance(found, Scalar):
            node.put("Value", found)
        super().__init__(node, declared, owner.findings, ros1=ros1)

    @property
    def label(self) -> str:
        """The label used in messages."""
        return f"'{self._keys[-1]}'"

    def _place(self, prop: Property) -> tuple[tuple[str, ...], Node | None]:
        if prop.name == "Value":
            return (), self._node
        details = self._node.get(DETAILS)
        inside = isinstance(details, Map) and details.get(prop.name) is not None
        if inside or (self._nested and self._node.get(prop.name) is None):
            return (DETAILS,), details
        return (), self._node

    def map_at(self, keys: Sequence[str]) -> Map:
        """Return the map at some keys of the entry, made in the document if missing."""
        # The owner finds the place again: another entry may have made it meanwhile.
        return self._owner.map_at((*self._keys, *keys))

    def rooted(self, keys: Sequence[str]) -> tuple[Map, Sequence[str]]:
        """Return the owner's map that is in the document, and a place below it."""
        return self._owner.rooted((*self._keys, *keys))

"""The map of an item in the document: read as text, written as RViz writes it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from sambot_viz.rviz.declarations import Declared, unknown_keys
from sambot_viz.rviz.properties.numbers import VectorProperty
from sambot_viz.rviz.properties.property import Property
from sambot_viz.rviz.yaml.yaml_nodes import (
    Entry,
    Map,
    Node,
    Plain,
    Scalar,
    copied,
    plain,
)

Path = str | Sequence[str]


class ItemMap:
    """One map of the document, with the properties that are declared for it.

    Args:
        node: the map; one that is not in the document is attached when needed.
        attach: puts the map into the document.
    """

    _own_keys: frozenset[str] = frozenset()
    """Keys with a meaning, which are not properties."""

    def __init__(self, node: Map, attach: Callable[[Map], None] | None = None) -> None:
        self._node = node
        self._attach = attach
        self._values: dict[str, Any] = {}
        self._declared: dict[str, Declared] = {}

    @property
    def node(self) -> Map:
        """Its map in the document."""
        return self._node

    @property
    def raw(self) -> dict[str, Plain]:
        """All of the map as text: dicts, lists, str, None."""
        found = plain(self._node)
        return found if isinstance(found, dict) else {}

    def dynamic(self, path: Path) -> dict[str, Plain]:
        """Return everything below a key, declared or not, such as "Links".

        Args:
            path: one key, or a sequence of keys (which may contain slashes).

        Returns:
            Nested dicts of text; empty when nothing is there.
        """
        found = plain(self.node_at(_keys(path)))
        return found if isinstance(found, dict) else {}

    def node_at(self, keys: Sequence[str]) -> Node | None:
        """Return the node below some keys, declared or not; None when there is none."""
        node: Node | None = self._node
        for key in keys:
            node = node.get(key) if isinstance(node, Map) else None
        return node

    @property
    def unknown_keys(self) -> tuple[str, ...]:
        """Paths in the file that nothing declares, in the order of the file."""
        known = {declared.keys: declared for declared in self._declared.values()}
        return tuple(unknown_keys(self._node, known, self._own_keys))

    def rooted(self, keys: Sequence[str]) -> tuple[Map, Sequence[str]]:
        """Return a map that is in the document, and a place of this item below it."""
        return self._node, keys

    def map_at(self, keys: Sequence[str]) -> Map:
        """Return the map at some keys, made in the document where it is missing.

        A text in its place becomes its "Value".
        """
        if self._attach is not None:
            self._attach(self._node)
            self._attach = None
        node = self._node
        for depth, key in enumerate(keys, 1):
            found = node.get(key)
            if not isinstance(found, Map):
                found = self._instead(tuple(keys[:depth]), found)
                node.put(key, found)
            node = found
        return node

    def fill(self) -> None:
        """Write every property into the map, as RViz saves a new item."""
        for declared in self._declared.values():
            prop = declared.property
            if declared.above is not None:
                continue
            if not prop.read_only and self._node.get(prop.name) is None:
                self._node.put(prop.name, self._new_node(prop.name))

    def _write(self, declared: Declared, value: Any) -> None:
        above, key = self.map_at(declared.keys[:-1]), declared.keys[-1]
        prop, old = declared.property, above.get(key)
        parts = prop.components(value)
        if parts is not None:
            self._write_parts(above, key, parts, prop)
        elif isinstance(old, Map):
            old.put_text("Value", prop.write(value))
        elif old is None and prop.children:
            self._values[declared.path] = value
            above.put(key, self._new_map(declared.path))
        else:
            above.put_text(key, prop.write(value))

    def _write_parts(
        self, above: Map, key: str, parts: dict[str, str], prop: Property
    ) -> None:
        old = above.get(key)
        if not isinstance(old, Map):
            above.put(key, _parts_map(parts))
            return
        before = prop.read(old)
        known = prop.components(before) if before is not None else None
        for part, text in parts.items():
            # The file may say "0.1" where RViz writes all digits of it; that stays.
            if known is None or known[part] != text:
                old.put_text(part, text)

    def _new_node(self, path: str) -> Node:
        """Return a property with its value: a text, or a map with all its children."""
        prop = self._declared[path].property
        value = self._values.get(path)
        parts = prop.components(value) if prop.has_value else None
        if parts is not None:
            return _parts_map(parts)
        if prop.children or prop.open_keys or not prop.has_value:
            return self._new_map(path)
        return Scalar(prop.write(value))

    def _new_map(self, path: str) -> Map:
        """A property with children: its own value under "Value", then each child."""
        prop = self._declared[path].property
        made = Map()
        if prop.has_value:
            made.put("Value", Scalar(prop.write(self._values[path])))
        for child in prop.children:
            if not child.read_only:
                made.put(child.name, self._new_node(f"{path}/{child.name}"))
        return made

    def _instead(self, keys: tuple[str, ...], old: Node | None) -> Map:
        """Return a new map in place of a flat value ("Line Style: Lines") or of none.

        Args:
            keys: its place in the item.
            old: the node in this place; a text becomes the map's "Value".
        """
        found = (d for d in self._declared.values() if d.keys == keys)
        declared = next(found, None)
        made = Map()
        if declared is not None and not isinstance(declared.property, VectorProperty):
            made = self._new_map(declared.path)
        if isinstance(old, Scalar) and not old.null:
            made.remove("Value")
            made.put("Value", copied(old))
        return made


def _keys(path: Path) -> tuple[str, ...]:
    return (path,) if isinstance(path, str) else tuple(path)


def _parts_map(parts: Mapping[str, str]) -> Map:
    """Return a map of texts, in their order."""
    return Map([Entry(key, Scalar(text)) for key, text in parts.items()])

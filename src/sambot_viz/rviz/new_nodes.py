"""Nodes for properties that are not in the file yet, as RViz saves them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sambot_viz.rviz.declared import Declared
from sambot_viz.rviz.properties.vectors import VectorProperty
from sambot_viz.rviz.yaml.nodes import Entry, Map, Node, Scalar, copied


class NewNodes:
    """Makes the nodes of one item.

    Args:
        declared: its properties by path.
        values: their values by path; looked up when a node is made.
    """

    def __init__(self, declared: Mapping[str, Declared], values: Mapping[str, Any]):
        self._declared = declared
        self._values = values

    def node(self, path: str) -> Node:
        """A property with its value: a text, or a map with all its children."""
        prop = self._declared[path].property
        value = self._values.get(path)
        parts = prop.components(value) if prop.has_value else None
        if parts is not None:
            return parts_map(parts)
        if prop.children or not prop.has_value:
            return self.map(path)
        return Scalar(prop.write(value))

    def map(self, path: str) -> Map:
        """A property with children: its own value under "Value", then each child."""
        prop = self._declared[path].property
        made = Map()
        if prop.has_value:
            made.put("Value", Scalar(prop.write(self._values[path])))
        for child in prop.children:
            if not child.read_only:
                made.put(child.name, self.node(f"{path}/{child.name}"))
        return made

    def instead(self, keys: tuple[str, ...], old: Node | None) -> Map:
        """A map in the place of a flat value ("Line Style: Lines") or of nothing.

        Args:
            keys: its place in the item.
            old: what is there; a text becomes the map's "Value".
        """
        found = (d for d in self._declared.values() if d.keys == keys)
        declared = next(found, None)
        made = Map()
        if declared is not None and not isinstance(declared.property, VectorProperty):
            made = self.map(declared.path)
        if isinstance(old, Scalar) and not old.null:
            made.remove("Value")
            made.put("Value", copied(old))
        return made


def parts_map(parts: Mapping[str, str]) -> Map:
    """A map of texts, in their order."""
    return Map([Entry(key, Scalar(text)) for key, text in parts.items()])

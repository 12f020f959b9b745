"""An item below another one: a link, a joint or a frame of a display."""

from __future__ import annotations

from collections.abc import Sequence

from sambot_viz.rviz.item import ConfigItem
from sambot_viz.rviz.properties.property import Property
from sambot_viz.rviz.yaml.nodes import Map, Node, Scalar

DETAILS = "Details"
"""In RViz's trees of links, all properties of an entry but "Value" are below this."""


class EntryItem(ConfigItem):
    """Typed values of one entry of another item, such as a link of a RobotModel.

    Reading writes nothing. The entry, and what is missing above it, come into the
    document with the first value that is set. An entry that is only a text
    ("base_link: false") gives its "Value".
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

"""The map of an item in the document, as text."""

from __future__ import annotations

from collections.abc import Sequence

from sambot_viz.rviz.yaml.nodes import Map, Node, Plain, plain

Path = str | Sequence[str]


class ItemMap:
    """One map of the document, whatever its keys mean.

    Args:
        node: the map.
    """

    def __init__(self, node: Map) -> None:
        self._node = node

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
        """What is below a key, declared or not, such as "Links" or "Frames".

        Args:
            path: one key, or a sequence of keys (which may contain slashes).

        Returns:
            Nested dicts of text; empty when nothing is there.
        """
        found = plain(self.node_at(_keys(path)))
        return found if isinstance(found, dict) else {}

    def node_at(self, keys: Sequence[str]) -> Node | None:
        """The node below some keys, declared or not; None when there is none."""
        node: Node | None = self._node
        for key in keys:
            node = node.get(key) if isinstance(node, Map) else None
        return node


def _keys(path: Path) -> tuple[str, ...]:
    return (path,) if isinstance(path, str) else tuple(path)

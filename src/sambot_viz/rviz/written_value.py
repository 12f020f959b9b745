"""How the document writes one value, to write it in exactly the same way again."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from sambot_viz.rviz.yaml.nodes import Map, Node, Scalar

VALUE = "Value"
"""The key of a value that is written as a map with other keys."""


class DocumentMap(Protocol):
    """The map of an item in the document."""

    def node_at(self, keys: Sequence[str]) -> Node | None:
        """The node below some keys, or None."""
        ...

    def map_at(self, keys: Sequence[str]) -> Map:
        """The map at some keys, made if it is missing."""
        ...


class WrittenValue:
    """One value as it is written when this is made; also one that is not written.

    Args:
        item: the map that the value is below.
        keys: its place there.
        parts: the keys that the value itself has where it is a map.
    """

    def __init__(
        self, item: DocumentMap, keys: Sequence[str], parts: Sequence[str]
    ) -> None:
        self._item, self._keys, self._parts = item, tuple(keys), tuple(parts)
        known = 0
        while known < len(keys) and isinstance(item.node_at(keys[:known]), Map):
            known += 1
        # The whole place, or the first part of it that is not a map.
        self._place = self._keys[:known]
        node = item.node_at(self._place)
        self._scalar = node if isinstance(node, Scalar) else None
        self._text = node.text if isinstance(node, Scalar) else ""
        self._texts: dict[str, str | None] = {}
        if isinstance(node, Map):
            self._texts = {part: node.text(part) for part in parts}

    def put_back(self) -> None:
        """Write it as it was."""
        if self._texts:
            _write(self._item.map_at(self._place), self._texts)
            return
        if self._scalar is None or self._place != self._keys:
            self._remove()
        if self._scalar is not None:
            self._put(self._scalar)

    def _put(self, scalar: Scalar) -> None:
        above, key = self._item.map_at(self._place[:-1]), self._place[-1]
        now = above.get(key)
        if isinstance(now, Map) and self._holds_others(now):
            # Other values have been written below the same key since.
            now.put_text(VALUE, self._text)
        else:
            scalar.assign(self._text)
            above.put(key, scalar)

    def _remove(self) -> None:
        """Remove what is written where nothing was, then maps that are empty."""
        above, key = self._item.node_at(self._keys[:-1]), self._keys[-1]
        found = above.get(key) if isinstance(above, Map) else None
        if isinstance(found, Map) and self._holds_others(found):
            found.remove(VALUE)
        elif isinstance(above, Map):
            above.remove(key)
        for depth in range(len(self._keys) - 1, len(self._place) - 1, -1):
            above, key = (
                self._item.node_at(self._keys[: depth - 1]),
                self._keys[depth - 1],
            )
            inner = above.get(key) if isinstance(above, Map) else None
            if isinstance(above, Map) and isinstance(inner, Map) and not inner.entries:
                above.remove(key)

    def _holds_others(self, node: Map) -> bool:
        """Whether a map holds more than the value."""
        return not set(node.keys()) <= {*self._parts, VALUE}


def _write(node: Map, texts: dict[str, str | None]) -> None:
    for key, text in texts.items():
        if text is None:
            node.remove(key)
        else:
            node.put_text(key, text)

"""Undo and redo changes of the items of a document, including their notation.

`record_changes` collects all changes in its block, in any item: one value that a user
sets may change others, as "All Links Enabled" does. Each change keeps the nodes of the
document that it has replaced and puts these same nodes back, so that a document with
all edits undone is saved byte for byte as it was. Later changes next to a value stay.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Generator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Protocol, TypeAlias

from sambot_viz.rviz.yaml.yaml_nodes import Entry, Map, Node, Scalar

Restore: TypeAlias = Callable[[], None]
"""Brings something back to how it was."""

FinishChange: TypeAlias = Callable[[], tuple[Restore, Restore]]
"""Ends a change of one property: returns what undoes it, and what does it again."""

Keys: TypeAlias = tuple[str, ...]
Leaves: TypeAlias = dict[Keys, tuple[Node, str]]
"""Texts, lists and empty maps of the document by their keys, with what they say."""


class Undoable(Protocol):
    """An item whose properties can be put back."""

    def begin_change(self, path: str) -> FinishChange:
        """Record the present state of a property."""
        ...


class UndoLog:
    """The properties that were set, with what they were before and after."""

    def __init__(self) -> None:
        self._steps: list[tuple[Restore, Restore]] = []
        self._open: FinishChange | None = None

    def __bool__(self) -> bool:
        return bool(self._steps)

    def note(self, item: Undoable, path: str) -> None:
        """Record the state of a property before it is set."""
        # A change ends where the next one begins: a later one may move what an
        # earlier one has written, and is undone before it.
        self.finish()
        self._open = item.begin_change(path)

    def finish(self) -> None:
        """End the change that was begun last."""
        if self._open is not None:
            self._steps.append(self._open())
            self._open = None

    def undo(self) -> None:
        """Put all properties back, the last one first."""
        for undo, _ in reversed(self._steps):
            undo()

    def redo(self) -> None:
        """Set all properties again."""
        for _, redo in self._steps:
            redo()


_collecting: ContextVar[UndoLog | None] = ContextVar("_collecting", default=None)


@contextmanager
def record_changes() -> Generator[UndoLog]:
    """Collect the properties that this thread sets inside."""
    log = UndoLog()
    token = _collecting.set(log)
    try:
        yield log
    finally:
        _collecting.reset(token)
        log.finish()


def note(item: Undoable, path: str) -> None:
    """Tell the log, if there is one, that an item is about to set a property."""
    log = _collecting.get()
    if log is not None:
        log.note(item, path)


VALUE = "Value"
"""The key of a value that is written as a map with other keys."""


class DocumentPlace:
    """The place of one value in the document, with all that setting it may add there.

    Args:
        root: the map of an item in the document.
        keys: the place of the value below it.
        children: keys below this place that are other values.
    """

    def __init__(self, root: Map, keys: Sequence[str], children: Collection[str]):
        self._root, self._keys, self._children = root, tuple(keys), children
        known = 1
        while known < len(keys) and isinstance(self._node(self._keys[:known]), Map):
            known += 1
        # The whole place, or its first part that is not a map and has to become one.
        self._scope = self._keys[:known]
        self._whole: Node | None = None

    def leaves(self) -> Leaves:
        """Return what the document has there now."""
        entry, found = self._entry(self._scope), Leaves()
        if entry is not None:
            self._whole = entry.value
            _add_leaves(self._scope, entry.value, found)
        return found

    def restore(self, wanted: Leaves, written: Leaves) -> None:
        """Write what the document had once.

        Args:
            wanted: what it had.
            written: what the change had made of it; where others have written
                something else since, that stays.
        """
        if not wanted and self.leaves() == written:
            # Nobody has written there since: what was made goes, and can come again.
            self._map(self._scope[:-1]).remove(self._scope[-1])
            return
        if wanted and self._entry(self._scope) is None and self._whole is not None:
            self._map(self._scope[:-1]).put(self._scope[-1], self._whole)
        for keys, (_, text) in written.items():
            if keys not in wanted and (self._is_own(keys) or self._text(keys) == text):
                self._remove(keys, wanted)
        for keys, (node, text) in wanted.items():
            if written.get(keys) != (node, text):
                self._put(keys, node, text)

    def _is_own(self, keys: Keys) -> bool:
        """Return whether keys belong to the value and not to one beside or below it."""
        depth = len(self._keys)
        return keys[:depth] == self._keys and not (
            keys[depth:] and keys[depth] in self._children
        )

    def _remove(self, keys: Keys, wanted: Leaves) -> None:
        """Remove a text, then the maps that were made for it and are empty."""
        while len(keys) >= len(self._scope):
            above, found = self._node(keys[:-1]), self._node(keys)
            needed = any(known[: len(keys)] == keys for known in wanted)
            filled = isinstance(found, Map) and found.entries
            if needed or filled or not isinstance(above, Map):
                return
            above.remove(keys[-1])
            keys = keys[:-1]

    def _put(self, keys: Keys, node: Node, text: str) -> None:
        above = self._map(keys[:-1])
        now, own = above.get(keys[-1]), self._is_own(keys)
        if isinstance(now, Map) and now.entries:
            # Other values have been written below the same key since.
            if isinstance(node, Scalar) and (own or now.get(VALUE) is None):
                now.put_text(VALUE, text)
        elif own or now is None or isinstance(now, Map):
            if isinstance(node, Scalar):
                node.text = text
            above.put(keys[-1], node)

    def _map(self, keys: Keys) -> Map:
        """Return the map at some keys, made if it is missing."""
        node = self._root
        for key in keys:
            node = node.made(key, Map)
        return node

    def _entry(self, keys: Keys) -> Entry | None:
        above = self._node(keys[:-1])
        return above.entry(keys[-1]) if isinstance(above, Map) else None

    def _node(self, keys: Keys) -> Node | None:
        node: Node | None = self._root
        for key in keys:
            node = node.get(key) if isinstance(node, Map) else None
        return node

    def _text(self, keys: Keys) -> str | None:
        entry = self._entry(keys)
        return None if entry is None else _text(entry.value)


def _add_leaves(keys: Keys, node: Node, found: Leaves) -> None:
    if not isinstance(node, Map) or not node.entries:
        found[keys] = (node, _text(node))
        return
    for entry in node.entries:
        if entry.key is not None:
            _add_leaves((*keys, entry.key), entry.value, found)


def _text(node: Node) -> str:
    return node.text if isinstance(node, Scalar) else ""

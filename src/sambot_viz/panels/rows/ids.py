"""Ids of rows for parts of a document, such as displays."""

from __future__ import annotations

import itertools
import weakref
from typing import Generic, TypeVar

T = TypeVar("T")


class Ids(Generic[T]):
    """Numbers that stay the same when a part is renamed, moved, removed and put back.

    Args:
        prefix: what the ids begin with.
    """

    def __init__(self, prefix: str) -> None:
        self._prefix = prefix
        self._count = itertools.count(1)
        self._ids: weakref.WeakKeyDictionary[T, str] = weakref.WeakKeyDictionary()
        self._parts: weakref.WeakValueDictionary[str, T] = weakref.WeakValueDictionary()

    def of(self, part: T) -> str:
        """Return the id of a part."""
        if part not in self._ids:
            self._ids[part] = new = f"{self._prefix}{next(self._count)}"
            self._parts[new] = part
        return self._ids[part]

    def find(self, part_id: str) -> T | None:
        """Return the part of an id; it may have left the document since."""
        return self._parts.get(part_id)

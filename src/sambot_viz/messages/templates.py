"""The layouts of messages that were read, by which those alike are read as arrays."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import Generic, TypeVar

K = TypeVar("K", bound=Hashable)
T = TypeVar("T")

_MOST_KEYS = 32
_MOST_OF_A_KEY = 4
_MOST_BYTES = 1 << 23
"""Bytes of the messages of all templates."""


class Templates(Generic[K, T]):
    """Keeps the newest templates by what messages must have in common to be alike.

    Several players may read at a time.
    """

    def __init__(self) -> None:
        # Tuples that are replaced as a whole, for other threads.
        self._known: dict[K, tuple[T, ...]] = {}
        self._bytes = 0

    def __len__(self) -> int:
        """Maximum number of keys with templates."""
        return len(self._known)

    def of(self, key: K) -> Sequence[T]:
        """Return the templates of a key, the newest first."""
        return self._known.get(key, ())

    def keep(self, key: K, template: T, size: int) -> None:
        """Keep one more; where they are too many or too large all others go.

        Args:
            key: what messages must have in common.
            template: of one of them.
            size: of that message, the same for each of its key [bytes].
        """
        if len(self._known) >= _MOST_KEYS or self._bytes > _MOST_BYTES:
            self._known = {}
            self._bytes = 0
        known = self._known.get(key, ())
        kept = self._known[key] = (template, *known)[:_MOST_OF_A_KEY]
        self._bytes += size * (len(kept) - len(known))

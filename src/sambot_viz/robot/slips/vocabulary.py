"""The names that a format knows, and which of them a misspelt one was meant to be."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache

from sambot_viz.cached import cached_property

_LIKENESS = 0.7


@dataclass(frozen=True)
class Word:
    """One element: what it may have. Names are separated by blanks.

    Attributes:
        attributes: its attributes.
        once: children of which only the first counts.
        many: children that may be repeated.
        also: children that are known but not looked into.
        one_of: `once` are alternatives, and only one of them counts.
        opaque: its children are for other programs and are not judged.
    """

    attributes: str = ""
    once: str = ""
    many: str = ""
    also: str = ""
    one_of: bool = False
    opaque: bool = False

    @cached_property
    def named(self) -> tuple[str, ...]:
        """The names of its attributes."""
        return tuple(self.attributes.split())

    @cached_property
    def has(self) -> frozenset[str]:
        """The children that it may have."""
        return frozenset(f"{self.once} {self.many} {self.also}".split())


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """All elements of a format whose names are judged.

    Attributes:
        root: the tag of the root element.
        words: tag → what such an element may have.
        synonyms: "tag.name" → the attribute (or, below that tag, the element) that
            people mean by a name that is not like it.
        enclosed: tag → the element around it that needs nothing else.
    """

    root: str
    words: Mapping[str, Word]
    synonyms: Mapping[str, str] = field(default_factory=dict[str, str])
    enclosed: Mapping[str, str] = field(default_factory=dict[str, str])

    def children(self, tag: str) -> list[str]:
        """Return the children that an element may have and that are looked into."""
        word = self.words[tag]
        return [*word.once.split(), *word.many.split()]

    def parents(self, tag: str) -> list[str]:
        """Return the elements in which an element may be."""
        return [parent for parent in self.words if tag in self.children(parent)]

    def around(self, parent: str, tag: str) -> tuple[str, ...]:
        """Return the elements that are missing between a parent and a tag.

        Returns:
            They and nothing else, outermost first; empty when there are none.
        """
        chain: list[str] = []
        while tag in self.enclosed:
            tag = self.enclosed[tag]
            chain.insert(0, tag)
            if tag in self.children(parent):
                return tuple(chain)
        return ()

    def free(self, parent: str, present: Iterable[str]) -> list[str]:
        """Return the children that would still count beside those that are there."""
        word, there = self.words[parent], set(present)
        once = word.once.split()
        if word.one_of and there.intersection(once):
            return []
        repeated = [*word.many.split(), *word.also.split()]
        return [tag for tag in once if tag not in there] + repeated


def meant(name: str, names: Iterable[str]) -> str | None:
    """Return the name that was meant by a misspelt one, or None.

    One letter too many, too few, another or swapped with the next is a slip, also in a
    short name; so is another letter case.
    """
    return _meant(name, tuple(names))


@lru_cache(maxsize=4096)
def _meant(name: str, known: tuple[str, ...]) -> str | None:
    """Compare once what a macro or a machine repeats a thousand times."""
    plain = name.lower()
    ranked = sorted(known, key=lambda other: -_likeness(plain, other.lower()))
    for other in ranked:
        if is_one_slip(plain, other.lower()):
            return other
    best = next(iter(ranked), None)
    if best is None or _likeness(plain, best.lower()) < _LIKENESS:
        return None
    return best


def _likeness(one: str, other: str) -> float:
    return difflib.SequenceMatcher(None, one, other).ratio()


def is_one_slip(one: str, other: str) -> bool:
    """Return whether two names differ in one letter, or in the order of two."""
    if one == other:
        return True
    start = 0
    while start < min(len(one), len(other)) and one[start] == other[start]:
        start += 1
    a, b = one[start:], other[start:]
    swapped = a[:2] == b[1::-1] and a[2:] == b[2:]
    return swapped or a[1:] == b[1:] or a[1:] == b or a == b[1:]

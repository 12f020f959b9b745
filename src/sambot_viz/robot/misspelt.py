"""Find names that a format does not know but that were meant to be some it knows.

A name counts as misspelt only where the right one would mean something: an <orgin> in a
joint that has no <origin>. Other unknown names are left alone, because every program
may add elements of its own.
"""

from __future__ import annotations

from collections.abc import Iterator, Set
from dataclasses import dataclass

from sambot_viz.robot.vocabulary import Vocabulary, meant
from sambot_viz.robot.xml.element import Element

CALL = "xacro:"
"""How the right name of a macro call begins."""


@dataclass(frozen=True, slots=True)
class Slip:
    """An element or attribute with a wrong name, or an element at a wrong place.

    Attributes:
        element: the element.
        right: the name that was meant; of an element at a wrong place its own.
        attribute: the attribute that has the wrong name, or None.
        parents: the elements that a misplaced one may be in; empty for others.
        target: the element that a misplaced one was meant to be in, if one is there.
        around: the elements that are missing around a misplaced one, outermost first.
    """

    element: Element
    right: str
    attribute: str | None = None
    parents: tuple[str, ...] = ()
    target: Element | None = None
    around: tuple[str, ...] = ()


def find_slips(
    document: Element, vocabulary: Vocabulary, macros: Set[str] = frozenset()
) -> list[Slip]:
    """Find all misspelt names and misplaced elements, in document order.

    Args:
        document: the root element.
        vocabulary: the names of its format.
        macros: those of xacro; their names without the prefix are calls. The calls
            directly below the root are left out, because xacro's reader reports them.
    """
    root = vocabulary.root
    if document.tag != root and (
        document.find(root) is not None or meant(document.tag, [root]) is None
    ):
        return []
    whole = () if document.tag == root else (Slip(document, root),)
    return [*whole, *_Search(vocabulary, macros).below(document, root)]


@dataclass(frozen=True, slots=True)
class _Search:
    vocabulary: Vocabulary
    macros: Set[str]

    def below(self, element: Element, tag: str) -> Iterator[Slip]:
        """Find the slips of an element that is, or was meant to be, one with a tag."""
        yield from self._attributes(element, tag)
        if self.vocabulary.words[tag].opaque:
            return
        for child in element.children:
            slip = None
            if not self.vocabulary.knows(tag, child.tag) and ":" not in child.tag:
                slip = self._child(child, element, tag)
            if slip is not None:
                yield slip
            meaning = child.tag if slip is None else slip.right
            if meaning in self.vocabulary.words:
                yield from self.below(child, meaning)

    def _attributes(self, element: Element, tag: str) -> Iterator[Slip]:
        known = self.vocabulary.attributes(tag)
        free = [name for name in known if name not in element.attributes]
        for name in element.attributes:
            if name in known or ":" in name:
                continue
            synonym = self.vocabulary.synonyms.get(f"{tag}.{name.lower()}")
            right = synonym if synonym in free else meant(name, free)
            if right is not None:
                free.remove(right)
                yield Slip(element, right, name)

    def _child(self, child: Element, parent: Element, tag: str) -> Slip | None:
        """Return what is wrong with a child that its parent does not know."""
        if child.tag in self.macros:
            at_root = tag == self.vocabulary.root
            return None if at_root else Slip(child, f"{CALL}{child.tag}")
        free = self.vocabulary.free(tag, [other.tag for other in parent.children])
        synonym = self.vocabulary.synonyms.get(f"{tag}.{child.tag.lower()}")
        right = synonym if synonym in free else meant(child.tag, free)
        if right is None and child.tag not in self.vocabulary.words:
            right = self._by_attributes(child, tag, free)
        if right is not None and child.find(right) is None:
            return Slip(child, right)
        parents = self.vocabulary.parents(child.tag)
        if not parents or right is not None:
            return None
        target = self._target(child, parent)
        around = self.vocabulary.around(tag, child.tag) if target is None else ()
        return Slip(child, child.tag, None, tuple(parents), target, around)

    def _by_attributes(self, child: Element, tag: str, free: list[str]) -> str | None:
        """Return the only element whose attributes an unknown one has."""
        names = set(child.attributes)
        if child.children or not names - {"name"}:
            return None
        once = self.vocabulary.words[tag].once.split()
        fitting = [
            other
            for other in once
            if other in free and names <= set(self.vocabulary.attributes(other))
        ]
        return fitting[0] if len(fitting) == 1 else None

    def _target(self, child: Element, parent: Element) -> Element | None:
        """Find the element in which a misplaced one would count.

        One around it comes first, then the nearest one before it, then one after it.
        """
        around = parent.parent
        while around is not None:
            if self._takes(around, child.tag):
                return around
            around = around.parent
        at = parent.children.index(child)
        siblings = [*reversed(parent.children[:at]), *parent.children[at + 1 :]]
        return next((e for e in siblings if self._takes(e, child.tag)), None)

    def _takes(self, element: Element, tag: str) -> bool:
        present = [child.tag for child in element.children]
        return (
            element.tag in self.vocabulary.words
            and not self.vocabulary.words[element.tag].opaque
            and tag in self.vocabulary.children(element.tag)
            and tag in self.vocabulary.free(element.tag, present)
        )

"""Find names that a format does not know but that stand for names it knows.

A name counts as misspelt only where the right one would have a meaning: an <orgin> in a
joint that has no <origin>. Other unknown names are ignored, because every program may
add its own elements.
"""

from __future__ import annotations

from collections.abc import Iterator, Set
from dataclasses import dataclass
from itertools import islice
from typing import NamedTuple

from sambot_viz import limits
from sambot_viz.robot.slips.vocabulary import Vocabulary, meant
from sambot_viz.robot.xml.element import Element

_FAR = 30
"""Number of elements to search around, before and after a misplaced one."""
CALL = "xacro:"
"""Prefix of a macro call's correct name."""


@dataclass(frozen=True, slots=True)
class Slip:
    """An element or attribute with a wrong name, or an element at a wrong place.

    Attributes:
        element: the element.
        right: the intended name; for a misplaced element, its current one.
        attribute: the attribute with the wrong name, or None.
        parents: elements that may contain a misplaced one; empty for others.
        target: existing element that should contain a misplaced one.
        around: elements that are missing around a misplaced one, outermost first.
        behind: elements directly after a misplaced one that share its remedy.
    """

    element: Element
    right: str
    attribute: str | None = None
    parents: tuple[str, ...] = ()
    target: Element | None = None
    around: tuple[str, ...] = ()
    behind: tuple[Element, ...] = ()


def find_slips(
    document: Element, vocabulary: Vocabulary, macros: Set[str] = frozenset()
) -> list[Slip]:
    """Find all misspelt names and misplaced elements, in document order.

    Args:
        document: root element.
        vocabulary: names of its format.
        macros: macros of xacro, whose names without the prefix are calls. Calls
            directly below the root are omitted, because xacro's reader reports them.
    """
    root = vocabulary.root
    if document.tag != root and (
        document.find(root) is not None or meant(document.tag, [root]) is None
    ):
        return []
    whole = () if document.tag == root else (Slip(document, root),)
    slips = _Search(vocabulary, macros).below(document, root)
    return [*whole, *islice(slips, limits.SLIPS.value)]


class _Search(NamedTuple):
    vocabulary: Vocabulary
    macros: Set[str]

    def below(self, top: Element, tag: str) -> Iterator[Slip]:
        """Find the slips of an element with a tag, or with a slip of that tag."""
        stack: list[tuple[Element, str, Slip | None]] = [(top, tag, None)]
        while stack:
            element, tag, slip = stack.pop()
            if slip is not None:
                yield slip
            word = self.vocabulary.words.get(tag)
            if word is None:
                continue
            yield from self._attributes(element, tag)
            if element.children and not word.opaque:
                stack.extend(reversed(list(self._children(element, tag))))

    def _children(
        self, element: Element, tag: str
    ) -> Iterator[tuple[Element, str, Slip | None]]:
        """Yield the children, each with its intended element and its slip."""
        free: list[str] | None = None
        left = limits.SLIPS.value
        known = self.vocabulary.words[tag].has
        for number, child in enumerate(element.children):
            slip = None
            is_known = child.tag in known or ":" in child.tag
            if not is_known and left:
                if free is None:
                    present = [other.tag for other in element.children]
                    free = self.vocabulary.free(tag, present)
                slip = self._child(number, element, tag, free)
                left -= slip is not None
            yield child, child.tag if slip is None else slip.right, slip

    def _attributes(self, element: Element, tag: str) -> Iterator[Slip]:
        known = self.vocabulary.words[tag].named
        unknown = [n for n in element.attributes if n not in known and ":" not in n]
        if not unknown:
            return
        free = [name for name in known if name not in element.attributes]
        for name in unknown:
            synonym = self.vocabulary.synonyms.get(f"{tag}.{name.lower()}")
            right = synonym if synonym in free else meant(name, free)
            if right is not None:
                free.remove(right)
                yield Slip(element, right, name)

    def _child(
        self, number: int, parent: Element, tag: str, free: list[str]
    ) -> Slip | None:
        """Return the fault of a child that its parent does not know."""
        child = parent.children[number]
        if child.tag in self.macros:
            at_root = tag == self.vocabulary.root
            return None if at_root else Slip(child, f"{CALL}{child.tag}")
        synonym = self.vocabulary.synonyms.get(f"{tag}.{child.tag.lower()}")
        right = synonym if synonym in free else meant(child.tag, free)
        if right is None and child.tag not in self.vocabulary.words:
            right = self._by_attributes(child, tag, free)
        if right is not None and child.find(right) is None:
            return Slip(child, right)
        if right is not None:
            return None
        return misplaced(number, parent, tag, self.vocabulary)

    def _by_attributes(self, child: Element, tag: str, free: list[str]) -> str | None:
        """Return the only element that has the attributes of an unknown one."""
        names = set(child.attributes)
        if child.children or not names - {"name"}:
            return None
        once = self.vocabulary.words[tag].once.split()
        fitting = [
            other
            for other in once
            if other in free and names <= set(self.vocabulary.words[other].named)
        ]
        return fitting[0] if len(fitting) == 1 else None


def misplaced(
    number: int, parent: Element, tag: str, vocabulary: Vocabulary
) -> Slip | None:
    """Return the right place of a child that its parent does not know; None for none.

    Args:
        number: number of the child.
        parent: element that contains it.
        tag: tag of the parent, or the intended one.
        vocabulary: names of the format.
    """
    child = parent.children[number]
    parents = vocabulary.parents(child.tag)
    if not parents:
        return None
    target = _joint_of(child, parent) or _target(number, parent, vocabulary)
    around = vocabulary.around(tag, child.tag) if target is None else ()
    present = [other.tag for other in parent.children]
    if around and around[0] not in vocabulary.free(tag, present):
        around = ()
    return Slip(child, child.tag, None, tuple(parents), target, around)


def _joint_of(child: Element, parent: Element) -> Element | None:
    """Return the joint without <origin> that a link with one hangs from."""
    if (child.tag, parent.tag) != ("origin", "link") or parent.parent is None:
        return None
    if not (child.get("xyz") or "").strip("0. "):
        # A part that is only rotated is most often a shape.
        return None
    joints = [
        joint
        for joint in parent.parent.find_all("joint")
        for end in joint.find_all("child")
        if end.get("link") == parent.get("name")
    ]
    alone = len(joints) == 1 and joints[0].find("origin") is None
    return joints[0] if alone else None


def _target(number: int, parent: Element, vocabulary: Vocabulary) -> Element | None:
    """Find the element in which a misplaced child would count.

    An enclosing element comes first, then the nearest earlier one, then a later one.
    """
    tag, around = parent.children[number].tag, parent.parent
    for _ in range(_FAR):
        if around is None:
            break
        if _takes(around, tag, vocabulary):
            return around
        around = around.parent
    before = parent.children[max(0, number - _FAR) : number]
    after = parent.children[number + 1 : number + 1 + _FAR]
    siblings = [*reversed(before), *after]
    return next((e for e in siblings if _takes(e, tag, vocabulary)), None)


def _takes(element: Element, tag: str, vocabulary: Vocabulary) -> bool:
    present = [child.tag for child in element.children]
    return (
        element.tag in vocabulary.words
        and not vocabulary.words[element.tag].opaque
        and tag in vocabulary.children(element.tag)
        and tag in vocabulary.free(element.tag, present)
    )

"""Misspelt elements and attributes of SDF, found by the table of all names."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from sambot_viz import limits
from sambot_viz.robot.sdf.elements import ElementType, model_type
from sambot_viz.robot.sdf.gazebo_only import is_for_gazebo
from sambot_viz.robot.sdf.habits import attributes_of_urdf
from sambot_viz.robot.sdf.misplaced import (
    beside_model,
    may_be_slip,
    misplaced_in,
    shares,
)
from sambot_viz.robot.sdf.old_versions import Version, version_of
from sambot_viz.robot.sdf.sdf_words import REPEATED, sdf_vocabulary, types_by_tag
from sambot_viz.robot.slips.misspelt import Slip
from sambot_viz.robot.slips.vocabulary import meant
from sambot_viz.robot.xml.element import Element

_SYNONYMS = {("pose", "frame"): "relative_to"}
"""Element and attribute → name of the attribute since version 1.7."""


def sdf_slips(document: Element) -> list[Slip]:
    """Return the misspelt names in an SDF file, in document order.

    Other rules cover names from URDF, and elements that only Gazebo reads.

    Args:
        document: its root element.
    """
    version = version_of(document.get("version") or "")
    for child in document.children:
        if child.tag == "model":
            slips = _below(child, model_type())
            known = (s for s in slips if not _is_old(s, version))
            return [*beside_model(document, child), *islice(known, limits.SLIPS.value)]
    for child in document.children:
        if meant(child.tag, ["model"]) and child.tag not in ("world", "light", "actor"):
            slips = _below(child, model_type())
            return [Slip(child, "model"), *islice(slips, limits.SLIPS.value)]
    return []


def _is_old(slip: Slip, version: Version | None) -> bool:
    """Return whether a file of its version may have the attribute."""
    if version is None or slip.attribute is None:
        return False
    return version.knows(slip.element, slip.attribute)


def _below(top: Element, known: ElementType) -> Iterator[Slip]:
    """Find the slips of an element that is, or was meant to be, of that type."""
    stack: list[tuple[Element, ElementType | None, Slip | None]] = [(top, known, None)]
    while stack:
        element, kind, slip = stack.pop()
        if slip is not None:
            yield slip
        if kind is not None:
            yield from _attributes(element, kind)
            stack.extend(reversed(list(_children(element, kind))))


def _children(
    element: Element, known: ElementType
) -> Iterator[tuple[Element, ElementType | None, Slip | None]]:
    """Yield the children, the type that each is meant to have, and its slip."""
    slips = {} if known.open else _slips(element, known)
    for child in element.children:
        slip = slips.get(id(child))
        kind = known.children.get(child.tag if slip is None else slip.right)
        if slip is not None and slip.parents:
            kind = types_by_tag()[slip.right]
        yield child, None if is_for_gazebo(child) else kind, slip


def _slips(element: Element, known: ElementType) -> dict[int, Slip]:
    """Return the slips among the children by their `id`."""
    present = {child.tag for child in element.children}
    free = [tag for tag in known.children if tag in REPEATED or tag not in present]
    slips: dict[int, Slip] = {}
    first: Slip | None = None
    for number, child in enumerate(element.children):
        slip = None
        if child.tag not in known.children and may_be_slip(child):
            right = _meant(child, known, free)
            slip = Slip(child, right) if right else misplaced_in(number, element, known)
        shared = None if slip is None or first is None else shares(first, slip)
        if first is not None and shared is not None:
            # Both are put into one new element.
            slips[id(first.element)] = first = shared
        else:
            first = slip if slip is not None and slip.around else None
            if slip is not None:
                slips[id(child)] = slip
    return slips


def _attributes(element: Element, known: ElementType) -> Iterator[Slip]:
    unknown = [n for n in element.attributes if n not in known.attributes]
    unknown = [name for name in unknown if ":" not in name]
    if not unknown or attributes_of_urdf(element, unknown) is not None:
        return
    free = [name for name in known.attributes if name not in element.attributes]
    for name in unknown:
        synonym = _SYNONYMS.get((element.tag, name))
        right = synonym if synonym in free else meant(name, free)
        if right is not None:
            free.remove(right)
            yield Slip(element, right, name)


def _meant(child: Element, known: ElementType, free: list[str]) -> str | None:
    """Return the intended element for one that SDF does not know."""
    synonym = sdf_vocabulary().synonyms.get(f"{known.name}.{child.tag.lower()}")
    right = synonym if synonym in free else meant(child.tag, free)
    return None if right is None or child.find(right) is not None else right

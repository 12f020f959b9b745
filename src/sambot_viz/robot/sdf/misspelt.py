"""Misspelt elements and attributes of SDF, by the table of what it knows."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from sambot_viz.robot.sdf.elements import ElementType, model_type
from sambot_viz.robot.sdf.gazebo_only import is_for_gazebo
from sambot_viz.robot.sdf.habits import attributes_of_urdf, element_of_urdf
from sambot_viz.robot.sdf.old_versions import Version, version_of
from sambot_viz.robot.slips.misspelt import MOST_SLIPS, Slip
from sambot_viz.robot.slips.vocabulary import meant
from sambot_viz.robot.xml.element import Element

_REPEATED = frozenset({"collision", "frame", "joint", "link", "model", "visual"})
"""Elements of which more than the first one counts."""

_SYNONYMS = {("pose", "frame"): "relative_to"}
"""Element and attribute → what the attribute is called since version 1.7."""


def sdf_slips(document: Element) -> list[Slip]:
    """Return the names in an SDF file that were meant to be others, in document order.

    Names that come from URDF, and what only Gazebo reads, are left to other rules.

    Args:
        document: its root element.
    """
    version = version_of(document.get("version") or "")
    for child in document.children:
        if child.tag == "model":
            slips = _below(child, model_type())
            known = (s for s in slips if not _is_old(s, version))
            return list(islice(known, MOST_SLIPS))
    for child in document.children:
        if meant(child.tag, ["model"]) and child.tag not in ("world", "light", "actor"):
            slips = _below(child, model_type())
            return [Slip(child, "model"), *islice(slips, MOST_SLIPS)]
    return []


def _is_old(slip: Slip, version: Version | None) -> bool:
    """Tell whether a file of its version may have the attribute."""
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
    present = {child.tag for child in element.children}
    free = [tag for tag in known.children if tag in _REPEATED or tag not in present]
    for child in element.children:
        right, slip = child.tag, None
        if right not in known.children and not known.open:
            right = _meant(child, free) or right
            slip = Slip(child, right) if right != child.tag else None
        kind = None if is_for_gazebo(child) else known.children.get(right)
        yield child, kind, slip


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


def _meant(child: Element, free: list[str]) -> str | None:
    """Return the element that was meant by one that SDF does not know."""
    if ":" in child.tag or is_for_gazebo(child) or child.tag == "include":
        return None
    right = meant(child.tag, free)
    if right is None or child.find(right) is not None:
        return None
    return None if element_of_urdf(child) is not None else right

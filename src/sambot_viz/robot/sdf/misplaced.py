"""Elements whose parent does not know them, and their right places in SDF."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from sambot_viz.robot.sdf.elements import ElementType
from sambot_viz.robot.sdf.gazebo_only import is_for_gazebo
from sambot_viz.robot.sdf.habits import element_of_urdf
from sambot_viz.robot.sdf.sdf_words import sdf_vocabulary
from sambot_viz.robot.slips.misspelt import Slip, misplaced
from sambot_viz.robot.xml.element import Element

_OF_MODEL = ("link", "joint", "frame")
_SHAPES = ("box", "cylinder", "sphere", "mesh")


def may_be_slip(child: Element) -> bool:
    """Return whether no other rule explains an unknown element."""
    if ":" in child.tag or is_for_gazebo(child) or child.tag == "include":
        return False
    return element_of_urdf(child) is None


def misplaced_in(number: int, parent: Element, known: ElementType) -> Slip | None:
    """Return the right place for a child that its parent does not know.

    Args:
        number: number of the child.
        parent: element that contains it.
        known: type of the parent, or the intended one.

    Returns:
        None where no place for it exists and no element around it would make one.
    """
    if known.name not in sdf_vocabulary().words:
        return None
    slip = misplaced(number, parent, known.name, sdf_vocabulary())
    if slip is not None and slip.target is None and not slip.around:
        slip = replace(slip, around=_solid_around(slip.element, parent))
    return slip if slip is not None and (slip.target or slip.around) else None


def _solid_around(radius: Element, geometry: Element) -> tuple[str, ...]:
    """Return the missing shape around a <radius>; other elements have one parent."""
    if (geometry.tag, radius.tag) != ("geometry", "radius"):
        return ()
    if any(geometry.find(shape) for shape in _SHAPES):
        return ()
    return ("cylinder" if geometry.find("length") else "sphere",)


def shares(first: Slip, slip: Slip) -> Slip | None:
    """Return the first slip, extended by one that fits its new element, or None."""
    inside = sdf_vocabulary().children(first.around[-1])
    there = {first.element.tag, *(element.tag for element in first.behind)}
    if slip.element.tag not in inside or slip.element.tag in there or slip.target:
        return None
    return replace(first, behind=(*first.behind, slip.element))


def beside_model(document: Element, model: Element) -> Iterator[Slip]:
    """Yield the links, joints and frames beside a <model>; later ones as one slip."""
    at = document.children.index(model)
    behind = document.children[at + 1 :]
    together = [child for child in behind if child.tag in _OF_MODEL]
    if len(together) > 1 and all(child.tag in _OF_MODEL for child in behind):
        first, *others = together
        yield Slip(first, first.tag, None, ("model",), model, behind=tuple(others))
        return
    for child in document.children:
        if child.tag in _OF_MODEL:
            yield Slip(child, child.tag, None, ("model",), model)


def advised_place(element: Element) -> str | None:
    """Return advice for an element without an automatic fix, or None."""
    parent, tag = element.parent, element.tag
    if parent is None:
        return None
    if parent.tag == "link" and tag in ("geometry", *_SHAPES):
        inner = "" if tag == "geometry" else "geometry"
        begin, end = (f"<{inner}>", f"</{inner}>") if inner else ("", "")
        name = f"{parent.get('name')}_visual"
        return (
            f'write <visual name="{name}">{begin} before it and {end}</visual> behind '
            "it"
        )
    parents = sdf_vocabulary().parents(tag)
    if not parents:
        return None
    shown = [f"<{name}>" for name in parents]
    places = " or ".join([", ".join(shown[:-1]), shown[-1]] if shown[1:] else shown)
    return f"delete <{tag}>, or move it into {places}"

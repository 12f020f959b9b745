"""Elements without a value that they should say: SDF takes a default in its place."""

from __future__ import annotations

import re

from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.sdf.elements import ElementType
from sambot_viz.robot.sdf.loose_text import loose_text
from sambot_viz.robot.sdf.wording import and_list, described
from sambot_viz.robot.xml.element import Element

_DEFAULTS = {
    ("box", "size"): "1 1 1, a cube of one metre",
    ("cylinder", "radius"): "1 metre",
    ("cylinder", "length"): "1 metre",
    ("sphere", "radius"): "1 metre",
    ("mesh", "uri"): "",
    ("axis", "xyz"): "0 0 1",
    ("inertia", "ixx"): "1",
    ("inertia", "iyy"): "1",
    ("inertia", "izz"): "1",
}
"""Element and what is missing in it → what SDF takes."""

_EXAMPLES = {
    "size": "1 1 1",
    "uri": "package://…/meshes/….stl",
    "xyz": "0 0 1",
}
_REAL = {
    "mesh": "with the name of the file",
    "axis": "or another direction",
    "inertia": "with its real moments in kg m²",
}


_WHEEL = re.compile("(wheel|whl|t[iy]re)(?!.*(cast|steer|swivel))")


def _example(element: Element, child: str) -> str:
    """Return a value as it is usual there."""
    joint = element.parent
    if element.tag == "axis" and joint and _WHEEL.search(joint.get("name") or ""):
        # About z it would spin like a top.
        return "0 1 0"
    return _EXAMPLES.get(child, "1")


def is_needed(element: Element) -> bool:
    """Return whether an element must not be left out."""
    return element.parent is not None and (element.parent.tag, element.tag) in _DEFAULTS


def check_left_out(
    element: Element, known: ElementType, findings: ModelFindings
) -> None:
    """Warn of a value that is not there and would be guessed wrong.

    Nothing is said where the value is there in another form, which is reported.

    Args:
        element: an element of SDF.
        known: what may be in it.
        findings: where the warning goes.
    """
    wanted = [child for tag, child in _DEFAULTS if tag == element.tag]
    missing = [child for child in wanted if element.find(child) is None]
    if not missing or element.attributes or loose_text(element):
        return
    if any(child.tag not in known.children for child in element.children):
        return
    tags = and_list(f"<{child}>" for child in missing)
    written = "".join(
        f"<{child}>{_example(element, child)}</{child}>" for child in missing
    )
    real = _REAL.get(element.tag, "with its real size in metres")
    defaults = {_DEFAULTS[element.tag, child] for child in missing}
    effect = f"SDF takes {defaults.pop()}"
    if element.tag == "mesh":
        effect = "there is no file to draw"
    findings.warn(
        "sdf-value-missing",
        f"<{element.tag}> of {described(element)} lacks {tags}: {effect}",
        f"write {written} into it, {real}",
        element,
    )

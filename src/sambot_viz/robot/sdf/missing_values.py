"""Elements without a necessary value, for which SDF uses a default."""

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
"""Element and its missing part → SDF's default."""

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
    """Return a usual value."""
    joint = element.parent
    if element.tag == "axis" and joint and _WHEEL.search(joint.get("name") or ""):
        # About z, a wheel would spin like a top.
        return "0 1 0"
    return _EXAMPLES.get(child, "1")


def is_needed(element: Element) -> bool:
    """Return whether an element is required."""
    return element.parent is not None and (element.parent.tag, element.tag) in _DEFAULTS


def check_left_out(
    element: Element, known: ElementType, findings: ModelFindings
) -> None:
    """Warn of a missing value whose default is wrong here.

    If the value is there in another form, another rule reports it.

    Args:
        element: an element of SDF.
        known: its valid content.
        findings: receives the warning.
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

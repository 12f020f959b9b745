"""Link names that tf2 does not accept as names of frames."""

from __future__ import annotations

from collections.abc import Mapping

from sambot_viz.robot.urdf.findings import UrdfFindings
from sambot_viz.robot.xml.element import Element


def check_leading_slash(name: str, element: Element, findings: UrdfFindings) -> None:
    """Report a link name that begins with a slash."""
    if name.startswith("//") or name == "/":
        findings.reject(
            "link-name-slashes",
            f"the link name {name} is not a frame for tf2 even without its first "
            "slash, so nothing can be there",
            'write a name without slashes, such as name="arm_link"',
            element,
        )
    elif name.startswith("/"):
        findings.warn(
            "link-name-slash",
            f"the link name {name} begins with a slash, which tf2 does not "
            "allow: the frame can never be looked up",
            f'write name="{name.lstrip("/")}", here and in the joints',
            element,
        )


def check_twins(elements: Mapping[str, Element], findings: UrdfFindings) -> None:
    """Reject links that are the same frame for tf2, which strips one slash."""
    for name, element in elements.items():
        twin = elements.get(name[1:]) if name.startswith("/") else None
        if twin is not None:
            findings.reject(
                "link-name-twin",
                f"the links {name} and {name[1:]} (line {twin.place.line}) are the "
                "same frame for tf2, which strips the slash",
                "give one of the two another name",
                element,
            )

"""Find the links of a robot description, by the frames of its joints.

The text is searched without making a model of it, which costs a hundredth.
"""

from __future__ import annotations

from dataclasses import dataclass

from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element, parse_xml

_FLOATING = ("floating", "ball", "universal", "revolute2", "gearbox", "screw")
"""Types of joints that robot_state_publisher leaves out, in URDF and in SDF."""


@dataclass(frozen=True, slots=True)
class DescribedLinks:
    """The links of a robot.

    Attributes:
        root: the link that no joint holds; empty where there is none.
        joints: (parent, child) of the joints that hold links.
    """

    root: str = ""
    joints: tuple[tuple[str, str], ...] = ()

    @property
    def held(self) -> frozenset[str]:
        """The links that are this robot's alone; its root where it has no joint."""
        found = frozenset(child for _, child in self.joints)
        return found or frozenset((self.root,) if self.root else ())


def described_links(description: str | None) -> DescribedLinks:
    """Return the links of a text of URDF or SDF; none where it cannot be read."""
    try:
        robot = parse_xml(description or "<robot/>", "")
    except XmlFault:
        return DescribedLinks()
    # In SDF the names are texts, and there is a <model> around the links.
    robot = robot.find("model") or robot
    pairs: list[tuple[str, str]] = []
    for joint in (one for one in robot.iter() if one.tag == "joint"):
        parent, child = joint.find("parent"), joint.find("child")
        is_floating = joint.attributes.get("type") in _FLOATING
        if parent is None or child is None or is_floating:
            continue
        pairs.append((_link(parent, "link"), _link(child, "link")))
    children = {child for _, child in pairs}
    links = (_link(one, "name") for one in robot.children if one.tag == "link")
    root = next((link for link in links if link not in children), "")
    return DescribedLinks(root, tuple(pairs))


def _link(element: Element, attribute: str) -> str:
    return plain_name(element.attributes.get(attribute) or element.text.strip())

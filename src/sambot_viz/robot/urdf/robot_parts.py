"""Links and joints of a <robot> element before they are joined to a tree."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sambot_viz.robot.joint import Joint
from sambot_viz.robot.model import Link
from sambot_viz.robot.xml.element import Element


@dataclass(frozen=True, slots=True)
class RobotParts:
    """Links and joints as read, with their elements.

    Attributes:
        robot: the <robot> element.
        links: name → link, in document order.
        link_elements: name → element.
        joints: name → joint, in document order.
        joint_elements: name → element.
        excused: links that are unconnected only because a joint was rejected.
        nameless: number of links without a name, which a joint may refer to.
        duplicates: link names that are used twice, so that a joint may mean either.
    """

    robot: Element
    links: Mapping[str, Link]
    link_elements: Mapping[str, Element]
    joints: Mapping[str, Joint]
    joint_elements: Mapping[str, Element]
    excused: frozenset[str]
    nameless: int
    duplicates: frozenset[str]


def is_fragment(parts: RobotParts) -> bool:
    """Whether this is part of a robot, written to be included by another file.

    Such a file has one undefined parent link that would make everything one tree, or
    it has no robot name and joints between links of other files.
    """
    children = {joint.child for joint in parts.joints.values()}
    parents = {joint.parent for joint in parts.joints.values()}
    missing = (parents | children) - parts.links.keys()
    if not missing or parts.excused or parts.nameless:
        return False
    if parts.robot.get("name") is None:
        return True
    unconnected = parts.links.keys() - children
    return len(missing) == 1 and not unconnected and children <= parts.links.keys()

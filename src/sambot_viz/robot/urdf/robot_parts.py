"""Read the links and joints of a <robot> element, before they form a tree."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from sambot_viz.cached import cached_property
from sambot_viz.errors import Fix, Place
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.parts import Joint, Link
from sambot_viz.robot.urdf.joints import read_joint
from sambot_viz.robot.urdf.links import LinkReader
from sambot_viz.robot.urdf.repeated_names import other_joint, other_link
from sambot_viz.robot.xml.element import Element


@dataclass
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
        duplicates: repeated link names, so that a joint may mean either link.
        repeated_calls: macro calls that create links with a repeated name.
        shared: number of links to which one place in a macro gives the same name.
    """

    robot: Element
    links: dict[str, Link] = field(default_factory=dict[str, Link])
    link_elements: dict[str, Element] = field(default_factory=dict[str, Element])
    joints: dict[str, Joint] = field(default_factory=dict[str, Joint])
    joint_elements: dict[str, Element] = field(default_factory=dict[str, Element])
    excused: set[str] = field(default_factory=set[str])
    nameless: int = 0
    duplicates: set[str] = field(default_factory=set[str])
    repeated_calls: set[Place] = field(default_factory=set[Place])
    shared: int = 0

    @cached_property
    def wanted(self) -> tuple[tuple[str, str, str], ...]:
        """Joints with their missing links, and the role of each link."""
        return tuple(_wanted(self.robot))

    @property
    def is_fragment(self) -> bool:
        """Return whether this is a part of a robot for other files to include.

        Such a file has one undefined parent link that would make everything one tree,
        or it has no robot name and joints between links of other files.
        """
        children = {joint.child for joint in self.joints.values()}
        parents = {joint.parent for joint in self.joints.values()}
        missing = (parents | children) - self.links.keys()
        if not missing or self.excused or self.nameless:
            return False
        if self.robot.get("name") is None:
            return True
        unconnected = self.links.keys() - children
        return len(missing) == 1 and not unconnected and children <= self.links.keys()


def read_parts(
    robot: Element, reader: LinkReader, findings: ModelFindings
) -> RobotParts:
    """Read the links, then the joints; each repeated name counts once.

    Args:
        robot: the <robot> element.
        reader: reads one <link>.
        findings: receives the problems.
    """
    parts = RobotParts(robot)
    _read_links(parts, reader, findings)
    _read_joints(parts, findings)
    return parts


def _read_links(parts: RobotParts, reader: LinkReader, findings: ModelFindings) -> None:
    for element in parts.robot.find_all("link"):
        name = element.get("name")
        if not name:
            parts.nameless += 1
            _report_nameless(parts, element, findings)
            continue
        if name in parts.link_elements:
            _report_duplicate(parts, name, element, findings)
            continue
        _check_leading_slash(name, element, findings)
        parts.link_elements[name] = element
        parts.links[name] = reader.read(element, name)
    _check_twins(parts.link_elements, findings)


def _report_nameless(
    parts: RobotParts, element: Element, findings: ModelFindings
) -> None:
    joint, wanted, _ = parts.wanted[0] if parts.wanted else ("", "…", "")
    more = f"; joint {joint} expects one called {wanted}" if joint else ""
    findings.reject(
        "link-without-name",
        f"this <link> has no name{more}; ROS refuses the model",
        f'write <link name="{wanted}">',
        element,
    )


def _wanted(robot: Element) -> Iterator[tuple[str, str, str]]:
    named = {link.get("name") for link in robot.find_all("link")}
    for joint in robot.find_all("joint"):
        for tag in ("parent", "child"):
            end = joint.find(tag)
            link = end.get("link") if end is not None else None
            if link and link not in named:
                yield joint.get("name") or "", link, tag


def _report_duplicate(
    parts: RobotParts, name: str, element: Element, findings: ModelFindings
) -> None:
    first, call = parts.link_elements[name], element.call
    wanted = {link: joint for joint, link, end in parts.wanted if end == "child"}
    said = f"the link name {name} is used on line {first.place.line} and again here"
    if call is not None and first.call is not None and first.place == element.place:
        lines = f"{first.call.line} and {call.line}"
        said = f"the macro calls on lines {lines} both make a link {name}"
    hint: str | Fix = "give one of the two another name"
    if len(wanted) == 1:
        link, joint = wanted.popitem()
        joints = {j.get("name") or "": j for j in parts.robot.find_all("joint")}
        hint = other_link(first, element, link, joints[joint])
    elif call is not None:
        hint = f"give the macro call on line {call.line} another name"
    findings.reject(
        "link-duplicate",
        f"{said}; names must be unique and ROS refuses the model",
        hint,
        element,
    )
    if element.place == first.place:
        parts.shared += 1 if name in parts.duplicates else 2
        parts.excused.add(name)
    parts.duplicates.add(name)
    if call is not None:
        parts.repeated_calls.add(call)


def _check_leading_slash(name: str, element: Element, findings: ModelFindings) -> None:
    """Report a link name that tf2 does not accept as the name of a frame."""
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


def _check_twins(elements: dict[str, Element], findings: ModelFindings) -> None:
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


def _read_joints(parts: RobotParts, findings: ModelFindings) -> None:
    elements = parts.joint_elements
    for element in parts.robot.find_all("joint"):
        joint = read_joint(element, findings)
        first = elements.get(element.get("name") or "")
        repeated = element.call is not None and element.call in parts.repeated_calls
        if joint is not None and first is not None and not repeated:
            findings.reject(
                "joint-duplicate",
                f"the joint name {joint.name} is used on line {first.place.line} and "
                "again here; names must be unique and ROS refuses the model",
                other_joint(first, element, parts.robot),
                element,
            )
        if joint is None or first is not None:
            # This excuses links that are unconnected only without this joint.
            ends = [element.find(tag) for tag in ("child", "parent")]
            links = [end.get("link") for end in ends if end is not None]
            known = [link for link in links if link]
            parts.excused.update(known if len(known) == len(ends) else parts.links)
            continue
        parts.joints[joint.name] = joint
        elements[joint.name] = element

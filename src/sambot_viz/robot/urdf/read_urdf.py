"""Read the elements of a URDF into links and joints, as urdfdom does.

An invalid joint, name or tree rejects the model; an invalid shape drops the remaining
shapes of its link; an invalid material drops its colour. Reading always continues to
the end, so that all errors are reported together.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from sambot_viz.robot.joint import Joint
from sambot_viz.robot.model import Link
from sambot_viz.robot.urdf.findings import UrdfFindings, tag_text
from sambot_viz.robot.urdf.frame_names import check_leading_slash, check_twins
from sambot_viz.robot.urdf.joints import read_joint
from sambot_viz.robot.urdf.link_tree import build_tree
from sambot_viz.robot.urdf.links import FindMesh, LinkReader
from sambot_viz.robot.urdf.material_table import FindTexture, MaterialTable
from sambot_viz.robot.urdf.mimic_rules import check_mimics
from sambot_viz.robot.urdf.robot_parts import RobotParts, is_fragment
from sambot_viz.robot.xml.element import Element

_OTHER_ROOTS = {
    "sdf": "an SDF file of Gazebo",
    "world": "an SDF world of Gazebo",
    "model": "a Gazebo model",
    "mujoco": "a MuJoCo model",
    "COLLADA": "a COLLADA mesh",
    "launch": "a launch file",
    "package": "a package manifest",
    "html": "a web page",
}


@dataclass(frozen=True, slots=True)
class UrdfRobot:
    """The content of a URDF document: name, root link, links and joints of its tree."""

    name: str
    root: str
    links: dict[str, Link]
    joints: dict[str, Joint]


def read_urdf(
    document: Element,
    findings: UrdfFindings,
    find_mesh: FindMesh,
    find_texture: FindTexture,
    expanded: bool,
) -> UrdfRobot | None:
    """Read a document.

    Args:
        document: its root element.
        findings: where problems go; `findings.rejected` says whether ROS refuses it.
        find_mesh: mesh name → file.
        find_texture: texture name → file.
        expanded: the document came out of xacro.

    Returns:
        The robot, or None when nothing can be drawn.
    """
    robot = _robot_element(document, findings)
    if robot is None:
        return None
    _check_version(robot, findings)
    materials = MaterialTable(findings, find_texture)
    for element in robot.find_all("material"):
        materials.add_global(element)
    reader = LinkReader(findings, materials, find_mesh)
    links = _read_links(robot, reader, findings)
    check_twins(links.elements, findings)
    joints, joint_elements, excused = _read_joints(robot, links.links, findings)
    parts = RobotParts(
        robot,
        links.links,
        links.elements,
        joints,
        joint_elements,
        excused,
        links.nameless,
        frozenset(links.duplicates),
    )
    if not parts.links and not parts.nameless and not is_fragment(parts):
        _report_no_links(robot, findings)
        return None
    name = _robot_name(parts, findings, expanded)
    check_mimics(parts.joints, parts.joint_elements, findings)
    tree = build_tree(parts, findings)
    if tree is None:
        return None
    return UrdfRobot(name, tree.root, tree.links, tree.joints)


def _robot_element(document: Element, findings: UrdfFindings) -> Element | None:
    if document.tag == "robot":
        return document
    inner = document.find("robot")
    if inner is not None:
        findings.warn(
            "robot-not-root",
            f"<robot> is inside <{document.tag}>; joint_state_publisher accepts "
            "this, but robot_state_publisher and RViz need <robot> as the root",
            f"delete <{document.tag}> and </{document.tag}>",
            inner,
        )
        return inner
    kind = _OTHER_ROOTS.get(document.tag, "not a robot description")
    more = (
        "export URDF, or convert the file first"
        if document.tag in _OTHER_ROOTS
        else "the root element must be <robot>"
    )
    findings.reject(
        "root-not-robot",
        f"this is {kind} (<{document.tag}> on line {document.place.line}), not URDF",
        more,
        document,
    )
    return None


def _check_version(robot: Element, findings: UrdfFindings) -> None:
    version = robot.get("version")
    if version is None or version in ("1.0", "1.00"):
        return
    findings.reject(
        "robot-version",
        f'version="{version}" of <robot> is not supported; ROS knows only 1.0 and '
        "refuses the model",
        'delete the attribute, or write version="1.0"',
        robot,
        "version",
    )


def _robot_name(parts: RobotParts, findings: UrdfFindings, expanded: bool) -> str:
    robot = parts.robot
    name = robot.get("name")
    if name:
        return name
    hint = 'write <robot name="my_robot">'
    if name is not None:
        findings.warn("robot-name-empty", "the robot's name is empty", hint, robot)
        return ""
    if expanded or is_fragment(parts):
        findings.warn(
            "robot-without-name",
            "<robot> has no name, so this is probably a file for xacro:include; it "
            "is drawn here, but ROS refuses it on its own",
            f"open the file that includes it, or {hint}",
            robot,
        )
    else:
        findings.reject(
            "robot-without-name",
            "<robot> has no name; ROS refuses the model",
            hint,
            robot,
        )
    return "robot"


@dataclass(slots=True)
class _Links:
    """The <link> elements read so far; see `RobotParts`."""

    links: dict[str, Link] = field(default_factory=dict[str, Link])
    elements: dict[str, Element] = field(default_factory=dict[str, Element])
    nameless: int = 0
    duplicates: set[str] = field(default_factory=set[str])


def _read_links(robot: Element, reader: LinkReader, findings: UrdfFindings) -> _Links:
    read = _Links()
    for element in robot.find_all("link"):
        name = element.get("name")
        if not name:
            read.nameless += 1
            _report_nameless(robot, element, findings)
            continue
        first = read.elements.get(name)
        if first is not None:
            findings.reject(
                "link-duplicate",
                f"the link name {name} is used on line {first.place.line} and again "
                "here; names must be unique and ROS refuses the model",
                "give one of the two another name",
                element,
            )
            read.duplicates.add(name)
            continue
        check_leading_slash(name, element, findings)
        read.elements[name] = element
        read.links[name] = reader.read(element, name)
    return read


def _report_nameless(robot: Element, element: Element, findings: UrdfFindings) -> None:
    named = {link.get("name") for link in robot.find_all("link")}
    wanted: list[str] = []
    for joint in robot.find_all("joint"):
        for tag in ("parent", "child"):
            end = joint.find(tag)
            link = end.get("link") if end is not None else None
            if link and link not in named:
                wanted.append(f"joint {joint.get('name')} expects one called {link}")
    more = f"; {wanted[0]}" if wanted else ""
    findings.reject(
        "link-without-name",
        f"this <link> has no name{more}; ROS refuses the model",
        'write <link name="…">',
        element,
    )


def _read_joints(
    robot: Element, links: Mapping[str, Link], findings: UrdfFindings
) -> tuple[dict[str, Joint], dict[str, Element], frozenset[str]]:
    """The joints, their elements, and the links whose joint was rejected."""
    joints: dict[str, Joint] = {}
    elements: dict[str, Element] = {}
    excused: set[str] = set()
    for element in robot.find_all("joint"):
        joint = read_joint(element, findings)
        first = elements.get(element.get("name") or "")
        if joint is not None and first is not None:
            findings.reject(
                "joint-duplicate",
                f"the joint name {joint.name} is used on line {first.place.line} and "
                "again here; names must be unique and ROS refuses the model",
                "give one of the two another name",
                element,
            )
        if joint is None or first is not None:
            # A link without this joint is not reported as unconnected.
            child = element.find("child")
            link = child.get("link") if child is not None else None
            excused.update([link] if link else links)
            continue
        joints[joint.name] = joint
        elements[joint.name] = element
    return joints, elements, frozenset(excused)


def _report_no_links(robot: Element, findings: UrdfFindings) -> None:
    inside = next(
        (e for e in robot.iter() if e.tag == "link" and e.parent is not robot), None
    )
    group = inside.parent if inside is not None else None
    if inside is not None and group is not None and group.tag not in _NOT_GROUPS:
        findings.reject(
            "links-not-direct",
            f"the links are inside {tag_text(group)}; links and joints must be "
            "directly inside <robot>, so ROS finds none",
            f"delete <{group.tag}> and </{group.tag}>",
            group,
        )
        return
    findings.reject(
        "robot-without-links",
        "the robot has no links; a file with only macros or properties is meant to be "
        "included by another file",
        'open the file that includes it, or add <link name="base_link"/>',
        robot,
    )


_NOT_GROUPS = frozenset({"joint", "xacro:macro", "transmission", "gazebo"})

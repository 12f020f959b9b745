"""Whether links and joints make one tree, and what ROS would make of it.

What urdfdom refuses rejects the model; what it accepts although it is wrong is kept
as ROS would keep it, and reported.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from sambot_viz.errors import did_you_mean
from sambot_viz.robot.joint import Joint
from sambot_viz.robot.model import Link
from sambot_viz.robot.urdf.findings import UrdfFindings
from sambot_viz.robot.xml.element import Element

DEEPEST = 350
"""Measured with Chromium: 350 joints in a row are drawn, 500 are not."""


@dataclass(frozen=True, slots=True)
class Tree:
    """The part that hangs together: the root, and what is reached from it."""

    root: str
    links: dict[str, Link]
    joints: dict[str, Joint]


@dataclass(slots=True)
class RobotParts:
    """Links and joints as read, with the elements they came from.

    Attributes:
        links: name → link, in document order.
        joints: name → joint, in document order.
        link_elements: name → element.
        joint_elements: name → element.
        robot: the <robot> element.
        excused: links that are loose only because their joint could not be read.
        nameless: links without a name, which a joint may have meant.
        doubled: link names that are used twice, so that a joint may mean either.
    """

    links: dict[str, Link]
    joints: dict[str, Joint]
    link_elements: dict[str, Element]
    joint_elements: dict[str, Element]
    robot: Element
    excused: set[str] = field(default_factory=set[str])
    nameless: int = 0
    doubled: set[str] = field(default_factory=set[str])


def build_tree(parts: RobotParts, findings: UrdfFindings) -> Tree | None:
    """Check the structure and give what ROS would show.

    A piece of a robot (an include file) gets the links that are not in it, empty and
    with a warning; ROS refuses it alone.

    Returns:
        The tree, or None when there is none.
    """
    fragment = is_fragment(parts)
    if fragment:
        _add_missing_links(parts, findings)
    _check_ends(parts, findings)
    _check_self_joints(parts, findings)
    holder = _parent_joints(parts, findings)
    rings = _rings(parts, holder)
    roots = [name for name in parts.links if name not in holder]
    if not roots:
        _report_rings(parts, findings, rings, None)
        return None
    if len(roots) > 1:
        _report_roots(parts, findings, roots, fragment)
    root = _largest(parts, roots)
    _report_rings(parts, findings, rings, root)
    tree = _reached(parts, holder, root)
    _report_depth(parts, findings, tree)
    return tree


def is_fragment(parts: RobotParts) -> bool:
    """Whether this is a piece of a robot, written for another file to include.

    Such a file has one undefined parent link that would make everything one tree, or
    it has no name and joints between links that are elsewhere.
    """
    children = {joint.child for joint in parts.joints.values()}
    parents = {joint.parent for joint in parts.joints.values()}
    missing = (parents | children) - parts.links.keys()
    if not missing or parts.excused or parts.nameless:
        return False
    if parts.robot.get("name") is None:
        return True
    loose = parts.links.keys() - children
    return len(missing) == 1 and not loose and children <= parts.links.keys()


def _add_missing_links(parts: RobotParts, findings: UrdfFindings) -> None:
    added: dict[str, Link] = {}
    for joint in parts.joints.values():
        for end, link in (("parent", joint.parent), ("child", joint.child)):
            if link in parts.links or link in added:
                continue
            added[link] = Link(link)
            element = parts.joint_elements[joint.name]
            what = "hangs on" if end == "parent" else "holds"
            findings.warn(
                f"joint-{end}-elsewhere",
                f"joint {joint.name} {what} the link {link}, which is not in this "
                "file: it is a piece of a robot, drawn here on an empty link; ROS "
                "refuses it alone",
                f'open the file that includes this one, or add <link name="{link}"/>',
                element.find(end) or element,
                "link",
            )
    parts.links = {**added, **parts.links}


def _check_ends(parts: RobotParts, findings: UrdfFindings) -> None:
    unknown = [
        (joint, tag, link)
        for joint in parts.joints.values()
        for tag, link in (("parent", joint.parent), ("child", joint.child))
        if link not in parts.links
    ]
    if parts.nameless and len({link for _, _, link in unknown}) <= parts.nameless:
        # The link exists but lost its name; that has been reported.
        unknown = []
    for joint, tag, link in unknown:
        element = parts.joint_elements[joint.name]
        near = did_you_mean(link, [name for name in parts.links if name])
        findings.reject(
            f"joint-{tag}-unknown",
            f"joint {joint.name} names the {tag} link '{link}', which does not exist "
            f"({near}); ROS refuses the model",
            f'correct the name, or add <link name="{link}"/>',
            element.find(tag) or element,
            "link",
        )
    if any(tag == "child" for _, tag, _ in unknown):
        parts.excused.update(parts.links)


def _check_self_joints(parts: RobotParts, findings: UrdfFindings) -> None:
    for name, joint in parts.joints.items():
        if joint.parent == joint.child:
            element = parts.joint_elements[name]
            findings.error(
                "joint-to-itself",
                f"joint {name} connects {joint.child} to itself, so the link hangs "
                "on nothing; ROS says nothing and does not show it",
                "the child must be another link than the parent",
                element.find("child") or element,
            )


def _parent_joints(parts: RobotParts, findings: UrdfFindings) -> dict[str, Joint]:
    """Link → the joint that holds it: of several the last in alphabetical order."""
    holders: dict[str, list[Joint]] = {}
    for joint in parts.joints.values():
        if joint.child in parts.links:
            holders.setdefault(joint.child, []).append(joint)
    chosen: dict[str, Joint] = {}
    for link, joints in holders.items():
        chosen[link] = max(joints, key=lambda joint: joint.name)
        if len(joints) > 1 and link not in parts.doubled:
            _report_two_parents(parts, findings, link, joints, chosen[link].name)
    return chosen


def _report_two_parents(
    parts: RobotParts, findings: UrdfFindings, link: str, joints: list[Joint], kept: str
) -> None:
    listed = " and ".join(
        f"{j.name} (line {parts.joint_elements[j.name].place.line})" for j in joints
    )
    element = parts.joint_elements[joints[-1].name]
    findings.error(
        "link-two-parents",
        f"link {link} is the child of more than one joint: {listed}; ROS keeps only "
        f"{kept} silently",
        "a link can be the child of one joint only: delete or correct the other",
        element.find("child") or element,
        "link",
    )


def _rings(parts: RobotParts, holder: Mapping[str, Joint]) -> list[list[Joint]]:
    """The rings among the links, each as its joints from one link round to itself."""
    rings: list[list[Joint]] = []
    done: set[str] = set()
    for start in parts.links:
        path: list[str] = []
        link = start
        while link in holder and link not in done:
            done.add(link)
            path.append(link)
            link = holder[link].parent
        if link in path:
            ring = path[path.index(link) :]
            if len(ring) > 1:
                rings.append([holder[name] for name in reversed(ring)])
    return rings


def _report_rings(
    parts: RobotParts,
    findings: UrdfFindings,
    rings: Iterable[list[Joint]],
    root: str | None,
) -> None:
    for ring in rings:
        order = list(parts.joints)
        last = max(ring, key=lambda joint: order.index(joint.name))
        start = ring.index(last) + 1
        turned = ring[start:] + ring[:start]
        names = " → ".join([turned[0].parent, *(joint.child for joint in turned)])
        element = parts.joint_elements[last.name]
        at = element.find("child") or element
        hint = f"delete the joint {last.name}, or another one of the ring"
        if root is None:
            findings.reject(
                "joint-ring",
                f"the joints form a ring: {names}; there is no root link and ROS "
                "refuses the model",
                hint,
                at,
            )
        else:
            findings.error(
                "joint-ring",
                f"the joints form a ring: {names}; it is not connected to the root "
                f"{root}, and ROS loses these links silently",
                hint,
                at,
            )


def _report_roots(
    parts: RobotParts, findings: UrdfFindings, roots: list[str], fragment: bool
) -> None:
    main = _largest(parts, roots)
    report = findings.warn if fragment else findings.reject
    for root in roots:
        if root in (main, "") or root in parts.excused:
            continue
        report(
            "root-not-unique",
            f"link {root} is not connected to {main}: no joint has it as child, so "
            "there is more than one root link; ROS refuses the model",
            f"add a joint whose child is {root}",
            parts.link_elements.get(root, parts.robot),
        )


def _largest(parts: RobotParts, roots: list[str]) -> str:
    """The root with the most links below it: that is the robot, the rest is loose."""
    children = _children(parts.joints.values())
    return max(roots, key=lambda root: len(_below(root, children)))


def _children(joints: Iterable[Joint]) -> dict[str, list[str]]:
    """Link → the links that hang on it."""
    children: dict[str, list[str]] = {}
    for joint in joints:
        children.setdefault(joint.parent, []).append(joint.child)
    return children


def _below(root: str, children: Mapping[str, list[str]]) -> set[str]:
    """A link and all that hang below it."""
    reached: set[str] = set()
    stack = [root]
    while stack:
        link = stack.pop()
        if link not in reached:
            reached.add(link)
            stack.extend(children.get(link, ()))
    return reached


def _report_depth(parts: RobotParts, findings: UrdfFindings, tree: Tree) -> None:
    """Warn of a chain that a browser cannot draw: it stacks a call per link."""
    children = _children(tree.joints.values())
    level, depth = [tree.root], 0
    while level and depth <= DEEPEST:
        depth += 1
        level = [child for link in level for child in children.get(link, ())]
    if level:
        findings.warn(
            "chain-too-long",
            f"more than {DEEPEST} links hang one below the other (the first so deep is "
            f"{level[0]}): a browser cannot draw so long a chain, and the view stays "
            "empty",
            "hang links on one that is nearer to the root",
            parts.link_elements.get(level[0], parts.robot),
        )


def _reached(parts: RobotParts, holder: Mapping[str, Joint], root: str) -> Tree:
    reached = _below(root, _children(holder.values()))
    links = {name: link for name, link in parts.links.items() if name in reached}
    joints = {
        name: joint
        for name, joint in parts.joints.items()
        if joint.child in reached and holder.get(joint.child) is joint
    }
    return Tree(root, links, joints)

"""Build the tree of links and joints as ROS would, and report its faults.

An error that urdfdom refuses rejects the model. For an error that urdfdom accepts, the
module reports it and builds the tree as ROS does.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import NamedTuple

from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.joint_graph import (
    children_of,
    copied_joint,
    exchanged_joint,
    links_below,
    report_depth,
    rings_of,
)
from sambot_viz.robot.parts import Joint, Link
from sambot_viz.robot.urdf.joint_ends import check_ends
from sambot_viz.robot.urdf.robot_parts import RobotParts


class Tree(NamedTuple):
    """The connected tree: the root link, and the links and joints reached from it."""

    root: str
    links: dict[str, Link]
    joints: dict[str, Joint]


def build_tree(parts: RobotParts, findings: ModelFindings) -> Tree | None:
    """Check the structure, and return the tree that ROS would show.

    ROS refuses a file that is only part of a robot (an include file). This function
    adds its missing links, empty and with a warning.

    Returns:
        The tree, or None when there is none.
    """
    fragment = parts.is_fragment
    if fragment:
        parts = _with_missing_links(parts, findings)
    parts = check_ends(parts, findings)
    _check_self_joints(parts, findings)
    holder = _parent_joints(parts, findings)
    rings = rings_of(parts.links, holder)
    roots = [name for name in parts.links if name not in holder]
    if not roots:
        _report_rings(parts, findings, rings, None)
        return None
    if len(roots) > 1:
        _report_roots(parts, findings, roots, fragment)
    root = _largest(parts, roots)
    _report_rings(parts, findings, rings, root)
    tree = _reached(parts, holder, root)
    report_depth(
        tree.root, tree.joints.values(), parts.link_elements, parts.robot, findings
    )
    return tree


def _with_missing_links(parts: RobotParts, findings: ModelFindings) -> RobotParts:
    added: dict[str, Link] = {}
    for joint in parts.joints.values():
        for end, link in (("parent", joint.parent), ("child", joint.child)):
            if link in parts.links or link in added:
                continue
            added[link] = Link(link)
            element = parts.joint_elements[joint.name]
            findings.warn(
                f"joint-{end}-elsewhere",
                f"joint {joint.name} has the {end} link {link}, which is not in this "
                "file: the file is part of a robot, drawn here with an empty link; "
                "ROS refuses the file on its own",
                f'open the file that includes this one, or add <link name="{link}"/>',
                element.find(end) or element,
                "link",
            )
    return replace(parts, links={**added, **parts.links})


def _check_self_joints(parts: RobotParts, findings: ModelFindings) -> None:
    selves = [joint for joint in parts.joints.values() if joint.parent == joint.child]
    for joint in selves:
        element = parts.joint_elements[joint.name]
        alone, end = _without_joint(parts, joint.child), "child"
        hint = "name two different links as parent and child"
        if len(selves) >= len(alone):
            parts.excused.update(alone)
        if len(alone) == len(selves) == 1:
            below = _below(parts)
            sizes = [len(links_below(each, below)) for each in (*alone, joint.child)]
            # base_footprint is the root even without anything else below it.
            is_root = sizes[0] > sizes[1] and "footprint" not in joint.child
            end = "parent" if is_root else "child"
            hint = f'write <{end} link="{alone[0]}"/>'
        findings.error(
            "joint-to-itself",
            f"joint {joint.name} connects {joint.child} to itself, so the link is "
            "not connected to anything; ROS drops it without a message",
            hint,
            element.find(end) or element,
        )


def _without_joint(parts: RobotParts, link: str) -> list[str]:
    """Return the links that a joint from a link to itself may be intended to join.

    No other joint has them as its child, and they are not the root. The root is the
    link itself if no other joint has it as its child, otherwise the lone link with the
    most links below it.
    """
    below = _below(parts)
    children = {child for each in below.values() for child in each}
    alone = [name for name in parts.links if name not in children]
    if link in alone:
        alone.remove(link)
    elif alone:
        alone.remove(max(alone, key=lambda name: len(links_below(name, below))))
    return alone


def _below(parts: RobotParts) -> dict[str, list[str]]:
    return children_of(j for j in parts.joints.values() if j.parent != j.child)


def _parent_joints(parts: RobotParts, findings: ModelFindings) -> dict[str, Joint]:
    """Return link → the joint whose child it is; of several, the last by alphabet."""
    holders: dict[str, list[Joint]] = {}
    for joint in parts.joints.values():
        if joint.child in parts.links:
            holders.setdefault(joint.child, []).append(joint)
    chosen: dict[str, Joint] = {}
    roots = [name for name in parts.links if name not in holders]
    main = _largest(parts, roots) if roots else ""
    copied = copied_joint(holders, [root for root in roots if root != main])
    for link, joints in holders.items():
        chosen[link] = max(joints, key=lambda joint: joint.name)
        others = [joint for joint in joints if joint.parent != joint.child]
        if len(others) > 1 and link not in parts.duplicates:
            if copied is not None and not parts.duplicates:
                _report_copied(parts, findings, joints, *copied)
                continue
            turned = exchanged_joint(parts.joints.values(), parts.links, main)
            if turned in joints and not parts.duplicates:
                _report_exchanged(parts, findings, joints, turned)
                continue
            _report_two_parents(parts, findings, link, joints, chosen[link].name)
    return chosen


def _report_copied(
    parts: RobotParts,
    findings: ModelFindings,
    joints: list[Joint],
    copied: Joint,
    meant: str,
) -> None:
    """Report a joint that has the child of another one; its own is then alone."""
    other = next(joint for joint in joints if joint is not copied)
    element = parts.joint_elements[copied.name]
    findings.reject(
        "link-two-parents",
        f"link {copied.child} is the child of {copied.name} and of {other.name} (line "
        f"{parts.joint_elements[other.name].place.line}), and {meant} of no joint; ROS "
        "refuses the model",
        f'write <child link="{meant}"/>',
        element.find("child") or element,
        "link",
    )
    parts.excused.add(meant)


def _report_exchanged(
    parts: RobotParts, findings: ModelFindings, joints: list[Joint], turned: Joint
) -> None:
    """Report a joint whose parent and child are swapped."""
    other = next(joint for joint in joints if joint is not turned)
    findings.reject(
        "link-two-parents",
        f"joint {turned.name} has {turned.parent} as its parent and {turned.child} as "
        f"its child, which is already the child of {other.name} (line "
        f"{parts.joint_elements[other.name].place.line}), and {turned.parent} is the "
        "child of no joint: they are exchanged; ROS refuses the model",
        f'write <parent link="{turned.child}"/> and <child link="{turned.parent}"/>',
        parts.joint_elements[turned.name],
    )
    parts.excused.add(turned.parent)


def _report_two_parents(
    parts: RobotParts,
    findings: ModelFindings,
    link: str,
    joints: list[Joint],
    kept: str,
) -> None:
    listed = " and ".join(
        f"{j.name} (line {parts.joint_elements[j.name].place.line})" for j in joints
    )
    element = parts.joint_elements[joints[-1].name]
    findings.error(
        "link-two-parents",
        f"link {link} is the child of more than one joint: {listed}; ROS uses only "
        f"{kept}, without a message",
        "a link can be the child of one joint only: delete or correct the other",
        element.find("child") or element,
        "link",
    )


def _report_roots(
    parts: RobotParts, findings: ModelFindings, roots: list[str], fragment: bool
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
            f"add a joint whose child is {root}: {_joint_between(main, root, parts)}",
            parts.link_elements.get(root, parts.robot),
        )


def _joint_between(parent: str, child: str, parts: RobotParts) -> str:
    """Write a joint that connects two links."""
    name = f"{child}_joint"
    while name in parts.joints:
        name = f"{name}_2"
    return (
        f'<joint name="{name}" type="fixed"><parent link="{parent}"/>'
        f'<child link="{child}"/></joint>'
    )


def _report_rings(
    parts: RobotParts,
    findings: ModelFindings,
    rings: Iterable[list[Joint]],
    root: str | None,
) -> None:
    """Report each ring at its last joint; without a root link ROS refuses the model."""
    order = {name: number for number, name in enumerate(parts.joints)}
    for ring in rings:
        last = max(ring, key=lambda joint: order[joint.name])
        start = ring.index(last) + 1
        turned = ring[start:] + ring[:start]
        names = " → ".join([turned[0].parent, *(joint.child for joint in turned)])
        element = parts.joint_elements[last.name]
        at = element.find("child") or element
        message = f"the joints form a ring: {names}; "
        if root is None:
            report = findings.reject
            message += "there is no root link and ROS refuses the model"
        else:
            report = findings.error
            message += f"it is not connected to the root {root}, and ROS drops these "
            message += "links without a message"
        hint = f"delete the joint {last.name}, or another joint of the ring"
        report("joint-ring", message, hint, at)


def _largest(parts: RobotParts, roots: list[str]) -> str:
    """Return the root with the most links below it; others are unconnected parts."""
    children = children_of(parts.joints.values())
    return max(roots, key=lambda root: len(links_below(root, children)))


def _reached(parts: RobotParts, holder: Mapping[str, Joint], root: str) -> Tree:
    reached = links_below(root, children_of(holder.values()))
    links = {name: link for name, link in parts.links.items() if name in reached}
    joints = {
        name: joint
        for name, joint in parts.joints.items()
        if joint.child in reached and holder.get(joint.child) is joint
    }
    return Tree(root, links, joints)

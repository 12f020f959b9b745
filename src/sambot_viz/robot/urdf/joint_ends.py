"""Joints whose parent or child link does not exist."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from sambot_viz.edits import write_attribute
from sambot_viz.errors import Fix, did_you_mean
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.parts import Joint
from sambot_viz.robot.slips.blanks import written_with_blank
from sambot_viz.robot.slips.near_links import near_link, one_name
from sambot_viz.robot.urdf.robot_parts import RobotParts
from sambot_viz.robot.xml.element import Element


class _Unknown(NamedTuple):
    """A joint whose parent or child (the tag) is a link that does not exist."""

    joint: Joint
    tag: str
    link: str


def check_ends(parts: RobotParts, findings: ModelFindings) -> RobotParts:
    """Report parent and child links that do not exist; excuse links that need one."""
    unknown = [
        _Unknown(joint, tag, link)
        for joint in parts.joints.values()
        for tag, link in (("parent", joint.parent), ("child", joint.child))
        if link not in parts.links
    ]
    missing = {link for _, _, link in unknown}
    if len(missing) <= max(parts.nameless, len(parts.duplicates), parts.shared):
        # The link exists but lost its name, which has its own problem.
        unknown = []
    _report_unknown(parts, findings, _without_blanks(parts, findings, unknown))
    if any(tag == "child" for _, tag, _ in unknown):
        return replace(parts, excused=parts.excused | parts.links.keys())
    return parts


def _without_blanks(
    parts: RobotParts, findings: ModelFindings, unknown: list[_Unknown]
) -> list[_Unknown]:
    """Report links whose names contain an extra blank; return the other joints."""
    with_blank = {name.strip(): name for name in parts.links if name != name.strip()}
    named = {end for j in parts.joints.values() for end in (j.parent, j.child)}
    for _, _, link in unknown:
        spaced = written_with_blank(link, parts.links, named)
        if spaced is not None:
            with_blank.setdefault(link, spaced)
    reported: set[str] = set()
    for joint, _, link in unknown:
        name = with_blank.get(link)
        if name is None or name in reported:
            continue
        reported.add(name)
        named_here = parts.link_elements.get(name, parts.robot)
        verb = "begins with" if name[0].isspace() else "ends with"
        if name == name.strip():
            verb = "contains"
        findings.reject(
            "link-name-blank",
            f'the link name "{name}" {verb} a blank, so joint {joint.name} does '
            f"not find the link {link}; ROS refuses the model",
            write_attribute(named_here.place, "name", name, link),
            named_here,
            "name",
        )
    return [one for one in unknown if one.link not in with_blank]


def _report_unknown(
    parts: RobotParts, findings: ModelFindings, unknown: list[_Unknown]
) -> None:
    children = {joint.child for joint in parts.joints.values()}
    roots = (parts.links.keys() | {link for _, _, link in unknown}) - children
    # With several roots, ROS would refuse the robot even with these links.
    is_whole = len(roots) == 1
    for joint, tag, link in unknown:
        element = parts.joint_elements[joint.name]
        end = element.find(tag) or element
        other = joint.child if tag == "parent" else joint.parent
        possible = [name for name in parts.links if name and name != other]
        if tag == "child":
            possible = [name for name in possible if name not in children]
        meant = near_link(link, possible)
        near = f" ({did_you_mean(meant or link, possible)})" if possible else ""
        if meant in parts.link_elements:
            line = parts.link_elements[meant].place.line
            near = f" (did you mean '{meant}', on line {line}?)"
        findings.reject(
            f"joint-{tag}-unknown",
            f"joint {joint.name} names the {tag} link '{link}', which does not exist"
            f"{near}; ROS refuses the model",
            _advice(end, link, parts.link_elements.get(meant or ""), is_whole),
            end,
            "link",
            cause=f"link {link}",
        )


def _advice(end: Element, link: str, near: Element | None, is_whole: bool) -> str | Fix:
    add = f', or add <link name="{link}"/>' if is_whole else ""
    if near is not None:
        return one_name(end, link, near, add)
    named = f"name a link of this robot as the {end.tag}"
    return f"correct the name{add}" if add else named

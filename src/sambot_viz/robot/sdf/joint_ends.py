"""The two links of every joint; for ROS they must be links of this model."""

from __future__ import annotations

from dataclasses import dataclass

from sambot_viz.edits import write, write_attribute
from sambot_viz.errors import did_you_mean
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.sdf.fields import text_in
from sambot_viz.robot.sdf.scopes import Frame, Scope
from sambot_viz.robot.sdf.values import trimmed
from sambot_viz.robot.sdf.wording import REFUSED, described
from sambot_viz.robot.slips.blanks import written_with_blank
from sambot_viz.robot.slips.near_links import near_link, one_name
from sambot_viz.robot.xml.element import Element


@dataclass(frozen=True, slots=True)
class JoinedLinks:
    """A joint and the two links that it joins."""

    joint: Frame
    parent: str
    child: str


def read_ends(scope: Scope, findings: ModelFindings) -> list[JoinedLinks]:
    """Return the joints between two different links; others are reported."""
    read = [_read(joint, scope, findings) for joint in scope.of_kind("joint")]
    return [ends for ends in read if ends is not None]


def _read(joint: Frame, scope: Scope, findings: ModelFindings) -> JoinedLinks | None:
    parent, child = (_end(joint, tag, scope, findings) for tag in ("parent", "child"))
    if parent is None or child is None:
        return None
    if parent == child:
        findings.reject(
            "joint-to-itself",
            f"joint {joint.name} connects {child} to itself; {REFUSED}",
            "name two different links as <parent> and <child>",
            joint.element.find("child") or joint.element,
        )
        return None
    return JoinedLinks(joint, parent, child)


def _end(joint: Frame, tag: str, scope: Scope, findings: ModelFindings) -> str | None:
    """Return the name of a link, None for anything else."""
    element = joint.element.find(tag)
    if element is None:
        findings.reject(
            f"joint-without-{tag}",
            f"joint {joint.name} has no <{tag}>; {REFUSED}",
            f"write <{tag}>…</{tag}> with the name of a link into it",
            joint.element,
        )
        return None
    name = text_in(joint.element, tag)
    if not name:
        return None
    if scope.frames.get(name, scope.own).kind == "link":
        return name
    if name == "world":
        _refuse_world(joint, tag, element, scope, findings)
    elif scope.find(name) is not None or "::" in name:
        _refuse_frame(joint, tag, name, element, scope, findings)
    else:
        _refuse_unknown(joint, tag, element, scope, findings)
    return None


def _refuse_unknown(
    joint: Frame, tag: str, element: Element, scope: Scope, findings: ModelFindings
) -> None:
    """Report an end that is no name of the model."""
    name = trimmed(element.text)
    joints = [frame.element for frame in scope.of_kind("joint")]
    links = [frame.name for frame in scope.of_kind("link")]
    named = {text_in(other, end) for other in joints for end in ("parent", "child")}
    spaced = written_with_blank(name, links, named)
    if spaced is not None:
        findings.reject(
            "link-name-blank",
            f'the link name "{spaced}" contains a blank, so joint {joint.name} does '
            f"not find the link {name}; {REFUSED}",
            write_attribute(scope.frames[spaced].element.place, "name", spaced, name),
            scope.frames[spaced].element,
            "name",
        )
        return
    other = text_in(joint.element, "child" if tag == "parent" else "parent")
    taken = {text_in(j, "child") for j in joints} if tag == "child" else set[str]()
    possible = [link for link in links if link != other and link not in taken]
    near = near_link(name, possible)
    findings.reject(
        f"joint-{tag}-unknown",
        f"joint {joint.name} names the {tag} link '{name}', which does not exist "
        f"({did_you_mean(near or name, possible or links)}); {REFUSED}",
        one_name(element, name, scope.frames[near].element)
        if near
        else f'correct the name, or add <link name="{name}"/>',
        element,
        cause=f"link {name}",
    )


def _refuse_world(
    joint: Frame, tag: str, element: Element, scope: Scope, findings: ModelFindings
) -> None:
    findings.reject(
        "sdf-joint-to-world",
        f"joint {joint.name} has world as its {tag}: where the robot is belongs to "
        f"Gazebo's world, and {REFUSED}",
        f"delete the joint {joint.name}{_with_poses(joint, scope)}, or put it into a "
        "file for Gazebo only",
        element,
    )


def _with_poses(joint: Frame, scope: Scope) -> str:
    """Name the elements relative to a joint that should be deleted."""
    named = [
        f' and {attribute}="{joint.name}" of the <pose> in {described(pose)} (line '
        f"{pose.line_of(attribute)})"
        for pose in (frame.element.find("pose") for frame in scope.frames.values())
        for attribute in ("relative_to", "frame")
        if pose is not None and trimmed(pose.get(attribute) or "") == joint.name
    ]
    return "".join(named)


def _refuse_frame(
    joint: Frame,
    tag: str,
    name: str,
    element: Element,
    scope: Scope,
    findings: ModelFindings,
) -> None:
    """Report an end that is a frame, a joint, or in a nested model."""
    if (own := scope.without_own(name)) is not None:
        findings.reject(
            f"joint-{tag}-unknown",
            f"joint {joint.name} names the {tag} link '{name}', which does not exist: "
            f"{scope.model.get('name')} is the model itself, in which its own links "
            f"have no prefix; {REFUSED}",
            write(element.place, name, own, hint=f"write <{tag}>{own}</{tag}>"),
            element,
        )
        return
    if "::" in name:
        findings.reject(
            "sdf-joint-to-nested",
            f"joint {joint.name} has {name} as its {tag}, a link of a nested model: "
            "robot_state_publisher ends with an error at it",
            "write the links and joints of the nested model into this model",
            element,
        )
        return
    named = scope.find(name)
    frame, seen = named, set[Frame]()
    while frame is not None and frame.kind != "link" and frame not in seen:
        # Frames may be attached in a ring, which another rule reports.
        seen.add(frame)
        frame = frame.attached
    better = frame.name if frame is not None and frame.kind == "link" else ""
    findings.reject(
        "sdf-joint-to-frame",
        f"joint {joint.name} has {name} as its {tag}, which is not a link; SDF allows "
        f"it, but {REFUSED}",
        # It may be intended as a link, or be away from its link.
        _as_link(joint, named)
        if named is not None and better in _ends_of(joint)
        else f"write <{tag}>{better or '…'}</{tag}>",
        element,
    )


def _ends_of(joint: Frame) -> tuple[str, str]:
    return text_in(joint.element, "parent"), text_in(joint.element, "child")


def _as_link(joint: Frame, frame: Frame) -> str:
    """Explain how a frame becomes a link: the joint is between it and its own link."""
    pose = frame.element.find("pose")
    if pose is not None and trimmed(pose.get("relative_to") or ""):
        return (
            "make it a link: write <link> for <frame> in line "
            f"{frame.element.place.line}, without attached_to"
        )
    own = joint.element.find("pose")
    # The frame is where its link is; where the joint has a pose, that was meant.
    base = joint.name if own is not None else frame.element.get("attached_to") or ""
    numbers = pose.text.strip() if pose is not None else ""
    placed = f'<pose relative_to="{base}"'
    placed += f">{numbers}</pose>" if numbers else "/>"
    return (
        f'make it a link: write <link name="{frame.name}">{placed}</link> for the '
        f"<frame> in line {frame.element.place.line}"
    )

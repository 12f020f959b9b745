"""Rings of joints, in which each link is above itself."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sambot_viz.robot.joint import Joint
from sambot_viz.robot.urdf.findings import UrdfFindings
from sambot_viz.robot.urdf.robot_parts import RobotParts


def find_rings(parts: RobotParts, holder: Mapping[str, Joint]) -> list[list[Joint]]:
    """The rings among the links, each as the joints that lead back to the first link.

    Args:
        parts: the robot.
        holder: link → the joint whose child it is.
    """
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


def report_rings(
    parts: RobotParts,
    findings: UrdfFindings,
    rings: Iterable[list[Joint]],
    root: str | None,
) -> None:
    """Report each ring at the joint of it that comes last in the file.

    Args:
        parts: the robot.
        findings: where the problems go.
        rings: what `find_rings` returned.
        root: the root link, or None when there is none and ROS refuses the model.
    """
    order = {name: number for number, name in enumerate(parts.joints)}
    for ring in rings:
        last = max(ring, key=lambda joint: order[joint.name])
        start = ring.index(last) + 1
        turned = ring[start:] + ring[:start]
        names = " → ".join([turned[0].parent, *(joint.child for joint in turned)])
        element = parts.joint_elements[last.name]
        at = element.find("child") or element
        hint = f"delete the joint {last.name}, or another joint of the ring"
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
                f"{root}, and ROS drops these links without a message",
                hint,
                at,
            )

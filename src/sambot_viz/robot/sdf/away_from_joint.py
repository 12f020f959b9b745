"""Links away from their joints, in a model whose other links are at theirs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.sdf.joint_ends import JoinedLinks
from sambot_viz.robot.sdf.scopes import Frame, Scope
from sambot_viz.robot.sdf.values import trimmed
from sambot_viz.robot.xml.element import Element

_FEWEST = 2
"""Number of links with poses from their own joints that make it a habit."""


def warn_of_links_away_from_joints(
    scope: Scope, ends: Sequence[JoinedLinks], findings: ModelFindings
) -> None:
    """Warn of a link without a pose, or with one from another link's joint.

    ROS places the link at its joint, Gazebo at its pose.
    """
    pairs = [(scope.frames[end.child], end.joint) for end in ends]
    own = sum(_base(link) == joint.name for link, joint in pairs)
    joints = {joint.name for _, joint in pairs}
    away = [
        (link, joint)
        for link, joint in pairs
        if _base(link) != joint.name
        and (_base(link) in joints or not _pose(link))
        and joint.element.find("pose") is not None
        and not np.allclose(joint.T_base_frame, np.eye(4))
    ]
    if own < max(_FEWEST, len(away) + 1):
        return
    for link, joint in away:
        pose = link.element.find("pose")
        base = _base(link)
        said = f"counts from {base}" if base else "has no pose"
        findings.warn(
            "sdf-link-away-from-joint",
            f"link {link.name} {said}, and the other links count from their own "
            f"joints: in Gazebo it is not where {joint.name} has it, and its sensors "
            "see from there",
            f'write <pose relative_to="{joint.name}"/> into it',
            link.element if pose is None else pose,
        )


def _pose(link: Frame) -> Element | None:
    """Return the pose of a link; None without one or with an empty one."""
    pose = link.element.find("pose")
    if pose is None or not (trimmed(pose.text) or pose.attributes):
        return None
    return pose


def _base(link: Frame) -> str:
    """Return the frame that the pose of a link is written to be relative to."""
    pose = link.element.find("pose")
    return "" if pose is None else trimmed(pose.get("relative_to") or "")

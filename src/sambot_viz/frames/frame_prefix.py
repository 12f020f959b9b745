"""The frame_prefix of a robot_state_publisher: what it puts before the names of links.

A robot of a fleet publishes robot1/base_link where its URDF says base_link. In RViz the
TF Prefix of RobotModel says so; here the frames themselves tell it too.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable

from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.robot.model import Robot


def joints_of(robot: Robot) -> list[tuple[str, str]]:
    """Return (parent, child) of all joints, as frames."""
    joints = robot.joints.values()
    return [(plain_name(joint.parent), plain_name(joint.child)) for joint in joints]


def frame_prefix(
    joints: Iterable[tuple[str, str]],
    pairs: Iterable[tuple[str, str]],
    likely: str = "",
) -> str:
    """Return what messages put before the links of a robot, such as "robot1/".

    Args:
        joints: (parent, child) of the robot's joints.
        pairs: (parent, child) of the transforms that messages bring.
        likely: the prefix to take where several fit.

    Returns:
        An empty text when messages name links as they are, or say nothing of them.
    """
    above = {child: parent for parent, child in joints}
    found = ""
    for parent, child in pairs:
        if above.get(child) == parent:
            return ""
        head, slash, link = child.rpartition("/")
        if slash and link in above and (not found or f"{head}/" == likely):
            if parent == f"{head}/{above[link]}":
                found = f"{head}/"
    return found


def other_prefix(
    links: Collection[str],
    named: Iterable[str],
    frames: Collection[str],
    likely: str = "",
) -> str | None:
    """Return the TF Prefix with which the links of a robot are frames.

    Args:
        links: of the robot.
        named: their frames, with the present prefix.
        frames: all frames.
        likely: the prefix to take where several fit.

    Returns:
        None when there is none, and when some of `named` are frames.
    """
    if any(frame in frames for frame in named):
        return None
    found = Counter(
        head
        for head, _, link in (frame.rpartition("/") for frame in frames)
        if link in links
    )
    if found[likely]:
        return likely
    best = found.most_common(1)
    return best[0][0] if best else None

"""Merges several robots: each further one hangs at a link, with a name prefix."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint, Origin


@dataclass(frozen=True, slots=True)
class HungRobot:
    """A further robot.

    Attributes:
        name: prefix of its link and joint names, followed by a slash, like the
            frame_prefix of robot_state_publisher.
        robot: the robot.
        parent: link that it hangs at.
        origin: pose of its root link in the parent link.
    """

    name: str
    robot: Robot
    parent: str
    origin: Origin

    @property
    def root(self) -> str:
        """Its root link, with the prefix."""
        return f"{self.name}/{self.robot.root}"


def merged(first: Robot, hung: Sequence[HungRobot]) -> Robot:
    """Return a robot with all links and joints; without others, the first itself.

    Its text and files are those of the first robot. A further robot hangs at the root
    if its parent link is missing.

    Args:
        first: robot that keeps its names.
        hung: the others; each may hang at an earlier one.
    """
    if not hung:
        return first
    links, joints = dict(first.links), dict(first.joints)
    roots = first.file_roots
    for one in hung:
        for link in one.robot.links.values():
            name = f"{one.name}/{link.name}"
            links[name] = replace(link, name=name)
        for joint in one.robot.joints.values():
            moved = _prefixed(joint, one.name)
            joints[moved.name] = moved
        parent = one.parent if one.parent in links else first.root
        name = f"{one.name}/fixed_to_{parent.replace('/', '_')}"
        joints[name] = Joint(name, "fixed", parent, one.root, one.origin)
        others = one.robot.file_roots
        roots = None if roots is None or others is None else (*roots, *others)
    problems = (*first.problems, *(p for one in hung for p in one.robot.problems))
    return replace(
        first, links=links, joints=joints, problems=problems, file_roots=roots
    )


def _prefixed(joint: Joint, name: str) -> Joint:
    mimic = joint.mimic
    return replace(
        joint,
        name=f"{name}/{joint.name}",
        parent=f"{name}/{joint.parent}",
        child=f"{name}/{joint.child}",
        mimic=mimic and replace(mimic, joint=f"{name}/{mimic.joint}"),
    )

"""The joints of a robot in order, and the start poses of its links."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple, Protocol

from sambot_viz.geometry import PlainPose
from sambot_viz.robot.parts import Joint, Mimic, mimic_chain

SPINNING = ("revolute", "continuous")
"""Types of joints that turn about their axis."""
_FARTHEST = 1e30
"""Limit for positions in a chain of mimic joints with large factors."""


class JointTree(Protocol):
    """The parts of a robot that its kinematics needs."""

    @property
    def root(self) -> str:
        """The name of the root link."""
        ...

    @property
    def joints(self) -> Mapping[str, Joint]:
        """The joints by name."""
        ...


class MimicRow(NamedTuple):
    """One mimic joint: row = multiplier · leader + offset."""

    row: int
    leader: int
    multiplier: float
    offset: float


def by_depth(robot: JointTree) -> tuple[list[Joint], list[int]]:
    """Return joints by depth, and the row above of each link (of the root: itself)."""
    children: dict[str, list[Joint]] = {}
    for joint in robot.joints.values():
        children.setdefault(joint.parent, []).append(joint)
    order: list[Joint] = []
    rows = {robot.root: 0}
    waiting = [robot.root]
    for link in waiting:
        for joint in children.get(link, ()):
            order.append(joint)
            rows[joint.child] = len(order)
            waiting.append(joint.child)
    return order, [0, *(rows[joint.parent] for joint in order)]


def followers(order: Sequence[Joint]) -> list[MimicRow]:
    """Return the mimic joints, leaders first.

    Rings, and those of an unknown leader, keep their start values:
    joint_state_publisher ends at those with an exception; here a Problem names them.
    """
    joints = {joint.name: joint for joint in order}
    rows = {name: row for row, name in enumerate(joints)}
    chains = [mimic_chain(joint, joints) for joint in joints.values()]
    follows: list[MimicRow] = []
    for chain in sorted(chains, key=lambda chain: len(chain.joints)):
        if len(chain.joints) == 1 or chain.end == "ring":
            continue
        joint, leader = chain.joints[:2]
        mimic = joint.mimic or Mimic(leader.name)
        row, leader_row = rows[joint.name], rows[leader.name]
        follows.append(MimicRow(row, leader_row, mimic.multiplier, mimic.offset))
    return follows


def start_of(joint: Joint) -> float:
    """Return the start position of a joint [rad or m]."""
    return joint.start if joint.movable else 0.0


def mimicked(leader: float, multiplier: float, offset: float) -> float:
    """Return the position of a mimic joint [rad or m], from that of its leader."""
    return min(max(multiplier * leader + offset, -_FARTHEST), _FARTHEST)


def start_poses(robot: JointTree) -> dict[str, PlainPose]:
    """Return T_root_link of all links with all joints at their start values."""
    order, _ = by_depth(robot)
    values = [start_of(joint) for joint in order]
    for one in followers(order):
        values[one.row] = mimicked(values[one.leader], one.multiplier, one.offset)
    found = {robot.root: PlainPose()}
    for joint, value in zip(order, values, strict=True):
        T_parent_joint = found[joint.parent] @ joint.origin.pose
        found[joint.child] = T_parent_joint @ _moved(joint, value)
    return found


def _moved(joint: Joint, value: float) -> PlainPose:
    """Return T_joint_child at a position [rad or m]."""
    x, y, z = joint.axis
    if joint.type == "prismatic":
        return PlainPose(position=(x * value, y * value, z * value))
    if joint.type in SPINNING and (x or y or z):
        s = math.sin(value / 2)
        return PlainPose((x * s, y * s, z * s, math.cos(value / 2)))
    return PlainPose()


def free_positions(robot: JointTree, given: Mapping[str, float]) -> dict[str, float]:
    """Return the positions of joints that follow no other joint."""
    joints = robot.joints
    return {
        name: position
        for name, position in given.items()
        if name in joints and joints[name].movable and joints[name].mimic is None
    }

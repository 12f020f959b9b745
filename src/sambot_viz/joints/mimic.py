"""Who follows whom: mimic chains and the free joint at their end.

The positions themselves come from `Kinematics`. What would kill joint_state_publisher
(spec/ros-nodes.md §1.6) becomes a Problem here, also when it comes from a parameter.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sambot_viz.errors import Problem, did_you_mean
from sambot_viz.robot.model import Joint, Mimic


@dataclass(frozen=True, slots=True)
class Follower:
    """A mimic joint that follows.

    Attributes:
        mimic: the joint it names, multiplier and offset.
        leader: the free joint at the end of the chain; the one to set.
    """

    mimic: Mimic
    leader: str


def find_followers(
    joints: Mapping[str, Joint],
) -> tuple[dict[str, Follower], tuple[Problem, ...]]:
    """Find the free joint at the end of every mimic chain.

    Args:
        joints: all joints of the robot, by name, in document order.

    Returns:
        Mimic joint → how it follows, in document order, without those that cannot
        follow; and why those cannot.
    """
    followers: dict[str, Follower] = {}
    problems: list[Problem] = []
    rings: set[frozenset[str]] = set()
    for joint in joints.values():
        if joint.mimic is None or not joint.movable:
            continue
        found = _follow(joint, joints)
        if isinstance(found, Follower):
            followers[joint.name] = found
        elif frozenset(found[0]) not in rings:
            # A ring is told once, not again for each of its joints.
            rings.add(frozenset(found[0]))
            problems.append(found[1])
    return followers, tuple(problems)


def _follow(
    joint: Joint, joints: Mapping[str, Joint]
) -> Follower | tuple[tuple[str, ...], Problem]:
    passed = [joint.name]
    current = joint
    while current.mimic is not None:
        leader = joints.get(current.mimic.joint)
        if leader is None or not leader.movable:
            return ((joint.name,), _no_leader(joint, current, joints))
        if leader.name in passed:
            ring = (*passed[passed.index(leader.name) :], leader.name)
            return (ring, _ring(joint, ring))
        passed.append(leader.name)
        current = leader
    return Follower(joint.mimic or Mimic(current.name), current.name)


def _no_leader(joint: Joint, last: Joint, joints: Mapping[str, Joint]) -> Problem:
    name = last.mimic.joint if last.mimic else ""
    through = "" if last is joint else f" through '{last.name}'"
    leader = joints.get(name)
    if leader is None:
        movable = [j.name for j in joints.values() if j.movable and j.name != last.name]
        code, fault = "mimic-joint-unknown", "which does not exist"
        hint = did_you_mean(name, movable)
    else:
        code, fault = "mimic-joint-immovable", f"which is {leader.type}"
        hint = "name a revolute, continuous or prismatic joint"
    message = f"joint '{joint.name}' mimics '{name}'{through}, {fault}"
    return _problem(joint, code, message, hint)


def _ring(joint: Joint, ring: tuple[str, ...]) -> Problem:
    if len(ring) == 2:
        message = f"joint '{joint.name}' mimics itself"
    else:
        message = f"the joints {' → '.join(ring)} mimic each other in a ring"
    return _problem(joint, "mimic-ring", message, "one of them must be free")


def _problem(joint: Joint, code: str, message: str, hint: str) -> Problem:
    place = joint.place
    if place is None:
        return Problem("error", code, message, hint)
    return Problem("error", code, message, hint, place.file, place.line, place.column)

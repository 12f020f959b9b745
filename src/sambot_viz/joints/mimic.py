"""Mimic joints: the free joint that each one follows, or why it cannot follow.

The positions come from `Kinematics`. joint_state_publisher ends with an exception at
a mimic joint that cannot follow; here it is a Problem.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass

from sambot_viz.errors import Problem, did_you_mean
from sambot_viz.robot.parts import Joint, Mimic, mimic_chain


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
            # A ring is reported once, not again for each of its joints.
            rings.add(frozenset(found[0]))
            problems.append(found[1])
    return followers, tuple(problems)


def _follow(
    joint: Joint, joints: Mapping[str, Joint]
) -> Follower | tuple[tuple[str, ...], Problem]:
    """Find how a mimic joint follows; or the joints that prevent it, and why."""
    chain = mimic_chain(joint, joints)
    for follower, leader in itertools.pairwise(chain.joints):
        if not leader.movable:
            return ((joint.name,), _no_leader(joint, follower, joints))
    last = chain.joints[-1]
    if chain.end == "unknown":
        return ((joint.name,), _no_leader(joint, last, joints))
    if chain.end == "ring":
        names = [joint.name for joint in chain.ring]
        ring = (*names, names[0])
        return (ring, _ring(joint, ring))
    return Follower(joint.mimic or Mimic(last.name), last.name)


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
    return Problem.at(joint.place, "error", code, message, hint)


def _ring(joint: Joint, ring: tuple[str, ...]) -> Problem:
    if len(ring) == 2:
        message = f"joint '{joint.name}' mimics itself"
    else:
        message = f"the joints {' → '.join(ring)} mimic each other in a ring"
    hint = "one of them must be free"
    return Problem.at(joint.place, "error", "mimic-ring", message, hint)

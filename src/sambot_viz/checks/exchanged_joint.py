"""Report a joint with exchanged parent and child, which makes a part the root."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.rule import Subject
from sambot_viz.errors import Problem
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint, Language

_WORDS = re.compile(r"[^\W_]+")
_BASES = frozenset("base body chassis footprint frame platform root world".split())
_OF_ALL = frozenset("joint link to".split())
"""Words that do not identify a part."""


def exchanged_joint(subject: Subject) -> Iterator[Problem]:
    """Report a part as the root, with a joint named after it and not after its child.

    It is a guess: the tree is valid, but everything hangs from the part.
    """
    joint = joint_of_part(subject.robot)
    if joint is None:
        return
    yield Problem.at(
        joint.place,
        "warning",
        "joint-exchanged",
        f"joint {joint.name} has {joint.parent} as its parent and {joint.child} as its "
        "child, so that all other parts hang from it: parent and child are exchanged",
        ends_exchanged(joint, subject.robot.language),
    )


def joint_of_part(robot: Robot) -> Joint | None:
    """Return the joint of a root that has the root's name and not that of a base."""
    joint = joint_of_root(robot)
    if joint is None or not _words(joint.name) & (_words(robot.root) - _BASES):
        return None
    child = _words(joint.child)
    of_child = _words(joint.name) & (child - _words(robot.root))
    return joint if child & _BASES and not of_child else None


def joint_of_root(robot: Robot) -> Joint | None:
    """Return the only joint of a root with a shape, where other links follow it."""
    root = robot.links[robot.root]
    own = [joint for joint in robot.joints.values() if joint.parent == robot.root]
    # A link without a shape, such as base_footprint, may be the root.
    if len(own) != 1 or not (root.visuals or root.collisions):
        return None
    behind = [joint for joint in robot.joints.values() if joint.parent == own[0].child]
    return own[0] if behind else None


def ends_exchanged(joint: Joint, language: Language) -> str:
    """Return the hint that exchanges parent and child."""
    tag = "<{0}>{1}</{0}>" if language == "sdf" else '<{0} link="{1}"/>'
    parent, child = tag.format("parent", joint.child), tag.format("child", joint.parent)
    return f"write {parent} and {child}"


def _words(name: str) -> set[str]:
    return {*_WORDS.findall(name.lower())} - _OF_ALL

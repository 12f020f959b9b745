"""The rows of joints: sliders in groups, those that follow others, those without."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from sambot_viz.joints import JointState
from sambot_viz.panels.rows.row import Row
from sambot_viz.robot.parts import Joint

STEP_ANGLE, STEP_LENGTH = 0.01, 0.001
"""Added by an arrow key [rad] and [m]."""
FEWEST_STEPS = 20
"""Minimum number of steps of a joint with a short range."""
FOLLOWERS, SKIPPED = "joints/followers", "joints/skipped"
ID_PREFIX = "j/"
_FEW = 12
UNGROUPED = 30
"""Maximum number of joints in one list."""
LARGEST_GROUP = 8
"""A larger group is divided, where the names say how."""
_RUN = 25
"""Size of groups of joints whose names differ only by a number."""
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+|[^\W\d_A-Za-z]+")


def joint_id(name: str) -> str:
    """Return the id of a joint's row."""
    return f"{ID_PREFIX}{name}"


def joint_rows(
    joints: JointState, move: Callable[[Joint, float], object]
) -> Iterator[Row]:
    """Yield the rows of all joints, in groups if they are many.

    Args:
        joints: the joints, and where they are.
        move: called with a joint that is set, and its position [rad or m].
    """
    for group in joint_groups(joints.sliders):
        parent = ""
        if group.label:
            parent = f"joints/group/{group.names[0]}"
            label = f"{group.label} ({len(group.names)})"
            yield Row(parent, "", "group", label, expanded=True)
        for name in group.names:
            yield _slider(joints.joints[name], joints.positions[name], parent, move)
    yield from _followers(joints)
    yield from _skipped(joints)


def _slider(
    joint: Joint,
    position: float,
    parent: str,
    move: Callable[[Joint, float], object],
) -> Row:
    lower, upper = sorted(joint.range)
    return Row(
        joint_id(joint.name),
        parent,
        "slider",
        joint.name,
        value=position,
        unit=_unit(joint),
        least=lower,
        most=upper,
        step=_step(joint),
        help=_help(joint),
        extra={"wheel": True} if joint.endless else None,
        set=lambda value: move(joint, value),
    )


def _followers(joints: JointState) -> Iterator[Row]:
    """Yield the joints that follow others; they can only be read."""
    followers = joints.followers
    if not followers:
        return
    positions = joints.all_positions()
    name = f"Follow other joints ({len(followers)})"
    yield Row(FOLLOWERS, "", "group", name, expanded=len(followers) <= _FEW)
    for name, follower in followers.items():
        joint, mimic = joints.joints[name], follower.mimic
        lower, upper = sorted(joint.range) if joint.limit is not None else (None, None)
        yield Row(
            joint_id(name),
            FOLLOWERS,
            "slider",
            name,
            value=positions[name],
            unit=_unit(joint),
            least=lower,
            most=upper,
            help=_help(joint),
            extra={
                "follows": joint_id(mimic.joint),
                "times": mimic.multiplier,
                "plus": mimic.offset,
            },
        )


def _skipped(joints: JointState) -> Iterator[Row]:
    """Yield the joints without a position that a user may look for, and why."""
    skipped = {
        n: why for n, why in joints.skipped.items() if not why.startswith("fixed")
    }
    if not skipped:
        return
    name = f"Without a position ({len(skipped)})"
    yield Row(SKIPPED, "", "group", name, expanded=len(skipped) <= _FEW)
    for name, why in skipped.items():
        yield Row(f"joints/skipped/{name}", SKIPPED, "readonly", name, why)


def _unit(joint: Joint) -> str:
    return "m" if joint.type == "prismatic" else "rad"


def _step(joint: Joint) -> float:
    """Return a round step: 0.01 rad, 1 mm, or less for a joint with a short range."""
    lower, upper = sorted(joint.range)
    step = STEP_LENGTH if joint.type == "prismatic" else STEP_ANGLE
    while upper - lower < FEWEST_STEPS * step and step > 1e-6:
        step /= 10
    return step


def _help(joint: Joint) -> str:
    return f"{joint.type} joint, {joint.parent} → {joint.child}"


@dataclass(frozen=True, slots=True)
class JointGroup:
    """Some joints of a robot.

    Attributes:
        label: what their names have in common; empty for a joint without a group.
        names: the joints, in the order of the robot.
    """

    label: str
    names: tuple[str, ...]


def joint_groups(names: Sequence[str]) -> list[JointGroup]:
    """Divide joints into groups, such as "arm_left", "arm_right" and "leg".

    Args:
        names: the joints, in the order of the robot.

    Returns:
        All joints, each in one group; a single group without a label if they are few,
        or if their names have nothing in common. With several robots each further one
        has separate groups: the names of its joints begin with its name and a slash.
    """
    robots: dict[str, list[str]] = {}
    for name in names:
        robots.setdefault(name.rpartition("/")[0], []).append(name)
    if len(robots) < 2:
        return _of_one_robot("", names)
    return [
        group for robot, own in robots.items() for group in _of_one_robot(robot, own)
    ]


def _of_one_robot(robot: str, names: Sequence[str]) -> list[JointGroup]:
    if len(names) <= UNGROUPED:
        return [JointGroup(robot, tuple(names))]
    words = {name: [*_WORD.finditer(name)] for name in names}
    return [*_groups(words, 0)]


def _groups(words: dict[str, list[re.Match[str]]], depth: int) -> Iterator[JointGroup]:
    """Divide joints whose names have the same `depth` first words."""
    names = list(words)
    parts = _parts(words, depth)
    while len(parts) == 1 and len(names) > 1 and _word(words[names[0]], depth):
        depth += 1
        parts = _parts(words, depth)
    label = names[0][: words[names[0]][depth - 1].end()] if depth else ""
    if len(names) <= LARGEST_GROUP or len(parts) == 1:
        yield JointGroup(label if len(names) > 1 else "", tuple(names))
    elif len(parts) > len(names) / 2:
        yield from _runs(tuple(names), label)
    else:
        for part in parts.values():
            yield from _groups(part, depth + 1)


def _parts(
    words: dict[str, list[re.Match[str]]], depth: int
) -> dict[str, dict[str, list[re.Match[str]]]]:
    parts: dict[str, dict[str, list[re.Match[str]]]] = {}
    for name, found in words.items():
        parts.setdefault(_word(found, depth), {})[name] = found
    return parts


def _word(words: list[re.Match[str]], depth: int) -> str:
    return words[depth].group().lower() if depth < len(words) else ""


def _runs(names: tuple[str, ...], label: str) -> Iterator[JointGroup]:
    """Divide a long list into equal parts."""
    if len(names) <= UNGROUPED:
        yield JointGroup(label, names)
        return
    for at in range(0, len(names), _RUN):
        run = names[at : at + _RUN]
        yield JointGroup(f"{run[0]} … {run[-1]}", run)

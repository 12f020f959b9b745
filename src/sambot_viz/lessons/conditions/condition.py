"""What all conditions have in common."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from sambot_viz.checks.rule import number
from sambot_viz.errors import Place, Problem, nearest
from sambot_viz.geometry import PlainPose, Vector3
from sambot_viz.lessons.work import Work
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint, Link

LENGTH, ANGLE = 0.001, 0.5
"""How far a length [m] and an angle [degrees] may be off, if no condition says it."""

_MEANT = re.compile(r"[;,]? ?\(?did you mean [^?]*\?\)?")


@dataclass(frozen=True, slots=True)
class Unmet:
    """One thing that does not hold.

    Attributes:
        found: what there is.
        expected: what there has to be.
        place: where it is written, if that is known.
    """

    found: str
    expected: str
    place: Place | None = None


class UnmetError(Exception):
    """What a condition asks about is not there.

    Attributes:
        unmet: what is said about it.
    """

    def __init__(self, unmet: Unmet) -> None:
        super().__init__(unmet.found)
        self.unmet = unmet


class Condition(Protocol):
    """Something that has to hold."""

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Give what does not hold.

        Raises:
            UnmetError: what it is about is not there.
            RobotError: the model cannot be read.
        """
        ...


def of_problem(problem: Problem, expected: str, before: str = "") -> Unmet:
    """Say what a problem says, without what was meant, which is the answer.

    Args:
        problem: the problem.
        expected: what there has to be.
        before: the first words.
    """
    where = f"{problem.place}: " if problem.place else ""
    place = None
    if problem.file is not None and problem.line is not None:
        place = Place(problem.file, problem.line, problem.column)
    return Unmet(f"{before}{where}{_MEANT.sub('', problem.message)}", expected, place)


def link_of(robot: Robot, name: str) -> Link:
    """Return a link.

    Raises:
        UnmetError: there is none of this name.
    """
    if name not in robot.links:
        raise UnmetError(_no("link", name, robot.links))
    return robot.links[name]


def joint_of(robot: Robot, name: str) -> Joint:
    """Return a joint.

    Raises:
        UnmetError: there is none of this name.
    """
    if name not in robot.joints:
        raise UnmetError(_no("joint", name, robot.joints))
    return robot.joints[name]


def _no(kind: str, name: str, known: Iterable[str]) -> Unmet:
    near = nearest(name, known)
    like = f", but there is '{near}'" if near else ""
    return Unmet(f"there is no {kind} '{name}'{like}", f"a {kind} '{name}'")


def vector(values: Sequence[float]) -> str:
    """Write a vector as URDF has it: "0.1 0 0.2"."""
    return " ".join(number(0.0 if abs(v) < 5e-7 else v) for v in values)


def far(one: Vector3, other: Vector3) -> float:
    """Return the distance of two points [m]."""
    return math.dist(one, other)


def between_rotations(one: PlainPose, other: PlainPose) -> float:
    """Return the angle by which two poses are turned to each other [degrees]."""
    x, y, z, _ = (one.inverse() @ other).xyzw
    return math.degrees(2.0 * math.asin(min(1.0, math.hypot(x, y, z))))


def pose_in(robot: Robot, frame: str, link: str) -> PlainPose:
    """Return T_frame_link, where all joints have their start values.

    Raises:
        UnmetError: there is no such link.
    """
    names = (link_of(robot, frame).name, link_of(robot, link).name)
    T_root_frame, T_root_link = (robot.at_start[name] for name in names)
    return T_root_frame.inverse() @ T_root_link

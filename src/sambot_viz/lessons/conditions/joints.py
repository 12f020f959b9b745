"""Conditions about links, joints and where they are."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import get_args

from sambot_viz.checks.rule import number
from sambot_viz.geometry import ORIGIN, PlainPose, Vector3, dot
from sambot_viz.lessons.conditions.condition import (
    ANGLE,
    LENGTH,
    Unmet,
    between_rotations,
    far,
    joint_of,
    link_of,
    pose_in,
    vector,
)
from sambot_viz.lessons.reading.records import given
from sambot_viz.lessons.reading.values import (
    FLAG,
    NUMBER,
    TEXT,
    TEXTS,
    VECTOR,
    some_of,
)
from sambot_viz.lessons.work import Work
from sambot_viz.robot.parts import Joint, JointType, Origin

_STRAIGHT = 0.9999
"""Directions are the same when their cosine is above it (0.8 degrees)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotCondition:
    """The model can be read, and has a name and a root link."""

    name: str = given(TEXT, "")
    root: str = given(TEXT, "")

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Compare the name and the root link."""
        robot = work.robot
        for what, is_, wanted in (
            ("robot", robot.name, self.name),
            ("root link", robot.root, self.root),
        ):
            if wanted and is_ != wanted:
                yield Unmet(f"the {what} is called '{is_}'", f"'{wanted}'")


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkCondition:
    """Links are there, with or without shapes and masses."""

    name: tuple[str, ...] = given(TEXTS)
    visual: bool | None = given(FLAG, None)
    inertial: bool | None = given(FLAG, None)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Look for each link."""
        for name in self.name:
            link = link_of(work.robot, name)
            for what, there, wanted in (
                ("<visual>", bool(link.visuals), self.visual),
                ("<inertial>", link.inertial is not None, self.inertial),
            ):
                if wanted is not None and there != wanted:
                    has, should = ("no", "one") if wanted else ("a", "none")
                    yield Unmet(f"{name} has {has} {what}", should, link.place)


@dataclass(frozen=True, slots=True, kw_only=True)
class JointCondition:
    """A joint is there, and is as it is described.

    `axis` is a direction, `along` the same or its opposite; a revolute joint without
    ends counts as continuous too.
    """

    name: str = given(TEXT)
    type: tuple[str, ...] = given(some_of(*get_args(JointType)), ())
    parent: str = given(TEXT, "")
    child: str = given(TEXT, "")
    xyz: Vector3 | None = given(VECTOR, None)
    rpy: Vector3 | None = given(VECTOR, None)
    axis: Vector3 | None = given(VECTOR, None)
    along: Vector3 | None = given(VECTOR, None)
    lower: float | None = given(NUMBER, None)
    upper: float | None = given(NUMBER, None)
    effort: float | None = given(NUMBER, None)
    velocity: float | None = given(NUMBER, None)
    tolerance: float = given(NUMBER, LENGTH)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Compare all that is given."""
        joint = joint_of(work.robot, self.name)
        for found, expected in (
            *self._kind(joint),
            *self._ends(joint),
            *self._origin(joint),
            *self._axis(joint),
            *self._limits(joint),
        ):
            yield Unmet(found, expected, joint.place)

    def _kind(self, joint: Joint) -> Iterator[tuple[str, str]]:
        # A wheel of SDF may be revolute without an end, which is the same.
        names = {joint.type, "continuous"} if joint.endless else {joint.type}
        if self.type and names.isdisjoint(self.type):
            yield f"{joint.name} is {joint.type}", " or ".join(self.type)

    def _ends(self, joint: Joint) -> Iterator[tuple[str, str]]:
        for what, is_, wanted in (
            ("parent", joint.parent, self.parent),
            ("child", joint.child, self.child),
        ):
            if wanted and is_ != wanted:
                yield f"the {what} of {joint.name} is {is_}", wanted

    def _origin(self, joint: Joint) -> Iterator[tuple[str, str]]:
        wanted = (self.xyz or joint.origin.xyz, self.rpy or joint.origin.rpy)
        yield from _apart(
            f"the origin of {joint.name}",
            joint.origin.pose,
            Origin(*wanted).pose,
            self.tolerance,
        )

    def _axis(self, joint: Joint) -> Iterator[tuple[str, str]]:
        for wanted, both_ways in ((self.axis, False), (self.along, True)):
            if wanted is None:
                continue
            length = dot(wanted, wanted) ** 0.5 or 1.0
            cosine = dot(joint.axis, wanted) / length
            if (abs(cosine) if both_ways else cosine) < _STRAIGHT:
                found = f"the axis of {joint.name} is {vector(joint.axis)}"
                yield found, vector(wanted) + (" or its opposite" * both_ways)

    def _limits(self, joint: Joint) -> Iterator[tuple[str, str]]:
        for what in ("lower", "upper", "effort", "velocity"):
            wanted: float | None = getattr(self, what)
            if wanted is None:
                continue
            if joint.limit is None:
                yield f"{joint.name} has no <limit>", f"{what} {number(wanted)}"
                return
            is_: float = getattr(joint.limit, what)
            if abs(is_ - wanted) > max(self.tolerance, 1e-6 * abs(wanted)):
                yield f"{what} of {joint.name} is {number(is_)}", number(wanted)


@dataclass(frozen=True, slots=True, kw_only=True)
class TransformCondition:
    """A frame is where it has to be in another one; angles in radians as in URDF."""

    parent: str = given(TEXT, key="from")
    child: str = given(TEXT, key="to")
    xyz: Vector3 | None = given(VECTOR, None)
    rpy: Vector3 | None = given(VECTOR, None)
    tolerance: float = given(NUMBER, LENGTH)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Compare the pose at the start values of all joints."""
        pose = pose_in(work.robot, self.parent, self.child)
        wanted = PlainPose(
            pose.xyzw if self.rpy is None else Origin(ORIGIN, self.rpy).pose.xyzw,
            self.xyz or pose.position,
        )
        place = work.robot.links[self.child].place
        what = f"{self.child}, seen from {self.parent},"
        for found, expected in _apart(what, pose, wanted, self.tolerance):
            yield Unmet(found, expected, place)


@dataclass(frozen=True, slots=True, kw_only=True)
class BetweenCondition:
    """The way from a frame up to another one leads through some frames, in order."""

    parent: str = given(TEXT, key="from")
    child: str = given(TEXT, key="to")
    frames: tuple[str, ...] = given(TEXTS)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Follow the parents of the child."""
        robot = work.robot
        above = {joint.child: joint.parent for joint in robot.joints.values()}
        link_of(robot, self.parent)
        way = [link_of(robot, self.child).name]
        while way[-1] != self.parent and way[-1] in above:
            way.append(above[way[-1]])
        chain = " → ".join(reversed(way))
        if way[-1] != self.parent:
            yield Unmet(f"{self.child} hangs at {chain}", f"below {self.parent}")
            return
        inner = [name for name in reversed(way[1:-1]) if name in self.frames]
        if inner != [*self.frames]:
            expected = f"{', '.join(self.frames)} between both"
            yield Unmet(f"the frames are {chain}", expected)


def _apart(
    what: str, is_: PlainPose, wanted: PlainPose, tolerance: float
) -> Iterator[tuple[str, str]]:
    """Say how far a pose is off."""
    off = far(is_.position, wanted.position)
    if off > tolerance:
        yield (
            f"{what} is at {vector(is_.position)}, which is {number(1000 * off)} mm "
            "off",
            f"at {vector(wanted.position)}",
        )
    turned = between_rotations(is_, wanted)
    if turned > ANGLE:
        yield f"{what} is turned by {number(turned)}° too much", "without this turn"

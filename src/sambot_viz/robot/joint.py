"""A joint as data: what a URDF says, in urdfdom's reading."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

from sambot_viz.errors import Place
from sambot_viz.geometry import Vector3
from sambot_viz.robot.origin import Origin

JointType = Literal[
    "revolute", "continuous", "prismatic", "fixed", "floating", "planar"
]
MOVABLE_TYPES: frozenset[str] = frozenset({"revolute", "continuous", "prismatic"})
"""The joint types that joint_state_publisher drives."""


@dataclass(frozen=True, slots=True)
class Limit:
    """Joint limit: lower and upper [rad or m], effort [N m or N], velocity [1/s]."""

    lower: float = 0.0
    upper: float = 0.0
    effort: float = 0.0
    velocity: float = 0.0
    place: Place | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class SoftLimit:
    """The soft limits of <safety_controller>; None where not given."""

    lower: float | None = None
    upper: float | None = None


@dataclass(frozen=True, slots=True)
class Mimic:
    """position = multiplier · position of `joint` + offset."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint between two links.

    Attributes:
        name: the joint's name.
        type: one of `JointType`.
        parent: name of the parent link.
        child: name of the child link.
        origin: pose of the joint frame in the parent link (T_parent_joint).
        axis: unit vector in the joint frame; (0, 0, 0) when the file gives no
            direction (the joint then cannot move).
        limit: None when the file has no <limit>.
        soft_limit: soft limits, or None.
        mimic: the joint it follows, or None.
        place: where the element is.
    """

    name: str
    type: JointType
    parent: str
    child: str
    origin: Origin = field(default_factory=Origin)
    axis: Vector3 = (1.0, 0.0, 0.0)
    limit: Limit | None = None
    soft_limit: SoftLimit | None = None
    mimic: Mimic | None = None
    place: Place | None = field(default=None, compare=False)

    @property
    def movable(self) -> bool:
        """True when a position moves it (revolute, continuous, prismatic)."""
        return self.type in MOVABLE_TYPES

    @property
    def range(self) -> tuple[float, float]:
        """Lower and upper position [rad or m], as joint_state_publisher takes them.

        Continuous joints have −π … π whatever the file says; soft limits narrow the
        range.
        """
        if self.type == "continuous":
            return (-math.pi, math.pi)
        limit = self.limit or Limit()
        lower, upper = limit.lower, limit.upper
        if self.soft_limit is not None:
            if self.soft_limit.lower is not None:
                lower = max(lower, self.soft_limit.lower)
            if self.soft_limit.upper is not None:
                upper = min(upper, self.soft_limit.upper)
        return (lower, upper)

    @property
    def start(self) -> float:
        """The start position [rad or m]: 0, or the middle of a range without 0.

        The rule is joint_state_publisher's.
        """
        lower, upper = self.range
        return (lower + upper) / 2 if lower > 0 or upper < 0 else 0.0

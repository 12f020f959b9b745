"""The messages to a robot, as RViz's tools send them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from sambot_viz.errors import PublishError, UsageError

if TYPE_CHECKING:
    from typing_extensions import Self

Kind = Literal["goal", "pose", "point", "drive", "joints", "markers", "description"]
KINDS: tuple[Kind, ...] = (
    "goal",
    "pose",
    "point",
    "drive",
    "joints",
    "markers",
    "description",
)
"""What may be allowed: goals, estimates of the pose, points, velocities, joints, what
is done with interactive markers, and the model when it is saved."""
MAP = "map"
"""The frame in which Nav2 plans and AMCL localizes, as they come."""
GOAL_TOPIC = "/goal_pose"
"""Where Nav2 takes goals, and RViz sends them."""
COVARIANCE = (0.25, 0.25, (math.pi / 12.0) ** 2)
"""Of x and y [m²] and of the heading [rad²] of an estimate, as RViz has them."""


@dataclass(frozen=True, slots=True)
class Outbound:
    """A message with a frame.

    Attributes:
        kind: what it is among `KINDS`.
        type_name: of the message.
        noun: what it is called in sentences.
        by_action: it is sent to Nav2's action where the robot shows that.
        frame: in which its place is given.

    Raises:
        PublishError: a number that is not finite, or no frame.
    """

    kind: ClassVar[Kind]
    type_name: ClassVar[str]
    noun: ClassVar[str]
    by_action: ClassVar[bool] = False
    frame: str

    def __post_init__(self) -> None:
        numbers = self.numbers
        if not all(map(math.isfinite, numbers)):
            raise PublishError(f"a {self.noun} needs finite numbers, not {numbers}")
        if not self.frame:
            raise PublishError(f"a {self.noun} needs a frame, such as {MAP}")

    @property
    def numbers(self) -> tuple[float, ...]:
        """Its numbers, in the order in which they are given."""
        raise NotImplementedError

    @property
    def told(self) -> Sequence[float] | dict[str, Any]:
        """The text for the list of sent messages."""
        return self.numbers

    def without(self, prefix: str) -> Self:
        """Return it with the name of its frame as at the robot, without a prefix."""
        inner = self.frame.removeprefix(f"{prefix}/")
        return replace(self, frame=inner) if prefix and inner else self

    def fields(self, stamp: object) -> dict[str, Any]:
        """Return the fields of the message.

        Args:
            stamp: its time, as the transport wants it (see `written.written`).
        """
        return {"header": {"stamp": stamp, "frame_id": self.frame}, **self.content()}

    def content(self) -> dict[str, Any]:
        """Return the fields after the header."""
        raise NotImplementedError

    @property
    def words(self) -> str:
        """The line that RViz logs when it sends one."""
        raise NotImplementedError


@dataclass(frozen=True, slots=True)
class GroundPose(Outbound):
    """A place on the ground, and a heading.

    Attributes:
        x: the place [m].
        y: the same.
        yaw: the heading about the vertical axis [rad].
    """

    x: float
    y: float
    yaw: float

    @property
    def numbers(self) -> tuple[float, ...]:
        """The place [m] and the heading [rad]."""
        return float(self.x), float(self.y), float(self.yaw)

    @property
    def orientation_zw(self) -> tuple[float, float]:
        """Components z and w of the unit quaternion of the heading; x and y are 0."""
        # RViz's own formula, so that the bytes are the same.
        half = math.cos(self.yaw / 2.0)
        z = math.sin(self.yaw) / (2.0 * half) if half else math.sin(self.yaw / 2.0)
        return z, half

    def pose(self) -> dict[str, Any]:
        """Return the fields of a geometry_msgs/Pose."""
        z, w = self.orientation_zw
        return {
            "position": {"x": float(self.x), "y": float(self.y), "z": 0.0},
            "orientation": {"x": 0.0, "y": 0.0, "z": z, "w": w},
        }

    @property
    def words(self) -> str:
        """The line that RViz logs when it sends one."""
        z, w = self.orientation_zw
        what = "estimate" if self.kind == "pose" else "goal"
        return (
            f"Setting {what} pose: Frame:{self.frame}, Position({self.x:g}, "
            f"{self.y:g}, 0), Orientation(0, 0, {z:g}, {w:g}) = Angle: {self.yaw:g}"
        )


@dataclass(frozen=True, slots=True)
class Goal(GroundPose):
    """Where a robot is to go, as of 2D Goal Pose."""

    kind = "goal"
    type_name = "geometry_msgs/msg/PoseStamped"
    noun = "goal"

    def content(self) -> dict[str, Any]:
        """Return the fields after the header."""
        return {"pose": self.pose()}


@dataclass(frozen=True, slots=True)
class NavGoal(Goal):
    """The same as of Nav2's own tool, which sends it to the action."""

    by_action = True


@dataclass(frozen=True, slots=True)
class PoseEstimate(GroundPose):
    """Where a robot is, as of 2D Pose Estimate.

    Attributes:
        covariance: of x and y [m²], and of the heading [rad²].
    """

    kind = "pose"
    type_name = "geometry_msgs/msg/PoseWithCovarianceStamped"
    noun = "pose estimate"
    covariance: tuple[float, float, float] = COVARIANCE

    @property
    def numbers(self) -> tuple[float, ...]:
        """The place [m], the heading [rad] and the covariance."""
        return float(self.x), float(self.y), float(self.yaw), *self.covariance

    def content(self) -> dict[str, Any]:
        """Return the fields after the header."""
        matrix = [0.0] * 36
        matrix[0], matrix[7], matrix[35] = self.covariance
        return {"pose": {"pose": self.pose(), "covariance": matrix}}


@dataclass(frozen=True, slots=True)
class ClickedPoint(Outbound):
    """A point, as of Publish Point.

    Attributes:
        x: the point [m].
        y: the same.
        z: the same.
    """

    kind = "point"
    type_name = "geometry_msgs/msg/PointStamped"
    noun = "point"
    x: float
    y: float
    z: float

    @property
    def numbers(self) -> tuple[float, ...]:
        """The point [m]."""
        return float(self.x), float(self.y), float(self.z)

    def content(self) -> dict[str, Any]:
        """Return the fields after the header."""
        x, y, z = self.numbers
        return {"point": {"x": x, "y": y, "z": z}}

    @property
    def words(self) -> str:
        """The text for the log."""
        x, y, z = self.numbers
        return f"Publishing point: Frame:{self.frame}, Position({x:g}, {y:g}, {z:g})"


def kinds_of(words: str) -> frozenset[Kind]:
    """Return what may be sent, by the names of its kinds; all for no name.

    Raises:
        UsageError: a name that is none.
    """
    names = [word.strip() for word in words.split(",") if word.strip()]
    for name in names:
        if name not in KINDS:
            raise UsageError(
                f"'{name}' cannot be sent; there are {', '.join(KINDS)}; a model is "
                "named before --publish"
            )
    return frozenset(kind for kind in KINDS if not names or kind in names)

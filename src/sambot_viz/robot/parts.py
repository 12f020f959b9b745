"""The parts of a robot: links with their shapes, and joints, in urdfdom's reading.

Lengths are in metres, angles in radians, masses in kilograms. `T_parent_child` maps
child coordinates to parent coordinates: ``p_parent = T_parent_child @ p_child``.
Comparison ignores places (file, line): the same robot written in two files is equal.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, NamedTuple

from sambot_viz.cached import cached_property
from sambot_viz.errors import Place
from sambot_viz.geometry import (
    Matrix,
    PlainPose,
    Rgba,
    Vector3,
    rotation_from_rpy,
    xyzw_from_rpy,
)

Language = Literal["urdf", "sdf"]
"""Language of a model."""


@dataclass(frozen=True)
class Origin:
    """A pose as URDF writes it: translation xyz [m], fixed-axis rpy [rad]."""

    xyz: Vector3 = (0.0, 0.0, 0.0)
    rpy: Vector3 = (0.0, 0.0, 0.0)
    place: Place | None = field(default=None, compare=False)

    @cached_property
    def matrix(self) -> Matrix:
        """The read-only (4, 4) transform, R = Rz(yaw) @ Ry(pitch) @ Rx(roll)."""
        # A model that is only checked needs no numpy, which takes long to import.
        import numpy as np

        T = np.eye(4)
        T[:3, :3] = rotation_from_rpy(*self.rpy)
        T[:3, 3] = self.xyz
        T.flags.writeable = False
        return T

    @property
    def pose(self) -> PlainPose:
        """The same transform as plain numbers."""
        return PlainPose(xyzw_from_rpy(*self.rpy), self.xyz)


@dataclass(frozen=True, slots=True)
class Box:
    """A box centred on its origin; full edge lengths [m]."""

    size: Vector3


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder along its z axis, centred on its origin [m]."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Sphere:
    """A sphere around its origin [m]."""

    radius: float


@dataclass(frozen=True, slots=True)
class Capsule:
    """A capsule along its z axis; `length` is the cylinder between the caps [m]."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class MeshFile:
    """A mesh file: the name as written, and the file that it refers to.

    Attributes:
        filename: name in the model ("package://…", relative, …).
        scale: factors along x, y, z; may be negative (mirrored).
        path: the file on this machine, or None if it is missing.
    """

    filename: str
    scale: Vector3 = (1.0, 1.0, 1.0)
    path: Path | None = field(default=None, compare=False)


Geometry = Box | Cylinder | Sphere | Capsule | MeshFile


def written_sizes(geometry: Geometry) -> tuple[float, ...]:
    """Return the numbers that define a shape [m]; for a mesh, its scale."""
    match geometry:
        case Box():
            return geometry.size
        case Sphere():
            return (geometry.radius,)
        case Cylinder() | Capsule():
            return geometry.radius, geometry.length
        case MeshFile():
            return geometry.scale


@dataclass(frozen=True, slots=True)
class Material:
    """A resolved material, as urdfdom passes it to RViz.

    Attributes:
        name: as written; may be empty.
        rgba: colour, each 0 to 1; None for a material with only a texture.
        texture: texture file name as written, or None.
        texture_path: the file on this machine, or None if it is missing.
    """

    name: str
    rgba: Rgba | None
    texture: str | None = None
    texture_path: Path | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Shape:
    """One <visual> or <collision>.

    Attributes:
        geometry: the geometry.
        origin: pose of the shape in its link (T_link_shape).
        material: None means RViz's default red. A collision has the visual's material,
            which RViz uses for it.
        name: the optional name attribute.
        place: place of the element.
        geometry_place: place of its <box>, <mesh>, …
    """

    geometry: Geometry
    origin: Origin = field(default_factory=Origin)
    material: Material | None = None
    name: str = ""
    place: Place | None = field(default=None, compare=False)
    geometry_place: Place | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Inertial:
    """Mass [kg], pose of the centre of mass (T_link_inertia), inertia [kg m²].

    Attributes:
        call: call of the macro that created it, or None.
    """

    mass: float
    origin: Origin
    ixx: float
    ixy: float
    ixz: float
    iyy: float
    iyz: float
    izz: float
    place: Place | None = field(default=None, compare=False)
    call: Place | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Link:
    """A link: its shapes in document order, and its inertia if it has one.

    Attributes:
        place: place of the element.
        call: call of the outermost macro that creates it.
    """

    name: str
    visuals: tuple[Shape, ...] = ()
    collisions: tuple[Shape, ...] = ()
    inertial: Inertial | None = None
    place: Place | None = field(default=None, compare=False)
    call: Place | None = field(default=None, compare=False)


JointType = Literal[
    "revolute", "continuous", "prismatic", "fixed", "floating", "planar"
]
MOVABLE_TYPES: frozenset[str] = frozenset({"revolute", "continuous", "prismatic"})
"""The joint types that joint_state_publisher drives."""
_NO_LIMIT = 1e16
"""Gazebo's notation for "no limit"."""


@dataclass(frozen=True, slots=True)
class Limit:
    """Joint limit: lower and upper [rad or m], effort [N m or N], velocity [1/s]."""

    lower: float = 0.0
    upper: float = 0.0
    effort: float = 0.0
    velocity: float = 0.0
    place: Place | None = field(default=None, compare=False)

    @property
    def ends(self) -> tuple[float | None, float | None]:
        """Lower and upper [rad or m]; None where there is no end (1e16 and beyond)."""
        lower = self.lower if abs(self.lower) < _NO_LIMIT else None
        return lower, self.upper if abs(self.upper) < _NO_LIMIT else None


@dataclass(frozen=True, slots=True)
class SoftLimit:
    """The soft limits of <safety_controller>; None where not given."""

    lower: float | None = None
    upper: float | None = None


@dataclass(frozen=True, slots=True)
class Dynamics:
    """Resistance of a joint: damping [N m s/rad or N s/m], friction [N m or N]."""

    damping: float = 0.0
    friction: float = 0.0


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
        place: place of the element.
        dynamics: resistance of the joint, or None.
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
    dynamics: Dynamics | None = None

    @property
    def movable(self) -> bool:
        """True when a position moves it (revolute, continuous, prismatic)."""
        return self.type in MOVABLE_TYPES

    @property
    def endless(self) -> bool:
        """True for a wheel: it turns without end (continuous, or limits of ±inf)."""
        if self.type == "revolute" and self.limit is not None:
            return self.limit.ends == (None, None)
        return self.type == "continuous"

    @property
    def range(self) -> tuple[float, float]:
        """Lower and upper position [rad or m], in joint_state_publisher's reading.

        Continuous joints have −π … π whatever the file says; soft limits narrow the
        range. Other joints without an end in the file have the same range (prismatic:
        1 m); joint_state_publisher_gui fails on those.
        """
        if self.type == "continuous":
            return (-math.pi, math.pi)
        lower, upper = _closed(self.limit or Limit(), self.type)
        if self.soft_limit is not None:
            if self.soft_limit.lower is not None:
                lower = max(lower, self.soft_limit.lower)
            if self.soft_limit.upper is not None:
                upper = min(upper, self.soft_limit.upper)
        return (lower, upper)

    @property
    def start(self) -> float:
        """The start position [rad or m]: 0, or the middle of a range without 0.

        This is joint_state_publisher's rule.
        """
        lower, upper = self.range
        return (lower + upper) / 2 if lower > 0 or upper < 0 else 0.0


class RobotTree(NamedTuple):
    """The content of a document: name, root link, links and joints of its tree."""

    name: str
    root: str
    links: dict[str, Link]
    joints: dict[str, Joint]


def _closed(limit: Limit, kind: JointType) -> tuple[float, float]:
    """Return a range [rad or m] with both ends: a full turn, or two metres."""
    half = 1.0 if kind == "prismatic" else math.pi
    match limit.ends:
        case None, None:
            return -half, half
        case lower, None:
            return lower, half if lower < half else lower + half
        case None, upper:
            return -half if upper > -half else upper - half, upper
        case lower, upper:
            return lower, upper


@dataclass(frozen=True, slots=True)
class MimicChain:
    """A joint, the joint that it mimics, the joint that this one mimics, and so on.

    Attributes:
        joints: the chain, from the joint itself, each joint once.
        end: end of the chain: a joint that mimics none ("free"), a joint that mimics a
            missing joint ("unknown"), or a joint that mimics one in the chain
            ("ring").
    """

    joints: tuple[Joint, ...]
    end: Literal["free", "unknown", "ring"]

    @property
    def ring(self) -> tuple[Joint, ...]:
        """The joints that mimic each other in a ring; empty for other ends."""
        mimic = self.joints[-1].mimic
        if self.end != "ring" or mimic is None:
            return ()
        names = [joint.name for joint in self.joints]
        return self.joints[names.index(mimic.joint) :]


def mimic_chain(joint: Joint, joints: Mapping[str, Joint]) -> MimicChain:
    """Follow a joint's mimic elements to the end.

    Args:
        joint: start of the chain.
        joints: all joints of the robot, by name.
    """
    chain = {joint.name: joint}
    last = joint
    while last.mimic is not None:
        name = last.mimic.joint
        if name in chain:
            return MimicChain(tuple(chain.values()), "ring")
        if name not in joints:
            return MimicChain(tuple(chain.values()), "unknown")
        last = chain[name] = joints[name]
    return MimicChain(tuple(chain.values()), "free")

"""The robot as data: what a URDF says, in urdfdom's reading.

Lengths in metres, angles in radians, masses in kilograms. `T_parent_child` maps
child coordinates to parent coordinates: ``p_parent = T_parent_child @ p_child``.
Places (file, line) are carried along but do not take part in comparison: the same
robot written in two files is equal.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from sambot_viz.errors import Place, Problem
from sambot_viz.geometry import Matrix, Rgba, Vector3, rotation_from_rpy

if TYPE_CHECKING:
    import yourdfpy  # pyright: ignore[reportMissingTypeStubs]

JointType = Literal[
    "revolute", "continuous", "prismatic", "fixed", "floating", "planar"
]
MOVABLE_TYPES: frozenset[str] = frozenset({"revolute", "continuous", "prismatic"})
"""The joint types that joint_state_publisher drives."""


@dataclass(frozen=True)
class Origin:
    """A pose as URDF writes it: translation xyz [m], fixed-axis rpy [rad]."""

    xyz: Vector3 = (0.0, 0.0, 0.0)
    rpy: Vector3 = (0.0, 0.0, 0.0)
    place: Place | None = field(default=None, compare=False)

    @cached_property
    def matrix(self) -> Matrix:
        """The read-only (4, 4) transform, R = Rz(yaw) @ Ry(pitch) @ Rx(roll)."""
        T = np.eye(4)
        T[:3, :3] = rotation_from_rpy(*self.rpy)
        T[:3, 3] = self.xyz
        T.flags.writeable = False
        return T


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
    """A mesh file: the name as written, and the file it was found to be.

    Attributes:
        filename: as the model says ("package://…", relative, …).
        scale: factors along x, y, z; may be negative (mirrored).
        path: the file on this machine, or None when it was not found.
    """

    filename: str
    scale: Vector3 = (1.0, 1.0, 1.0)
    path: Path | None = field(default=None, compare=False)


Geometry = Box | Cylinder | Sphere | Capsule | MeshFile


@dataclass(frozen=True, slots=True)
class Material:
    """A resolved material: what urdfdom would hand to RViz.

    Attributes:
        name: as written; may be empty.
        rgba: colour, each 0 to 1; None when only a texture is given.
        texture: texture file name as written, or None.
        texture_path: the file on this machine, or None when it was not found.
    """

    name: str
    rgba: Rgba | None
    texture: str | None = None
    texture_path: Path | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Shape:
    """One <visual> or <collision>.

    Attributes:
        geometry: what is drawn.
        origin: pose of the shape in its link (T_link_shape).
        material: None means RViz's default red. For a collision it is the visual
            material, which RViz uses for it.
        name: the optional name attribute.
        place: where the element is.
        geometry_place: where its <box>, <mesh>, … is.
    """

    geometry: Geometry
    origin: Origin = field(default_factory=Origin)
    material: Material | None = None
    name: str = ""
    place: Place | None = field(default=None, compare=False)
    geometry_place: Place | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Inertial:
    """Mass [kg], pose of the centre of mass (T_link_inertia), inertia [kg m²]."""

    mass: float
    origin: Origin
    ixx: float
    ixy: float
    ixz: float
    iyy: float
    iyz: float
    izz: float
    place: Place | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Link:
    """A link: its shapes in document order, and its inertia if it has one."""

    name: str
    visuals: tuple[Shape, ...] = ()
    collisions: tuple[Shape, ...] = ()
    inertial: Inertial | None = None
    place: Place | None = field(default=None, compare=False)


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
        """Whether a position moves it (revolute, continuous, prismatic)."""
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


@dataclass(frozen=True)
class Robot:
    """A robot whose links form one tree.

    Attributes:
        name: the name attribute of <robot>.
        root: name of the root link.
        links: link name → Link, in document order.
        joints: joint name → Joint, in document order.
        problems: warnings and notes; errors only for things left out of the picture.
        urdf: the expanded and validated URDF text.
        files: every file that was read for it, the model first (for reload on save).
        file_roots: folders that its meshes and textures may be read from (resolved);
            None for a trusted model, whose files may be anywhere.
    """

    name: str
    root: str
    links: Mapping[str, Link]
    joints: Mapping[str, Joint]
    problems: tuple[Problem, ...] = field(default=(), compare=False)
    urdf: str = field(default="", compare=False, repr=False)
    files: tuple[Path, ...] = field(default=(), compare=False, repr=False)
    file_roots: tuple[Path, ...] | None = field(default=None, compare=False, repr=False)

    load_text: ClassVar[Callable[[str], Robot]]
    # Set by `load.py`, which knows this module.

    def forward_kinematics(
        self, positions: Mapping[str, float] | None = None
    ) -> dict[str, Matrix]:
        """Poses of all links in the root link.

        Args:
            positions: joint name → position [rad or m]. A joint that is not given
                stands at its start value; mimic joints follow unless given.

        Returns:
            Link name → (4, 4) float64, T_root_link. A link behind a floating joint
            is at the joint's origin (ROS publishes no transform for it).

        Raises:
            JointError: an unknown joint name, or a value that is not finite.
        """
        from sambot_viz.robot.kinematics import forward_kinematics

        return forward_kinematics(self, positions or {})

    def to_yourdfpy(self) -> yourdfpy.URDF:
        """The same robot as a `yourdfpy.URDF`, meshes not loaded."""
        from sambot_viz.robot.yourdfpy_bridge import to_yourdfpy

        return to_yourdfpy(self.urdf)

    @classmethod
    def from_yourdfpy(cls, urdf: yourdfpy.URDF) -> Robot:
        """The robot of a `yourdfpy.URDF`, with the mesh files that yourdfpy finds.

        Raises:
            RobotError: ROS would refuse the model.
        """
        from sambot_viz.robot.yourdfpy_bridge import text_of

        return cls.load_text(text_of(urdf))

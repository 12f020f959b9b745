"""The robot as data: what a URDF says, in urdfdom's reading.

Lengths in metres, angles in radians, masses in kilograms. `T_parent_child` maps
child coordinates to parent coordinates: ``p_parent = T_parent_child @ p_child``.
Places (file, line) are carried along but do not take part in comparison: the same
robot written in two files is equal.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sambot_viz.errors import Place, Problem
from sambot_viz.geometry import Matrix, Rgba, Vector3
from sambot_viz.robot.joint import Joint
from sambot_viz.robot.kinematics import Kinematics
from sambot_viz.robot.origin import Origin

if TYPE_CHECKING:
    import yourdfpy  # pyright: ignore[reportMissingTypeStubs]


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

    def forward_kinematics(
        self, positions: Mapping[str, float] | None = None
    ) -> dict[str, Matrix]:
        """Return the poses of all links in the root link.

        Args:
            positions: joint name → position [rad or m]. A joint that is not given
                has its start value; mimic joints follow unless given.

        A caller that asks more than once keeps a `Kinematics` instead.

        Returns:
            Link name → (4, 4) float64, T_root_link. A link behind a floating joint
            is at the joint's origin (ROS publishes no transform for it).

        Raises:
            JointError: an unknown joint name, or a value that is not finite.
        """
        return Kinematics(self).forward(positions or {})

    def to_yourdfpy(self) -> yourdfpy.URDF:
        """Return the same robot as a `yourdfpy.URDF`, meshes not loaded."""
        import yourdfpy  # pyright: ignore[reportMissingTypeStubs]

        # This text is validated: yourdfpy silently repairs broken ones.
        return yourdfpy.URDF.load(  # pyright: ignore[reportUnknownMemberType]
            io.BytesIO(self.urdf.encode()), build_scene_graph=True, load_meshes=False
        )

    @classmethod
    def from_yourdfpy(cls, urdf: yourdfpy.URDF) -> Robot:
        """Read the robot of a `yourdfpy.URDF`, with the mesh files that it finds.

        Raises:
            RobotError: ROS would refuse the model.
        """
        from sambot_viz.robot import load_robot

        untyped: Any = urdf
        return load_robot(untyped.write_xml_string().decode())

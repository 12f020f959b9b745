"""A robot, and the ways to load one: from a file, a text, or yourdfpy.

The loader is imported at its first use, so that the page appears before it.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from sambot_viz.cached import cached_property
from sambot_viz.errors import JointError, Problem
from sambot_viz.geometry import Matrix, PlainPose
from sambot_viz.meshes.asset import Asset
from sambot_viz.robot.joint_tree import start_poses
from sambot_viz.robot.parts import Joint, Language, Link, MeshFile, Shape
from sambot_viz.robot.xml.element import Element

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import yourdfpy  # pyright: ignore[reportMissingTypeStubs]

    from sambot_viz.meshes.mesh import Mesh
    from sambot_viz.robot.balance.balance import Balance
    from sambot_viz.robot.kinematics import Kinematics
    from sambot_viz.robot.model_source import OpenedModel, PathLike


Positions: TypeAlias = (
    "Mapping[str, float] | Sequence[float] | npt.NDArray[np.floating]"
)
"""Joint name → position [rad or m], or a vector in the order of the joints."""


@dataclass(frozen=True)
class Robot:
    """A robot whose links form one tree.

    Attributes:
        name: the name attribute of <robot>, or of the <model> of an SDF file.
        root: name of the root link.
        links: link name → Link, in document order.
        joints: joint name → Joint, in document order.
        problems: warnings and notes; errors only for parts missing from the picture.
        description: the expanded and validated text, as in /robot_description.
        files: all files of the model, the model file first (for reload on save).
        file_roots: folders from which its meshes and textures may come (resolved);
            None for a trusted model, whose files may be anywhere.
        language: language of the description.
        gazebo: its parts for Gazebo and ros2_control; see `gazebo_parts`.
        edited: loads the robot again with other texts of its files; see `load_robot`.
    """

    name: str
    root: str
    links: Mapping[str, Link]
    joints: Mapping[str, Joint]
    problems: tuple[Problem, ...] = field(default=(), compare=False)
    description: str = field(default="", compare=False, repr=False)
    files: tuple[Path, ...] = field(default=(), compare=False, repr=False)
    file_roots: tuple[Path, ...] | None = field(default=None, compare=False, repr=False)
    language: Language = field(default="urdf", compare=False, repr=False)
    gazebo: tuple[Element, ...] = field(default=(), compare=False, repr=False)
    edited: Callable[[Mapping[str, str]], Robot] | None = field(
        default=None, compare=False, repr=False
    )

    @cached_property
    def urdf(self) -> str:
        """The robot as URDF: its description, or ROS's translation of an SDF file."""
        if self.language == "urdf":
            return self.description
        from sambot_viz.robot.urdf.write_urdf import write_urdf

        return write_urdf(self.name, self.links, self.joints)

    @cached_property
    def kinematics(self) -> Kinematics:
        """The kinematics from positions to poses, prepared once."""
        from sambot_viz.robot.kinematics import Kinematics

        return Kinematics(self)

    @cached_property
    def at_start(self) -> Mapping[str, PlainPose]:
        """Link name → T_root_link with all joints at their start values.

        Equals `forward_kinematics` without positions, but needs no numpy.
        """
        return start_poses(self)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The joints that take a position, in document order: the order of vectors.

        The order omits fixed, floating, planar and mimic joints.
        """
        joints = self.joints.values()
        return tuple(j.name for j in joints if j.movable and j.mimic is None)

    def named_positions(self, positions: Positions) -> Mapping[str, float]:
        """Return positions by joint name.

        Args:
            positions: joint name → position [rad or m], or a vector in the order of
                `joint_names`.

        Raises:
            JointError: the vector has the wrong length.
        """
        if isinstance(positions, Mapping):
            return positions
        import numpy as np

        names, vector = self.joint_names, np.asarray(positions)
        if vector.shape != (len(names),):
            listed = ", ".join(names[:8]) + (", …" if len(names) > 8 else "")
            raise JointError(
                f"a vector of positions needs {len(names)} numbers, in the order of "
                f"joint_names ({listed}), not the shape {vector.shape}"
            )
        return dict(zip(names, vector.tolist(), strict=True))

    def forward_kinematics(
        self, positions: Positions | None = None
    ) -> dict[str, Matrix]:
        """Return the poses of all links in the root link.

        Args:
            positions: joint name → position [rad or m], or a vector in the order of
                `joint_names`. Other joints have their start values; mimic joints follow
                unless given.

        Returns:
            Link name → (4, 4) float64, T_root_link. A link below a floating joint is at
            the joint's origin (ROS publishes no transform for it).

        Raises:
            JointError: a joint name is unknown, a value is not finite, or a vector has
                the wrong length.
        """
        none: Mapping[str, float] = {}
        named = none if positions is None else self.named_positions(positions)
        return self.kinematics.forward(named)

    def balance(self, positions: Positions | None = None) -> Balance | None:
        """Weigh the robot, and find its support; this reads its mesh files.

        The ground is level in the root link, at the lowest point of the robot.

        Args:
            positions: as for `forward_kinematics`.

        Returns:
            Mass, centre of mass in the root link, and support polygon; `tipping` gives
            the tilt of the ground that the robot withstands. None where no link has a
            mass.

        Raises:
            JointError: as for `forward_kinematics`.
        """
        from sambot_viz.meshes.mesh import MeshError
        from sambot_viz.meshes.read_mesh import read_mesh
        from sambot_viz.robot.balance.balance import balance

        @cache
        def read(path: Path) -> Mesh | None:
            try:
                return read_mesh(path, roots=self.file_roots)
            except MeshError:
                return None

        def mesh_of(shape: MeshFile) -> Mesh | None:
            return None if shape.path is None else read(shape.path)

        poses = self.forward_kinematics(positions).items()
        placed = {link: PlainPose.of_matrix(T_root_link) for link, T_root_link in poses}
        return balance(self, placed, mesh_of)

    def to_yourdfpy(self) -> yourdfpy.URDF:
        """Return the same robot as a `yourdfpy.URDF`, meshes not loaded."""
        import yourdfpy  # pyright: ignore[reportMissingTypeStubs]

        # This text is validated: yourdfpy silently repairs broken texts.
        return yourdfpy.URDF.load(  # pyright: ignore[reportUnknownMemberType]
            io.BytesIO(self.urdf.encode()), build_scene_graph=True, load_meshes=False
        )

    @classmethod
    def from_yourdfpy(cls, urdf: yourdfpy.URDF) -> Robot:
        """Read the robot of a `yourdfpy.URDF`, with the mesh files that it finds.

        Raises:
            RobotError: ROS would refuse the model.
        """
        untyped: Any = urdf
        return load_robot(untyped.write_xml_string().decode())


def load_robot(
    model: PathLike | OpenedModel,
    *,
    xacro_args: Mapping[str, str] | None = None,
    package_path: Sequence[Path | str] = (),
    trusted: bool = True,
    edited: Mapping[str, str] | None = None,
) -> Robot:
    """Load a robot from a URDF, SDF or xacro file, or from text.

    The content, not the ending of the file name, decides about the language and xacro.

    Args:
        model: file, XML text, or result of `open_model`.
        xacro_args: values for ``xacro:arg``.
        package_path: package folders, folders that hold packages, or ``name=folder``.
        trusted: False for a model of unknown origin: xacro then evaluates without
            attribute access, nested code and files outside the model's folder.
        edited: absolute path of a file → text that replaces its content on disk.

    Returns:
        The robot as ROS would show it, lengths in metres, angles in radians;
        `Robot.problems` lists the warnings, and an error for each omitted part.

    Raises:
        RobotError: the file cannot be read, or ROS would refuse the model;
            `.problems` lists all problems, each with file, line and fix.
    """
    from sambot_viz.robot.load import load_model

    again = partial(
        load_robot,
        model,
        xacro_args=xacro_args,
        package_path=package_path,
        trusted=trusted,
    )
    loaded = load_model(model, xacro_args or {}, package_path, trusted, edited or {})
    before = edited or {}
    return Robot(*loaded, edited=lambda texts: again(edited={**before, **texts}))


def asset_of(shape: Shape, file_roots: tuple[Path, ...] | None = None) -> Asset | None:
    """Return the file of a shape; None when it needs none or the file is missing.

    Args:
        shape: a visual or a collision.
        file_roots: those of its robot.
    """
    if isinstance(shape.geometry, MeshFile):
        path = shape.geometry.path
        return None if path is None else Asset("mesh", path, file_roots)
    material = shape.material
    if material is None or material.texture_path is None:
        return None
    return Asset("texture", material.texture_path, file_roots)


def shapes_of(robot: Robot) -> Iterator[Shape]:
    """Yield all shapes of all links."""
    for link in robot.links.values():
        yield from link.visuals
        yield from link.collisions


def assets_of(robot: Robot) -> Iterator[Asset]:
    """Yield the files of all shapes; a file used twice comes twice."""
    for shape in shapes_of(robot):
        asset = asset_of(shape, robot.file_roots)
        if asset is not None:
            yield asset


def something_missing(robot: Robot) -> bool:
    """Return whether a mesh or a texture is missing on this machine."""
    for shape in shapes_of(robot):
        geometry, material = shape.geometry, shape.material
        if isinstance(geometry, MeshFile) and geometry.path is None:
            return True
        if material is not None and material.texture and material.texture_path is None:
            return True
    return False

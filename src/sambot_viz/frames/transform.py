"""A rigid transform, the pose of a child frame in a parent frame; their products."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Union

import numpy as np
import numpy.typing as npt

from sambot_viz.cached import cached_property
from sambot_viz.errors import FrameError
from sambot_viz.frames.frame_errors import TransformRefused
from sambot_viz.geometry import (
    Matrix,
    Vector3,
    Xyzw,
    rotation_from_xyzw,
    rpy_from_matrix,
    xyzw_from_matrix,
    xyzw_from_rpy,
    xyzw_product,
)
from sambot_viz.matrices import inverse_matrix
from sambot_viz.robot.parts import Origin

if TYPE_CHECKING:
    from typing_extensions import Self

Pose = Union["Transform", Sequence[float], Sequence[Sequence[float]], npt.NDArray[Any]]
"""A transform, a (4, 4) matrix, or a translation x, y, z [m]."""

_LENGTH_TOLERANCE = 0.01
"""tf2 refuses quaternions whose squared length differs from 1 by more."""


@dataclass(frozen=True, eq=False)
class Transform:
    """The pose of a child frame in a parent frame.

    It maps coordinates of the child to coordinates of the parent:
    ``p_parent = T.matrix @ p_child``. ``T_map_odom @ T_odom_base`` is T_map_base.

    Attributes:
        matrix: (4, 4) float64, read-only; T_parent_child, translation in metres.

    Raises:
        TransformRefused: a number that is not finite (TF_NAN_INPUT).
        FrameError: not of shape (4, 4), or not a rotation and translation.
    """

    matrix: Matrix

    def __post_init__(self) -> None:
        matrix = np.array(self.matrix, dtype=np.float64)
        if matrix.shape != (4, 4):
            raise FrameError(f"a transform needs shape (4, 4), not {matrix.shape}")
        if not np.isfinite(matrix).all():
            raise TransformRefused("TF_NAN_INPUT", "a number is not finite")
        rotation: Matrix = matrix[:3, :3]
        rigid = np.allclose(
            rotation @ np.transpose(rotation), np.eye(3), atol=_LENGTH_TOLERANCE
        )
        if not rigid or np.linalg.det(rotation) < 0 or any(matrix[3] != (0, 0, 0, 1)):
            raise FrameError("the matrix is not a rotation followed by a translation")
        matrix.flags.writeable = False
        object.__setattr__(self, "matrix", matrix)

    @classmethod
    def trusted(cls, matrix: Matrix, xyzw: Xyzw | None = None) -> Self:
        """Wrap a matrix that is known to be good, without copying or checking.

        Args:
            matrix: (4, 4) float64, T_parent_child; not to be changed afterwards.
            xyzw: the same rotation as a unit quaternion, when its sign matters.
        """
        self = object.__new__(cls)
        object.__setattr__(self, "matrix", matrix)
        if xyzw is not None:
            # This is where cached_property looks first.
            self.__dict__["rotation_xyzw"] = _read_only(xyzw)
        return self

    @classmethod
    def identity(cls) -> Transform:
        """Return the pose of a frame in itself."""
        return _IDENTITY

    @classmethod
    def from_xyz_rpy(
        cls, xyz: Sequence[float] = (0, 0, 0), rpy: Sequence[float] = (0, 0, 0)
    ) -> Transform:
        """Make one from a translation [m] and fixed-axis roll, pitch, yaw [rad].

        Args:
            xyz: where the child's origin is in the parent.
            rpy: R = Rz(yaw) @ Ry(pitch) @ Rx(roll), as in URDF.

        Raises:
            TransformRefused: a number that is not finite (TF_NAN_INPUT).
        """
        x, y, z = _finite(xyz, 3, "xyz")
        roll, pitch, yaw = _finite(rpy, 3, "rpy")
        matrix = Origin((x, y, z), (roll, pitch, yaw)).matrix
        return cls.trusted(matrix, xyzw_from_rpy(roll, pitch, yaw))

    @classmethod
    def of(cls, pose: Pose, rpy: Sequence[float] = (0, 0, 0)) -> Transform:
        """Make one from whatever describes a pose.

        Args:
            pose: a transform, a (4, 4) matrix, or a translation x, y, z [m].
            rpy: with a translation, roll, pitch and yaw about fixed axes [rad], or a
                quaternion (x, y, z, w).

        Raises:
            TransformRefused: as for the other ways to make one.
            FrameError: not of these shapes, or an angle beside a whole pose.
        """
        if isinstance(pose, Transform):
            array = pose.matrix
        else:
            try:
                array = np.asarray(pose, np.float64)
            except (TypeError, ValueError) as error:
                raise FrameError(f"{pose!r} is not a pose") from error
        if array.ndim != 2:
            make = cls.from_xyz_xyzw if len(rpy) == 4 else cls.from_xyz_rpy
            return make(array.tolist(), rpy)
        if any(rpy):
            raise FrameError("a transform or a matrix has its rotation already")
        return pose if isinstance(pose, Transform) else cls(array)

    @classmethod
    def from_xyz_xyzw(
        cls, xyz: Sequence[float], xyzw: Sequence[float] = (0, 0, 0, 1)
    ) -> Transform:
        """Make one from a translation [m] and a quaternion (x, y, z, w).

        Raises:
            TransformRefused: a number that is not finite (TF_NAN_INPUT), or a squared
                length more than 0.01 away from 1 (TF_DENORMALIZED_QUATERNION).
        """
        position = _finite(xyz, 3, "xyz")
        x, y, z, w = _finite(xyzw, 4, "xyzw")
        squared = x * x + y * y + z * z + w * w
        if abs(squared - 1.0) > _LENGTH_TOLERANCE:
            raise TransformRefused(
                "TF_DENORMALIZED_QUATERNION",
                f"the quaternion ({x:g}, {y:g}, {z:g}, {w:g}) has the length "
                f"{math.sqrt(squared):.4g}, and a rotation needs length 1",
            )
        matrix = np.eye(4)
        matrix[:3, :3] = rotation_from_xyzw((x, y, z, w))
        matrix[:3, 3] = position
        matrix.flags.writeable = False
        n = math.sqrt(squared)
        return cls.trusted(matrix, (x / n, y / n, z / n, w / n))

    @cached_property
    def translation(self) -> npt.NDArray[np.float64]:
        """The child's origin in the parent, (3,) [m], read-only."""
        return self.matrix[:3, 3]

    @cached_property
    def rotation_xyzw(self) -> npt.NDArray[np.float64]:
        """The unit quaternion (4,) as x, y, z, w, read-only.

        Of its two signs it has the one that tf2 shows: the given one, that of the half
        angles when made from rpy, or KDL's when made from a matrix (w positive when
        the trace is above 0, else the largest of x, y, z positive).
        """
        return _read_only(xyzw_from_matrix(self.matrix))

    @cached_property
    def rpy(self) -> Vector3:
        """Fixed-axis roll, pitch, yaw [rad], pitch within ±π/2.

        At a pitch of ±90° only roll − yaw (or roll + yaw) means anything: yaw is 0
        there and roll carries all of it.
        """
        return rpy_from_matrix(self.matrix)

    def inverse(self) -> Transform:
        """Return the pose of the parent in the child, T_child_parent."""
        return Transform.trusted(inverse_matrix(self.matrix))

    def __matmul__(self, other: Transform) -> Transform:
        """T_a_b @ T_b_c is T_a_c."""
        matrix = self.matrix @ other.matrix
        matrix.flags.writeable = False
        return Transform.trusted(matrix)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Transform):
            return NotImplemented
        return np.array_equal(self.matrix, other.matrix)

    def __hash__(self) -> int:
        # Adding 0 makes -0.0 into 0.0, so that equal transforms have equal hashes.
        return hash((self.matrix + 0.0).tobytes())

    def __repr__(self) -> str:
        # Adding 0 prints -0.0 as 0.
        xyz = ", ".join(f"{c + 0.0:g}" for c in self.matrix[:3, 3].tolist())
        rpy = ", ".join(f"{angle + 0.0:g}" for angle in self.rpy)
        return f"Transform(xyz=({xyz}), rpy=({rpy}))"


def _finite(values: Sequence[float], size: int, name: str) -> list[float]:
    numbers = [float(v) for v in values]
    if len(numbers) != size:
        raise FrameError(f"{name} needs {size} numbers, not {len(numbers)}")
    if not all(map(math.isfinite, numbers)):
        shown = ", ".join(f"{v:g}" for v in numbers)
        raise TransformRefused("TF_NAN_INPUT", f"{name} is ({shown})")
    return numbers


def _read_only(xyzw: Xyzw) -> npt.NDArray[np.float64]:
    array = np.array(xyzw, dtype=np.float64)
    array.flags.writeable = False
    return array


_IDENTITY = Transform(np.eye(4))


class _Seen(Transform):
    """A pose found along several edges, which its quaternion's sign depends on."""

    _below: tuple[Transform, ...]
    _above: tuple[Transform, ...]

    @cached_property
    def rotation_xyzw(self) -> npt.NDArray[np.float64]:
        # tf2 multiplies quaternions along the chain; only the sign of that product
        # is taken from there, the matrix has the better digits.
        product = _rotation(self._above)
        x, y, z, w = xyzw_product(
            (-product[0], -product[1], -product[2], product[3]), _rotation(self._below)
        )
        xyzw = np.array(xyzw_from_matrix(self.matrix))
        if np.dot(xyzw, (x, y, z, w)) < 0:
            xyzw = -xyzw
        xyzw.flags.writeable = False
        return xyzw


def _rotation(transforms: tuple[Transform, ...]) -> Xyzw:
    product: Xyzw = (0.0, 0.0, 0.0, 1.0)
    for transform in transforms:
        x, y, z, w = transform.rotation_xyzw.tolist()
        product = xyzw_product((x, y, z, w), product)
    return product


def compose(below: tuple[Transform, ...], above: tuple[Transform, ...]) -> Transform:
    """Return the pose of a source in a target, from their ways up to a common frame.

    Args:
        below: T_parent_child of each step from the source up.
        above: T_parent_child of each step from the target up.

    Returns:
        T_target_source.
    """
    matrix = _product(below)
    if above:
        matrix = inverse_matrix(_product(above)).dot(matrix)
    matrix.flags.writeable = False
    seen = _Seen.trusted(matrix)
    seen.__dict__.update(_below=below, _above=above)
    return seen


def _product(transforms: tuple[Transform, ...]) -> Matrix:
    """Return T_top_bottom of transforms that are given from the bottom to the top."""
    if not transforms:
        return Transform.identity().matrix
    matrix = transforms[-1].matrix
    for transform in transforms[-2::-1]:
        matrix = matrix.dot(transform.matrix)
    return matrix

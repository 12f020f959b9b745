"""Rotations and rigid transforms as numbers; the one place where they are converted.

Nothing here needs numpy, which takes longer to import than a model to check.

Quaternions say their order in their name: RViz and ROS write (x, y, z, w), viser wants
(w, x, y, z). `T_parent_child` is a (4, 4) float64 matrix that maps coordinates of the
child to coordinates of the parent: ``p_parent = T_parent_child @ p_child``.
"""

from __future__ import annotations

import math
import numbers
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, cast

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

Matrix: TypeAlias = "npt.NDArray[np.float64]"
Vector2 = tuple[float, float]
Vector3 = tuple[float, float, float]
Xyzw = tuple[float, float, float, float]
"""A rotation as ROS and RViz write it."""
Wxyz = tuple[float, float, float, float]
"""A rotation as viser wants it."""
IDENTITY: Wxyz = (1.0, 0.0, 0.0, 0.0)
"""The rotation that turns nothing."""
_GIMBAL_COSINE = 1e-9
"""Below this cosine of the pitch, roll and yaw turn about the same axis."""
SHORTEST = 1e-150
"""A quaternion that is not longer has no direction: its squares are 0."""
ORIGIN: Vector3 = (0.0, 0.0, 0.0)
UP: Vector3 = (0.0, 0.0, 1.0)
"""The z axis: away from the ground, and the middle line of a cylinder."""
Rgba = tuple[float, float, float, float]
"""A colour with its opacity, each 0 to 1."""


def finite(value: Any) -> float | None:
    """Return a value as a finite float, None when it is not one (text, bool, NaN).

    Arrays without dimensions are numbers too.
    """
    if type(value) is float:
        # Nearly all are, and each joint of each step is asked.
        return value if math.isfinite(value) else None
    if getattr(value, "ndim", None) == 0:
        value = value[()]
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        return None
    try:
        number = float(cast("float", value))
    except (TypeError, OverflowError):
        return None
    return number if math.isfinite(number) else None


def rotation_from_rpy(roll: float, pitch: float, yaw: float) -> list[list[float]]:
    """Return Rz(yaw) @ Ry(pitch) @ Rx(roll), (3, 3), as URDF means rpy [rad]."""
    cr, sr = math.cos(roll), math.sin(roll)
    cp, sp = math.cos(pitch), math.sin(pitch)
    cy, sy = math.cos(yaw), math.sin(yaw)
    return [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]


def rpy_from_matrix(T: Matrix) -> Vector3:
    """Return fixed-axis roll, pitch, yaw [rad] of a (4, 4) or (3, 3) matrix.

    Pitch is within ±π/2. At ±90° only roll − yaw (or roll + yaw) means anything: yaw
    is 0 there and roll carries all of it.
    """
    rows: list[list[float]] = T.tolist()
    (r00, r01, r02), (r10, r11, r12) = rows[0][:3], rows[1][:3]
    straight = math.hypot(r00, r10) < _GIMBAL_COSINE
    yaw = 0.0 if straight else math.atan2(r10, r00)
    # Turned back by yaw, so that pitch and roll make up for what yaw has lost.
    cy, sy = math.cos(yaw), math.sin(yaw)
    pitch = math.atan2(-rows[2][0], math.hypot(r00, r10))
    return (math.atan2(sy * r02 - cy * r12, cy * r11 - sy * r01), pitch, yaw)


def rotation_from_axis(axis: Vector3, angle: float) -> list[list[float]]:
    """Return the (3, 3) rotation by an angle [rad] about an axis of length 1."""
    x, y, z = axis
    c, s = math.cos(angle), math.sin(angle)
    k = 1.0 - c
    return [
        [c + k * x * x, k * x * y - s * z, k * x * z + s * y],
        [k * x * y + s * z, c + k * y * y, k * y * z - s * x],
        [k * x * z - s * y, k * y * z + s * x, c + k * z * z],
    ]


def rotation_from_xyzw(xyzw: Xyzw) -> list[list[float]]:
    """Return the (3, 3) rotation of a quaternion that need not be quite of length 1."""
    x, y, z, w = xyzw
    s = 2.0 / (x * x + y * y + z * z + w * w)
    return [
        [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
    ]


def xyzw_from_rpy(roll: float, pitch: float, yaw: float) -> Xyzw:
    """Return the quaternion (x, y, z, w) of fixed-axis angles [rad], tf2's setRPY."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def xyzw_product(a: Xyzw, b: Xyzw) -> Xyzw:
    """Return the rotation b followed by the rotation a, both (x, y, z, w)."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def xyzw_rotated(xyzw: Xyzw, vector: Vector3) -> Vector3:
    """Return a vector turned by a unit quaternion (x, y, z, w)."""
    qx, qy, qz, qw = xyzw
    x, y, z = vector
    tx = 2.0 * (qy * z - qz * y)
    ty = 2.0 * (qz * x - qx * z)
    tz = 2.0 * (qx * y - qy * x)
    return (
        x + qw * tx + qy * tz - qz * ty,
        y + qw * ty + qz * tx - qx * tz,
        z + qw * tz + qx * ty - qy * tx,
    )


def xyzw_from_matrix(matrix: Matrix) -> Xyzw:
    """Return the unit quaternion (x, y, z, w) of a (4, 4) transform, KDL's sign."""
    # Dividing by the largest of the four components keeps all digits.
    rows: list[list[float]] = matrix.tolist()
    trace = rows[0][0] + rows[1][1] + rows[2][2]
    if trace > 0:
        root = math.sqrt(trace + 1.0)
        s = 0.5 / root
        return (
            s * (rows[2][1] - rows[1][2]),
            s * (rows[0][2] - rows[2][0]),
            s * (rows[1][0] - rows[0][1]),
            0.5 * root,
        )
    i = max(range(3), key=lambda k: rows[k][k])
    j, k = (i + 1) % 3, (i + 2) % 3
    root = math.sqrt(rows[i][i] - rows[j][j] - rows[k][k] + 1.0)
    s = 0.5 / root
    xyzw = [0.0, 0.0, 0.0, s * (rows[k][j] - rows[j][k])]
    xyzw[i] = 0.5 * root
    xyzw[j] = s * (rows[j][i] + rows[i][j])
    xyzw[k] = s * (rows[k][i] + rows[i][k])
    return (xyzw[0], xyzw[1], xyzw[2], xyzw[3])


def wxyz_from_matrix(T: Matrix) -> Wxyz:
    """Return the unit quaternion (w, x, y, z) of a (4, 4) or (3, 3) matrix."""
    x, y, z, w = xyzw_from_matrix(T)
    return (w, x, y, z)


def unit_wxyz(wxyz: Sequence[float]) -> Wxyz:
    """Return a quaternion (w, x, y, z) with length 1; `IDENTITY` where it has none."""
    w, x, y, z = wxyz
    norm = math.hypot(w, x, y, z)
    if not SHORTEST < norm < math.inf:
        return IDENTITY
    return (w / norm, x / norm, y / norm, z / norm)


def wxyz_product(a: Wxyz, b: Wxyz) -> Wxyz:
    """Return the rotation b followed by the rotation a, both (w, x, y, z)."""
    x, y, z, w = xyzw_product((*a[1:], a[0]), (*b[1:], b[0]))
    return (w, x, y, z)


def wxyz_rotated(wxyz: Wxyz, vector: Vector3) -> Vector3:
    """Return a vector turned by a unit quaternion (w, x, y, z)."""
    return xyzw_rotated((*wxyz[1:], wxyz[0]), vector)


def wxyz_from_z(direction: Vector3) -> Wxyz:
    """Return the shortest rotation of +z into a direction (any length but 0)."""
    x, y, z = direction
    # Squares of the least and of the greatest numbers are none.
    norm = math.hypot(x, y, z)
    x, y, z = x / norm, y / norm, z / norm
    if z < -0.999999:
        # Every axis across z is right; this one is Ogre's, so RViz's.
        return (0.0, 0.0, 1.0, 0.0)
    w = 1.0 + z
    length = math.sqrt(w * w + x * x + y * y)
    return (w / length, -y / length, x / length, 0.0)


def dot(a: Vector3, b: Vector3) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector3, b: Vector3) -> Vector3:
    """Return the vector product."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


class PlainPose(NamedTuple):
    """A rigid transform as plain numbers, for the few of a model that is checked.

    ``p_parent = T_parent_child.of(p_child)``, and products are written with ``@``.

    Attributes:
        xyzw: the rotation, a unit quaternion.
        position: of the child's origin in the parent [m].
    """

    xyzw: Xyzw = (0.0, 0.0, 0.0, 1.0)
    position: Vector3 = ORIGIN

    @classmethod
    def of_matrix(cls, T: Matrix) -> PlainPose:
        """Return the same transform as a (4, 4) matrix."""
        x, y, z = T[:3, 3].tolist()
        return cls(xyzw_from_matrix(T), (x, y, z))

    def turned(self, direction: Vector3) -> Vector3:
        """Return a direction of the child in the parent."""
        return xyzw_rotated(self.xyzw, direction)

    def of(self, point: Vector3) -> Vector3:
        """Return a point of the child in the parent [m]."""
        x, y, z = xyzw_rotated(self.xyzw, point)
        px, py, pz = self.position
        return (x + px, y + py, z + pz)

    def __matmul__(self, inner: PlainPose) -> PlainPose:
        """Return T_a_c of T_a_b and T_b_c."""
        return PlainPose(xyzw_product(self.xyzw, inner.xyzw), self.of(inner.position))

    def inverse(self) -> PlainPose:
        """Return T_child_parent."""
        x, y, z, w = self.xyzw
        back = (-x, -y, -z, w)
        px, py, pz = xyzw_rotated(back, self.position)
        return PlainPose(back, (-px, -py, -pz))

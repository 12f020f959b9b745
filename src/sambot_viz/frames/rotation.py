"""Rotations as matrix, as quaternion (x, y, z, w) and as fixed-axis angles."""

from __future__ import annotations

import math

from sambot_viz.robot.model import Matrix

Quaternion = tuple[float, float, float, float]
"""A rotation as (x, y, z, w), the order of ROS and RViz."""


def rotation_matrix(xyzw: Quaternion) -> list[list[float]]:
    """The (3, 3) rotation of a quaternion that need not be quite of length 1."""
    x, y, z, w = xyzw
    s = 2.0 / (x * x + y * y + z * z + w * w)
    return [
        [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
    ]


def quaternion_from_rpy(roll: float, pitch: float, yaw: float) -> Quaternion:
    """The unit quaternion (x, y, z, w) of fixed-axis angles [rad], tf2's setRPY."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def quaternion_product(a: Quaternion, b: Quaternion) -> Quaternion:
    """The rotation b followed by the rotation a, both (x, y, z, w)."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def quaternion_from_matrix(matrix: Matrix) -> Quaternion:
    """The unit quaternion (x, y, z, w) of a (4, 4) transform, with KDL's sign."""
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

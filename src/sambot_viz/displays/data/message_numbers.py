"""Numbers of messages: those that cannot be drawn are refused, as RViz refuses them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz import limits
from sambot_viz.displays.data.refused_messages import INVALID_FLOATS, MessageRefused
from sambot_viz.displays.data.topic_display import TOPIC
from sambot_viz.displays.scene.glb_node import single
from sambot_viz.frames import Transform
from sambot_viz.geometry import Vector3, Wxyz, unit_wxyz
from sambot_viz.matrices import matrix_from_wxyz, unit_wxyzs
from sambot_viz.meanings.schema_row import SENSOR_POSE
from sambot_viz.topics.decoding import numbers_of

Floats = npt.NDArray[np.float64]


def require_finite(values: Iterable[float]) -> None:
    """Refuse a message with a number that is NaN or infinite.

    Raises:
        MessageRefused: with RViz's sentence.
    """
    if not all(math.isfinite(value) for value in values):
        raise MessageRefused(INVALID_FLOATS, TOPIC)


def point_of(point: Any) -> Vector3:
    """Return a geometry_msgs/Point or Vector3 [m].

    Raises:
        MessageRefused: it is not finite.
    """
    found = (float(point.x), float(point.y), float(point.z))
    require_finite(found)
    return found


def vector_of(vector: Any, *, nan_is_zero: bool = False) -> Vector3:
    """Return a geometry_msgs/Vector3.

    Args:
        vector: of a message.
        nan_is_zero: whether numbers that are NaN count as 0.

    Raises:
        MessageRefused: it is not finite in the 32 bits that RViz keeps of it.
    """
    values = [float(vector.x), float(vector.y), float(vector.z)]
    if nan_is_zero:
        values = [0.0 if math.isnan(value) else value for value in values]
    require_finite(single(values).tolist())
    return (values[0], values[1], values[2])


def points_of(points: Any, path: str = "") -> Floats:
    """Return geometry_msgs/Points, (N, 3) [m].

    Args:
        points: an array of them, or of what has them.
        path: before the names of their fields, such as "pose.position.".

    Raises:
        MessageRefused: one is not finite, or there are too many.
    """
    require_few(len(points))
    return _finite(coordinates_of(points, path))


def coordinates_of(points: Any, path: str = "") -> Floats:
    """Return geometry_msgs/Points, (N, 3) [m], which need not be finite."""
    return numbers_of(points, *(path + axis for axis in "xyz"))


def _finite(numbers: Floats) -> Floats:
    if not np.isfinite(numbers).all():
        raise MessageRefused(INVALID_FLOATS, TOPIC)
    return numbers


def wxyz_of(quaternion: Any) -> Wxyz:
    """Return a geometry_msgs/Quaternion; without a length it does not turn.

    Raises:
        MessageRefused: it is not finite.
    """
    found = (
        float(quaternion.w),
        float(quaternion.x),
        float(quaternion.y),
        float(quaternion.z),
    )
    require_finite(found)
    return unit_wxyz(found)


def at_sensor(T_fixed_frame: Transform, message: Any) -> Transform:
    """Return where the sensor of a message is: in its frame it may have a pose.

    Args:
        T_fixed_frame: where its frame is.
        message: of ROS, where the sensor is its frame, or of a schema with a pose.

    Raises:
        MessageRefused: that is not finite.
    """
    pose = getattr(message, SENSOR_POSE, None)
    if pose is None:
        return T_fixed_frame
    matrix = matrix_from_wxyz(wxyz_of(pose.orientation), point_of(pose.position))
    return T_fixed_frame @ Transform.trusted(matrix)


def poses_of(poses: Any, path: str = "") -> tuple[Floats, Floats]:
    """Return the rotations w, x, y, z, (N, 4), and positions, (N, 3) [m], of poses.

    Args:
        poses: an array of them, or of what has them.
        path: before the names of their fields, such as "pose.".

    Raises:
        MessageRefused: one is not finite, or there are too many.
    """
    turns, places = given_poses(poses, path)
    return unit_wxyzs(turns), places


def given_poses(poses: Any, path: str = "") -> tuple[Floats, Floats]:
    """Return poses as `poses_of` does, with rotations of any length, as they came."""
    require_few(len(poses))
    turns = (f"{path}orientation.{one}" for one in "wxyz")
    places = (f"{path}position.{one}" for one in "xyz")
    numbers = _finite(numbers_of(poses, *turns, *places))
    return numbers[:, :4], numbers[:, 4:]


def covariance_of(pose: Any) -> Floats:
    """Return the covariance of a PoseWithCovariance, (36,) [m², rad²].

    Raises:
        ValueError: it has another length.
    """
    return np.reshape(np.array(pose.covariance, np.float64), 36)


def require_few(count: int) -> None:
    """Refuse a message with more than can be drawn.

    Raises:
        MessageRefused: there are too many.
    """
    most = limits.MESSAGE_POSES.value
    if count > most:
        text = f"It has {count:,} points or poses: at most {most:,} are drawn"
        raise MessageRefused(text)

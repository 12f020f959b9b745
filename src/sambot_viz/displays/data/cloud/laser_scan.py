"""LaserScan: the readings of a laser scanner, each at the place of its measurement."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.data.cloud.cloud import Cloud, Values, finite_cloud
from sambot_viz.displays.data.cloud.cloud_display import CloudDisplay
from sambot_viz.displays.data.message_numbers import at_sensor
from sambot_viz.frames import Transform
from sambot_viz.geometry import Matrix
from sambot_viz.meanings import Meaning
from sambot_viz.topics.decoding import frame_and_stamp

SCAN_TIME = "Scan Time"
_LONG_SCAN_NS = 1_000_000_000
Floats = npt.NDArray[np.float64]


class LaserScanDisplay(CloudDisplay):
    """The readings of sensor_msgs/LaserScan.

    The scanner may move while it turns: each reading is drawn where it was then, in the
    fixed frame, as RViz does.
    """

    kind = "rviz_default_plugins/LaserScan"
    meanings = frozenset({Meaning.SCAN})
    in_fixed_frame = True

    def place(self, message: Any) -> Transform:
        """Return where the scanner was at the first reading, if the last is known."""
        self._end(message)
        return super().place(message)

    def cloud_of(self, message: Any, T_fixed_frame: Transform) -> tuple[Cloud, Matrix]:
        """Return the readings as points in the fixed frame."""
        points, kept = points_of_scan(message)
        count = len(np.asarray(message.ranges))
        ratio = kept / max(count - 1, 1)
        in_fixed = moved_points(points, ratio, T_fixed_frame, self._end(message))
        fields: dict[str, Values] = {}
        values = np.asarray(message.intensities, np.float32)
        if len(values) == count:
            fields["intensity"] = values[kept]
        return finite_cloud(in_fixed.astype(np.float32), fields), np.eye(4)

    def _end(self, message: Any) -> Transform:
        """Return where the scanner was at the last reading."""
        frame, stamp_ns = frame_and_stamp(message)
        tree, fixed = self.context.tree, self.context.fixed_frame
        if stamp_ns is None:
            return at_sensor(tree.lookup(fixed, frame, None), message)
        count = len(np.asarray(message.ranges))
        seconds = float(message.time_increment) * max(count - 1, 0)
        duration = round(seconds * 1e9) if np.isfinite(seconds) else 0
        if duration > _LONG_SCAN_NS:
            text = (
                f"The laser scan takes {seconds:.1f} s, so it is shown that much later"
            )
            self.status.set(SCAN_TIME, "Warn", text)
        else:
            self.status.remove(SCAN_TIME)
        end = tree.lookup(fixed, frame, stamp_ns + duration)
        return at_sensor(end, message)


def points_of_scan(message: Any) -> tuple[Floats, npt.NDArray[np.intp]]:
    """Return the readings of a sensor_msgs/LaserScan that are within its range.

    Returns:
        (N, 3) float64 [m] in the frame of the scanner, and (N,) their numbers.
    """
    ranges = np.asarray(message.ranges, np.float64)
    least, most = float(message.range_min), float(message.range_max)
    kept = np.flatnonzero((ranges >= least) & (ranges < most))
    angles = float(message.angle_min) + kept * float(message.angle_increment)
    r = ranges[kept]
    points = np.stack(
        [r * np.cos(angles), r * np.sin(angles), np.zeros_like(r)], axis=1
    )
    # Of angles that are not numbers come points that are none.
    finite = np.isfinite(points).all(axis=1)
    return points[finite], kept[finite]


def moved_points(
    points: Floats, ratio: Floats, T_begin: Transform, T_end: Transform
) -> Floats:
    """Place points that were measured while their frame moved evenly.

    Args:
        points: (N, 3) [m], in that frame.
        ratio: (N,) when each was measured: 0 at the beginning, 1 at the end.
        T_begin: the pose of the frame at the beginning.
        T_end: its pose at the end.

    Returns:
        (N, 3) [m].
    """
    T = T_begin.matrix
    if np.array_equal(T, T_end.matrix):
        return points @ np.transpose(T[:3, :3]) + T[:3, 3]
    t = ratio[:, None]
    at = T[:3, 3] * (1 - t) + T_end.matrix[:3, 3] * t
    xyzw = _slerp(np.array(T_begin.rotation_xyzw), np.array(T_end.rotation_xyzw), t)
    vector, w = xyzw[:, :3], xyzw[:, 3:]
    cross = 2 * np.cross(vector, points)
    return points + w * cross + np.cross(vector, cross) + at


def _slerp(begin: Floats, end: Floats, t: Floats) -> Floats:
    """Return the rotations between two, (N, 4); t is (N, 1)."""
    cosine = float(begin @ end)
    if cosine < 0:
        end, cosine = -end, -cosine
    angle = np.arccos(min(cosine, 1.0))
    if angle < 1e-6:
        between = begin * (1 - t) + end * t
    else:
        between = (np.sin((1 - t) * angle) * begin + np.sin(t * angle) * end) / np.sin(
            angle
        )
    return between / np.linalg.norm(between, axis=1, keepdims=True)

"""Fields of markers as numbers: poses, colours, points."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.data.message_numbers import coordinates_of
from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.frames import Transform
from sambot_viz.geometry import IDENTITY, Vector3, Wxyz, unit_wxyz, wxyz_product
from sambot_viz.meshes.glb import OPAQUE_FROM
from sambot_viz.topics.decoding import numbers_of


class MarkerPose:
    """The pose of the frame of markers in the fixed frame.

    Args:
        T_fixed_frame: that pose; None for markers that are drawn in their own frame.
    """

    __slots__ = ("_at", "_turn", "_wxyz")

    def __init__(self, T_fixed_frame: Transform | None = None) -> None:
        self._turn: list[list[float]] | None = None
        self._at: Vector3 = (0.0, 0.0, 0.0)
        self._wxyz: Wxyz = IDENTITY
        # In the fixed frame itself there is nothing to compute.
        if T_fixed_frame is not None and (T_fixed_frame.matrix != np.eye(4)).any():
            self._turn = T_fixed_frame.matrix[:3, :3].tolist()
            self._at = position_of(T_fixed_frame.matrix)
            x, y, z, w = T_fixed_frame.rotation_xyzw
            self._wxyz = (w, x, y, z)

    def __eq__(self, other: object) -> bool:
        """Whether it is the same pose."""
        return self is other or (
            isinstance(other, MarkerPose)
            and self._at == other._at
            and self._turn == other._turn
        )

    def of(self, pose: Any) -> tuple[Wxyz, Vector3]:
        """Return a geometry_msgs/Pose in the frame that it is drawn in."""
        p, q = pose.position, pose.orientation
        turn = unit_wxyz((q.w, q.x, q.y, q.z))
        if self._turn is None:
            return turn, (p.x, p.y, p.z)
        a, b, c = self._turn
        x, y, z = self._at
        at = (
            a[0] * p.x + a[1] * p.y + a[2] * p.z + x,
            b[0] * p.x + b[1] * p.y + b[2] * p.z + y,
            c[0] * p.x + c[1] * p.y + c[2] * p.z + z,
        )
        return wxyz_product(self._wxyz, turn), at


def rgb_of(color: Any) -> Rgb:
    """Return the colour of a std_msgs/ColorRGBA, 0 to 255."""
    return (_byte_of(color.r), _byte_of(color.g), _byte_of(color.b))


def _byte_of(channel: float) -> int:
    value = int(255.0 * channel + 0.5)
    return 0 if value < 0 else 255 if value > 255 else value


def alpha_of(color: Any) -> float:
    """Return the alpha of a std_msgs/ColorRGBA; 1 from where RViz draws it opaque."""
    return 1.0 if color.a >= OPAQUE_FROM else max(0.0, float(color.a))


def points_of(marker: Any) -> npt.NDArray[np.float32]:
    """Return the points of a marker, (N, 3) [m]."""
    with np.errstate(over="ignore"):
        return coordinates_of(marker.points).astype(np.float32)


def rgba_of(colors: Any) -> npt.NDArray[np.uint8]:
    """Return colours with alpha, (N, 4), 0 to 255."""
    scaled = np.nan_to_num(numbers_of(colors, *"rgba") * 255.0)
    return np.round(scaled.clip(0, 255)).astype(np.uint8)

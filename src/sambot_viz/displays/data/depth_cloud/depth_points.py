"""From the pixels of a depth image to points."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.data.cloud.cloud import Cloud, Points
from sambot_viz.displays.data.image.camera_info import CameraNumbers
from sambot_viz.displays.data.image.encodings import Bytes, Values

Depths = npt.NDArray[np.float32]
_MILLIMETRE = np.float32(0.001)


def metres_of(values: Values) -> Depths:
    """Return the depths of pixels, (H, W) [m]; NaN where there is none.

    Args:
        values: millimetres as whole numbers, where 0 is none, or metres.
    """
    if values.dtype == np.float32:
        return values.astype(np.float32, copy=False)
    metres = values.astype(np.float32) * _MILLIMETRE
    metres[values == 0] = np.nan
    return metres


def focus_of(camera: CameraNumbers) -> tuple[float, float]:
    """Return the focal lengths along x and y in pixels of the image that is sent."""
    return (
        camera.focus[0] / camera.binning[0],
        camera.focus[1] / camera.binning[1],
    )


def cloud_of_depth(depths: Depths, camera: CameraNumbers, colors: Bytes) -> Cloud:
    """Return the points of the pixels that have a depth.

    Args:
        depths: (H, W) [m], along the z axis of the camera.
        camera: its numbers.
        colors: (H, W, 3) RGB, or (3,) for all.
    """
    kept = np.isfinite(depths)
    rows, columns = np.nonzero(kept)
    z = depths[kept]
    (fx, fy), (x, y, _, _) = focus_of(camera), camera.roi
    cx = (camera.center[0] - x) / camera.binning[0]
    cy = (camera.center[1] - y) / camera.binning[1]
    points: Points = np.empty((len(z), 3), np.float32)
    with np.errstate(over="ignore", invalid="ignore"):
        points[:, 0] = (columns - cx) / fx * z
        points[:, 1] = (rows - cy) / fy * z
    points[:, 2] = z
    rgb: Any = np.broadcast_to(colors, (*depths.shape, 3))[kept].astype(np.uint32)
    packed = (rgb[:, 0] << 16) | (rgb[:, 1] << 8) | rgb[:, 2]
    return Cloud(points, {"rgb": packed.astype(np.uint32)})


class Occluded:
    """The farther points that something nearer covers, for some time.

    Each pixel remembers the farthest depth that it has seen: so the camera has to
    stand still, as in RViz.
    """

    def __init__(self) -> None:
        self._depths: Depths | None = None
        self._colors: Bytes = np.zeros(3, np.uint8)
        self._seen_ns: npt.NDArray[np.int64] = np.zeros(0, np.int64)

    def behind(
        self, depths: Depths, colors: Bytes, now_ns: int, longest_ns: int
    ) -> tuple[Depths, Bytes]:
        """Add an image, and return the earlier points that it occludes.

        Args:
            depths: (H, W) [m].
            colors: (H, W, 3) RGB, or (3,) for all.
            now_ns: the time of the image [ns].
            longest_ns: points that are occluded for longer are dropped [ns].

        Returns:
            Depths of occluded points, NaN elsewhere, and their colours.
        """
        rgb = np.broadcast_to(colors, (*depths.shape, 3))
        if self._depths is None or self._depths.shape != depths.shape:
            self._depths = np.array(depths)
            self._colors, self._seen_ns = np.array(rgb), np.full(depths.shape, now_ns)
        is_new = self._seen_ns < now_ns - longest_ns
        is_new |= ~(depths < self._depths)
        self._depths[is_new] = depths[is_new]
        self._colors[is_new] = rgb[is_new]
        self._seen_ns[is_new] = now_ns
        return np.where(is_new, np.float32(np.nan), self._depths), self._colors

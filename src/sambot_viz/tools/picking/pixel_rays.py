"""The picture that a browser shows: which ray belongs to which of its pixels."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import viser

from sambot_viz import limits
from sambot_viz.displays.picking.rays import Array, RayGrid
from sambot_viz.geometry import rotation_from_xyzw

MOST_PIXELS = 4_000_000
"""Of a rectangle with more pixels, only every second, third … is looked at."""

ScreenPoint = tuple[float, float]
"""From 0 (left, top) to 1 (right, bottom) of the picture."""


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """The picture of a browser's camera, in the fixed frame.

    Attributes:
        eye: position of the camera, (3,) [m].
        axes: right, down and forward as columns, (3, 3), each of length 1.
        half: tangent of half the vertical field of view.
        width: [pixels].
        height: [pixels].
    """

    eye: Array
    axes: Array
    half: float
    width: int
    height: int

    @classmethod
    def of(cls, camera: viser.CameraHandle) -> Picture | None:
        """Return the picture of a browser; None when its numbers are not a camera."""
        wxyz, eye = _numbers(camera.wxyz, 4), _numbers(camera.position, 3)
        size = _numbers((camera.image_width, camera.image_height), 2)
        fov = _numbers((camera.fov,), 1)
        if wxyz is None or eye is None or size is None or fov is None:
            return None
        if not (wxyz.any() and 0.0 < fov[0] < math.pi):
            return None
        if not ((size >= 1).all() and (size <= limits.VIEW_SIDE.value).all()):
            return None
        w, x, y, z = wxyz.tolist()
        axes = np.array(rotation_from_xyzw((x, y, z, w)))
        width, height = (int(side) for side in size.tolist())
        return cls(eye, axes, math.tan(float(fov[0]) / 2), width, height)

    @property
    def pixel(self) -> float:
        """Size of a pixel at 1 m [m]."""
        return 2.0 * self.half / self.height

    @property
    def up(self) -> Array:
        """The direction up in the picture, (3,), of length 1."""
        return -self.axes[:, 1]

    @property
    def forward(self) -> Array:
        """Where the camera looks, (3,), of length 1."""
        return self.axes[:, 2]

    def direction(self, at: ScreenPoint) -> Array:
        """The direction of the ray through a point of the picture, (3,), length 1."""
        x = (2.0 * at[0] - 1.0) * self.half * self.width / self.height
        y = (2.0 * at[1] - 1.0) * self.half
        along: Array = self.axes @ np.array((x, y, 1.0))
        return along / np.linalg.norm(along)

    def pixels(self, one: ScreenPoint, other: ScreenPoint) -> RayGrid | None:
        """Return the pixels of a rectangle between two of its corners, at least one.

        Returns:
            The pixels; None when the numbers are not a rectangle.
        """
        corners = _numbers((one, other), 2, 2)
        if corners is None:
            return None
        size = np.array((self.width, self.height))
        ends = np.minimum(np.maximum(np.sort(corners, axis=0), 0.0), 1.0) * size
        first = np.minimum(np.floor(ends[0]), size - 1)
        count = np.maximum(np.ceil(ends[1]) - first, 1)
        step = math.ceil(math.sqrt(float(count.prod()) / MOST_PIXELS))
        pixel = self.pixel
        # Pixel i is seen through its middle, at i + 1/2.
        x, y = (first + 0.5 * step - size / 2).tolist()
        right, down, ahead = (self.axes[:, i] for i in range(3))
        axes: Array = np.stack(
            [
                right * pixel * step,
                down * pixel * step,
                ahead + pixel * (x * right + y * down),
            ],
            axis=1,
        )
        columns, rows = (max(1, int(n)) for n in (count // step).tolist())
        return RayGrid(self.eye, axes, columns, rows, pixel)


def _numbers(values: object, *shape: int) -> Array | None:
    """Return numbers of a browser as an array; None for anything else."""
    try:
        array = np.asarray(values, np.float64)
    except (TypeError, ValueError):
        return None
    return array if array.shape == shape and np.isfinite(array).all() else None

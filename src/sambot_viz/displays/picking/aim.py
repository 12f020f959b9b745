"""Where the pointer is in the picture of a browser, as a ray with its camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sambot_viz.displays.picking.rays import Array
from sambot_viz.geometry import Matrix

_LEAST = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Aim:
    """A ray through a pixel of a picture, in the fixed frame.

    Attributes:
        origin: the position of the camera, (3,) [m].
        direction: from there through the pixel, (3,), of length 1.
        pixel: size of a pixel at 1 m [m].
        up: the direction up in the picture, (3,), of length 1.
        forward: the viewing direction of the camera, (3,), of length 1.
    """

    origin: Array
    direction: Array
    pixel: float
    up: Array
    forward: Array

    @property
    def right(self) -> Array:
        """The direction to the right in the picture, (3,), of length 1."""
        return np.cross(self.forward, self.up)

    @property
    def facing(self) -> Matrix:
        """The rotation of what faces the view, (4, 4): x along it and z up."""
        found = np.eye(4)
        found[:3, :3] = np.stack([self.forward, -self.right, self.up], axis=1)
        return found

    @property
    def at(self) -> Array:
        """Where the pixel is from the middle of the picture, to the right and up.

        Returns:
            (2,), at 1 m before the camera [m].
        """
        return self.seen(self.origin + self.direction)

    def seen(self, point: Array) -> Array:
        """Return where a point is in the picture, as `at`; it is before the camera."""
        away = point - self.origin
        depth = max(float(away @ self.forward), _LEAST)
        return np.array([away @ self.right, away @ self.up]) / depth

    def through(self, at: Array) -> Array:
        """Return the direction of the ray through a place in the picture, (3,)."""
        x, y = at
        return self.forward + x * self.right + y * self.up

    def on_plane(self, point: Array, normal: Array) -> Array | None:
        """Return where the ray meets a plane, (3,) [m]; None where it does not.

        Args:
            point: of the plane, (3,) [m].
            normal: of the plane, (3,).
        """
        slope = float(self.direction @ normal)
        if abs(slope) < _LEAST:
            return None
        reach = float((point - self.origin) @ normal) / slope
        return self.origin + reach * self.direction if reach > 0.0 else None

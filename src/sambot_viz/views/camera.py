"""A camera: its position, its direction, and the size of its picture."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]
"""A point or a direction, (3,) float64 [m]; never changed in place."""
Vectors = npt.NDArray[np.float64]
"""Some points, (N, 3) float64 [m]."""

FIELD_OF_VIEW = math.pi / 4
"""Vertical field of view of every perspective view of RViz [rad]."""
FAR = 100000.0
"""Far plane of every view [m]."""
ORTHO_HEIGHT = 500.0
"""Height of RViz's orthographic camera above its target [m]."""
ORTHO_FIELD_OF_VIEW = math.radians(0.5)
"""Field of view with which a page draws an orthographic view [rad]."""
WIDEST_ORTHO = 2.0 * ORTHO_FIELD_OF_VIEW
"""A field of view below this is that of an orthographic view [rad]."""
FILLED_HEIGHT, FILLED_WIDTH = 0.7, 0.9
"""Parts of the picture that the shown box may fill."""


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """A camera, perspective or orthographic.

    Attributes:
        position: of the camera [m].
        look_at: the point in the middle of the picture [m].
        up: direction that is up in the picture; need not be at right angles to it.
        fov: vertical field of view [rad].
        near: distance of the near plane [m].
        far: distance of the far plane [m].
        scale: of an orthographic camera [pixels per metre]; None for perspective.
    """

    position: Vector
    look_at: Vector
    up: Vector
    fov: float = FIELD_OF_VIEW
    near: float = 0.01
    far: float = FAR
    scale: float | None = None

    @property
    def orthographic(self) -> bool:
        """Return whether parallel lines stay parallel in the picture."""
        return self.scale is not None

    @property
    def forward(self) -> Vector:
        """The viewing direction, of length 1."""
        return unit(self.look_at - self.position)

    @property
    def image_up(self) -> Vector:
        """Up in the picture: at right angles to the viewing direction, of length 1."""
        return unit(self.up - self.forward * float(self.up @ self.forward))

    @property
    def right(self) -> Vector:
        """To the right in the picture, of length 1."""
        return np.cross(self.forward, self.image_up)

    @property
    def distance(self) -> float:
        """From the camera to the point in the middle [m]."""
        return length(self.look_at - self.position)

    @property
    def is_parallel(self) -> bool:
        """Return whether it draws an orthographic view with a small field of view."""
        return self.fov < WIDEST_ORTHO

    def with_fov(self, fov: float) -> Camera:
        """Return the camera that shows the plane of `look_at` as large.

        Args:
            fov: its field of view [rad].
        """
        if fov == self.fov:
            return self
        away = self.distance * math.tan(self.fov / 2.0) / math.tan(fov / 2.0)
        return self._from_away(away, fov)

    def placed(self, position: Vector, look_at: Vector, up: Vector) -> Camera:
        """Return the same camera at another place."""
        return replace(self, position=position, look_at=look_at, up=up)

    def distance_to_show(self, points: Vectors, aspect: float) -> float:
        """Return the distance from the middle of some points that shows all of them.

        Args:
            points: (N, 3) [m].
            aspect: width of the picture by its height.

        Returns:
            The distance of a camera that looks at their middle in the direction of
            this one, and sees them in `FILLED_HEIGHT` of the height and
            `FILLED_WIDTH` of the width [m].
        """
        around = points - points.mean(axis=0)
        half = math.tan(self.fov / 2.0)
        aside = np.abs(around @ self.right) / (FILLED_WIDTH * half * aspect)
        above = np.abs(around @ self.image_up) / (FILLED_HEIGHT * half)
        behind = around @ self.forward
        away = np.maximum(aside, above) - behind
        # The near plane of a parallel camera follows the distance that it has now.
        near = 0.0 if self.is_parallel else self.near
        return float(max(away.max(), near - behind.min()))

    def shows(self, point: Vector, width: int, height: int, part: float = 1.0) -> bool:
        """Return whether a point is in the picture.

        Args:
            point: (3,) [m].
            width: of the picture [pixels].
            height: of the picture [pixels].
            part: of the picture, about its middle.
        """
        away = point - self.position
        ahead = float(away @ self.forward)
        if ahead < self.near:
            return False
        if self.scale is not None:
            half = height / (2.0 * self.scale)
        else:
            half = ahead * math.tan(self.fov / 2.0)
        aside, above = abs(float(away @ self.right)), abs(float(away @ self.image_up))
        return aside <= part * half * width / height and above <= part * half

    def as_perspective(self, height: int, fov: float | None = None) -> Camera:
        """Return the nearest camera that a renderer with perspective can draw.

        An orthographic camera becomes a far one with a small field of view: exact to
        a pixel in the plane of `look_at`. A point that is h above that plane is shown
        at most h·scale·tan(fov/2) pixels off: 0.35 for h = 0.2 m at 400 pixels per
        metre.

        Args:
            height: of the picture [pixels].
            fov: field of view to take [rad]; None keeps RViz's height of 500 m.
        """
        if self.scale is None:
            return self
        half = height / (2.0 * self.scale)
        if fov is None:
            away, fov = ORTHO_HEIGHT, 2.0 * math.atan(half / ORTHO_HEIGHT)
        else:
            away = half / math.tan(fov / 2.0)
        return replace(self._from_away(away, fov), scale=None)

    def _from_away(self, away: float, fov: float) -> Camera:
        """Return a camera at a distance from `look_at`, to show its surroundings."""
        return replace(
            self,
            position=self.look_at - self.forward * away,
            fov=fov,
            near=max(0.01, away - ORTHO_HEIGHT),
            far=max(FAR, 2.0 * away),
        )

    def as_orthographic(self, height: int) -> Camera:
        """Return the orthographic camera that `as_perspective` approximated.

        Args:
            height: of the picture [pixels].
        """
        half = self.distance * math.tan(self.fov / 2.0)
        return replace(
            self,
            position=self.look_at - self.forward * ORTHO_HEIGHT,
            scale=height / (2.0 * half),
        )


def vector(x: float, y: float, z: float) -> Vector:
    """Return a vector of three numbers."""
    return np.array((x, y, z), np.float64)


UP = vector(0.0, 0.0, 1.0)


def length(a: Vector) -> float:
    """Euclidean length."""
    return float(np.linalg.norm(a))


def unit(a: Vector) -> Vector:
    """Return the direction of a vector that is not zero."""
    return a / length(a)


def turned(a: Vector, yaw: float) -> Vector:
    """Return a vector turned about the vertical axis by an angle [rad]."""
    c, s = math.cos(yaw), math.sin(yaw)
    return vector(c * a[0] - s * a[1], s * a[0] + c * a[1], a[2])


def on_sphere(yaw: float, pitch: float) -> Vector:
    """Return the unit vector with an azimuth and an elevation [rad]."""
    return vector(
        math.cos(yaw) * math.cos(pitch),
        math.sin(yaw) * math.cos(pitch),
        math.sin(pitch),
    )


def angles_of(a: Vector) -> tuple[float, float]:
    """Azimuth and elevation of a vector [rad]; the azimuth from 0 to 2π."""
    away = length(a)
    if away == 0.0:
        return (0.0, 0.0)
    elevation = math.asin(max(-1.0, min(1.0, float(a[2]) / away)))
    return (math.atan2(a[1], a[0]) % (2.0 * math.pi), elevation)


def components(a: Vector) -> tuple[float, float, float]:
    """Return a vector as the tuple that a property holds."""
    x, y, z = a.tolist()
    return (x, y, z)

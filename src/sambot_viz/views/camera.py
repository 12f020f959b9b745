"""A camera: where it stands, where it looks, and what it maps to the picture."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

Vector = tuple[float, float, float]

FIELD_OF_VIEW = math.pi / 4
"""Vertical field of view of every perspective view [rad] (spec/rviz-core.md §8.3)."""
FAR = 100000.0
"""Far plane of every view [m]."""
ORTHO_HEIGHT = 500.0
"""RViz's orthographic camera stands so far above its target [m]."""
ORTHO_FIELD_OF_VIEW = math.radians(0.5)
"""Field of view with which a page draws an orthographic view [rad]."""


@dataclass(frozen=True, slots=True)
class Camera:
    """Where a camera stands.

    Attributes:
        position: of the camera [m].
        look_at: the point in the middle of the picture [m].
        up: which way is up in the picture.
        fov: vertical field of view [rad].
        near: distance of the near plane [m].
        far: distance of the far plane [m].
        scale: of an orthographic camera [pixels per metre]; None for perspective.
    """

    position: Vector
    look_at: Vector
    up: Vector = (0.0, 0.0, 1.0)
    fov: float = FIELD_OF_VIEW
    near: float = 0.01
    far: float = FAR
    scale: float | None = None

    @property
    def forward(self) -> Vector:
        """The viewing direction, of length 1."""
        return unit(subtract(self.look_at, self.position))

    @property
    def image_up(self) -> Vector:
        """Up in the picture: at right angles to the viewing direction, of length 1."""
        forward = self.forward
        return unit(subtract(self.up, times(forward, dot(self.up, forward))))

    @property
    def right(self) -> Vector:
        """To the right in the picture, of length 1."""
        return cross(self.forward, self.image_up)

    @property
    def distance(self) -> float:
        """From the camera to the point in the middle [m]."""
        return length(subtract(self.look_at, self.position))

    def placed(self, position: Vector, look_at: Vector, up: Vector) -> Camera:
        """The same camera at another place."""
        return replace(self, position=position, look_at=look_at, up=up)

    def in_perspective(self, height: int, fov: float | None = None) -> Camera:
        """What a renderer without an orthographic camera can draw.

        An orthographic camera becomes a far one with a small field of view: right to
        a pixel in the plane of `look_at`. A thing that is h above that plane is shown
        by h·scale·tan(fov/2) pixels off at most: 0.35 for h = 0.2 m at 400 pixels
        per metre.

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
        return replace(
            self,
            position=subtract(self.look_at, times(self.forward, away)),
            fov=fov,
            near=max(0.01, away - ORTHO_HEIGHT),
            far=max(FAR, 2.0 * away),
            scale=None,
        )

    def in_parallel(self, height: int) -> Camera:
        """The orthographic camera that `in_perspective` stands for."""
        half = self.distance * math.tan(self.fov / 2.0)
        return replace(
            self,
            position=subtract(self.look_at, times(self.forward, ORTHO_HEIGHT)),
            scale=height / (2.0 * half),
        )


def add(a: Vector, b: Vector) -> Vector:
    """A + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a: Vector, b: Vector) -> Vector:
    """A − b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def times(a: Vector, factor: float) -> Vector:
    """A vector made longer by a factor."""
    return (a[0] * factor, a[1] * factor, a[2] * factor)


def dot(a: Vector, b: Vector) -> float:
    """The inner product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """A × b."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def length(a: Vector) -> float:
    """Euclidean length."""
    return math.hypot(*a)


def unit(a: Vector) -> Vector:
    """The direction of a vector that is not zero."""
    return times(a, 1.0 / length(a))


def turned(a: Vector, yaw: float) -> Vector:
    """A vector turned about the vertical axis by an angle [rad]."""
    if yaw == 0.0:
        return a
    c, s = math.cos(yaw), math.sin(yaw)
    return (c * a[0] - s * a[1], s * a[0] + c * a[1], a[2])


def on_sphere(yaw: float, pitch: float) -> Vector:
    """The unit vector with an azimuth and an elevation [rad]."""
    return (
        math.cos(yaw) * math.cos(pitch),
        math.sin(yaw) * math.cos(pitch),
        math.sin(pitch),
    )


def angles_of(a: Vector) -> tuple[float, float]:
    """Azimuth and elevation of a vector [rad]; the azimuth from 0 to 2π."""
    away = length(a)
    if away == 0.0:
        return (0.0, 0.0)
    return (
        math.atan2(a[1], a[0]) % (2.0 * math.pi),
        math.asin(max(-1.0, min(1.0, a[2] / away))),
    )

"""The base of all RViz view controllers: properties, and the camera they describe.

A view is computed both ways: `camera` gives the camera of the present properties,
`read` gives the properties of a camera that a mouse has moved. The numbers of a view
are relative to its target frame, whose position it follows.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, ClassVar

import numpy as np

from sambot_viz.rviz import (
    BoolProperty,
    FloatProperty,
    KeptProperty,
    Property,
    TfFrameProperty,
    ViewConfig,
)
from sambot_viz.views.camera import (
    FIELD_OF_VIEW,
    Camera,
    Vector,
    Vectors,
    turned,
    vector,
)

Values = Mapping[str, Any]
"""Property → value, for those that are to be set."""

STEEPEST = math.pi / 2 - 0.001
"""Largest pitch of all views [rad]."""
DIGITS = 7
"""Decimals that are kept of numbers that are read from a camera [m, rad]."""
SMALLEST_SIZE = 0.01
"""Smaller objects are shown as if they had this size [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Target:
    """The pose of the target frame in the fixed frame, as far as views follow it.

    Attributes:
        position: its origin [m].
        yaw: how far it is turned about the vertical [rad].
    """

    position: Vector
    yaw: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Name:
    """A name that faces the view, its upper edge in the middle at a point.

    Attributes:
        position: the point in the fixed frame [m].
        width: [m].
        height: [m].
    """

    position: Vector
    width: float
    height: float


WORLD = Target(vector(0.0, 0.0, 0.0))
"""The fixed frame as its own target."""


COMMON_PROPERTIES: tuple[Property, ...] = (
    FloatProperty(
        "Near Clip Distance",
        default=0.01,
        minimum=0.001,
        maximum=10000.0,
        unit="m",
        help="Anything nearer than this is not drawn.",
    ),
    BoolProperty("Invert Z Axis", default=False, help="Flip the view upside down."),
    TfFrameProperty(
        "Target Frame", default="<Fixed Frame>", help="The frame that the view follows."
    ),
    KeptProperty(
        "Enable Stereo Rendering",
        note="RViz for ROS 2 writes it, and has no stereo picture",
    ),
    KeptProperty(
        "Field of View",
        support="none",
        note="of ROS 1; the angle is 45 degrees, as in RViz for ROS 2",
    ),
)
"""The properties that every view has."""


class View:
    """Base of all views.

    Attributes:
        kind: the ROS 2 class id, such as "rviz_default_plugins/Orbit".
        help: one sentence for the list of views.
        properties: the declaration of everything a user can set.
        follows_yaw: whether it turns with the target frame.
        from_above: whether it looks straight down, without perspective.
        nearness: the property that says how near the camera is; where a file does not
            give it, the robot decides (`fit`).
        config: its values in the document.
    """

    kind: ClassVar[str]
    help: ClassVar[str]
    properties: ClassVar[tuple[Property, ...]]
    follows_yaw: ClassVar[bool] = False
    from_above: ClassVar[bool] = False
    nearness: ClassVar[str] = "Distance"

    def __init__(self, config: ViewConfig) -> None:
        self.config = config

    # Each view defines these; all in the target frame.

    def local_camera(self) -> Camera:
        """Return the camera of the present properties, in the target frame."""
        raise NotImplementedError

    def read_local(self, camera: Camera) -> Values:
        """Return the properties of a camera given in the target frame."""
        raise NotImplementedError

    def look_at_local(self, point: Vector) -> Values:
        """The properties with which it looks at a point of the target frame [m]."""
        raise NotImplementedError

    def mimic(self, old: View) -> Values:
        """Return the values that a view takes over from another one, as in RViz."""
        raise NotImplementedError

    def as_near_as(self, old: View, height: int) -> Values:
        """Return the value that shows things as large with the other projection.

        RViz starts at 10 pixels per metre or at 100 m, where a robot is a dot.

        Args:
            old: the view before.
            height: of the picture [pixels].
        """
        camera = old.local_camera()
        if (self.nearness, old.nearness) == ("Scale", "Distance"):
            return {"Scale": camera.as_orthographic(height).scale}
        if (self.nearness, old.nearness) == ("Distance", "Scale"):
            return {"Distance": camera.as_perspective(height, FIELD_OF_VIEW).distance}
        return {}

    def zero(self) -> Values:
        """Return the values that RViz's "Zero" sets."""
        raise NotImplementedError

    def shifted(self, offset: Vector) -> Values:
        """The properties of the same picture when the target jumps by −offset [m]."""
        raise NotImplementedError

    def fit_local(self, points: Vectors, width: int, height: int) -> Values:
        """The properties with which it shows some points of the target frame whole.

        The direction stays.

        Args:
            points: (N, 3) [m].
            width: of the picture [pixels].
            height: of the picture [pixels].
        """
        raise NotImplementedError

    # The same in the fixed frame.

    def camera(self, target: Target = WORLD) -> Camera:
        """Return the camera of the present properties, in the fixed frame."""
        return self.in_fixed(self.local_camera(), target)

    def read(self, camera: Camera, target: Target = WORLD) -> Values:
        """Return the properties of a camera given in the fixed frame."""
        return self.read_local(self.in_target(camera, target))

    def look_at(self, point: Vector, target: Target = WORLD) -> Values:
        """The properties with which it looks at a point of the fixed frame [m]."""
        target = self._turned(target)
        local = turned(point - target.position, -target.yaw)
        return self.look_at_local(local)

    def fit(
        self,
        low: Vector,
        high: Vector,
        width: int,
        height: int,
        target: Target = WORLD,
        names: Sequence[Name] = (),
    ) -> Values:
        """Return the properties with which it shows a box of the fixed frame whole.

        Args:
            low: lowest corner of the box [m].
            high: highest corner of the box [m].
            width: width of the picture [pixels].
            height: height of the picture [pixels].
            target: the frame that the view follows.
            names: labels that must be whole in the picture too.
        """
        target = self._turned(target)
        middle, half = (low + high) / 2.0, np.maximum(high - low, SMALLEST_SIZE) / 2.0
        corners = [
            turned(middle + half * sides - target.position, -target.yaw)
            for sides in product((-1.0, 1.0), repeat=3)
        ]
        points = np.array(corners)
        if names:
            points = self._box_around(points, names, target)
        return self.fit_local(points, width, height)

    def _box_around(
        self, points: Vectors, names: Sequence[Name], target: Target
    ) -> Vectors:
        """Return the corners of a box along the axes of the camera, (8, 3) [m].

        Args:
            points: of the target frame, which are in it, (N, 3) [m].
            names: labels that must be in it too.
            target: what the view follows.
        """
        camera = self.local_camera()
        axes = np.array([camera.right, camera.image_up, camera.forward], np.float64)
        parts = [axes @ point for point in points]
        for name in names:
            at = axes @ turned(name.position - target.position, -target.yaw)
            half = name.width / 2.0
            parts += [at - vector(half, 0, 0), at + vector(half, -name.height, 0)]
        low, high = np.min(parts, axis=0), np.max(parts, axis=0)
        corners = product(*zip(low, high, strict=True))
        return np.array(list(corners), np.float64) @ axes

    def in_fixed(self, camera: Camera, target: Target) -> Camera:
        """Return a camera of the target frame, in the fixed frame."""
        return to_fixed(camera, self._turned(target))

    def in_target(self, camera: Camera, target: Target) -> Camera:
        """Return a camera of the fixed frame, in the target frame."""
        return to_target(camera, self._turned(target))

    @property
    def gives_nearness(self) -> bool:
        """Return whether the file, or a user, has said how near the camera is."""
        return self.config.is_given(self.nearness)

    @property
    def near(self) -> float:
        """Distance of the near plane [m]."""
        return float(self.config.get("Near Clip Distance"))

    def _turned(self, target: Target) -> Target:
        return target if self.follows_yaw else Target(target.position)


def to_fixed(camera: Camera, target: Target) -> Camera:
    """Return a camera of the target frame, in the fixed frame."""
    return camera.placed(
        target.position + turned(camera.position, target.yaw),
        target.position + turned(camera.look_at, target.yaw),
        turned(camera.up, target.yaw),
    )


def to_target(camera: Camera, target: Target) -> Camera:
    """Return a camera of the fixed frame, in the target frame."""
    return camera.placed(
        turned(camera.position - target.position, -target.yaw),
        turned(camera.look_at - target.position, -target.yaw),
        turned(camera.up, -target.yaw),
    )


def rounded(values: Values) -> Values:
    """Return values without their last digits, which a page changes at random."""
    return {path: _round(value) for path, value in values.items()}


def _round(value: Any) -> Any:
    if isinstance(value, float):
        return round(value, DIGITS)
    x, y, z = value
    return (round(x, DIGITS), round(y, DIGITS), round(z, DIGITS))

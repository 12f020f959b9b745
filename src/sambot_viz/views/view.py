"""What every RViz view controller is: properties, and the camera they mean."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from sambot_viz.rviz import Property, ViewConfig

Vector = tuple[float, float, float]

FIELD_OF_VIEW = math.pi / 4
"""Vertical field of view of every perspective view [rad] (§8.3)."""
FAR = 100000.0
"""Far plane of every view [m]."""


@dataclass(frozen=True, slots=True)
class Camera:
    """Where a camera stands, in the fixed frame.

    Attributes:
        position: of the camera [m].
        look_at: the point in the middle of the picture [m].
        up: which way is up in the picture.
        fov: vertical field of view [rad].
        near: distance of the near plane [m].
    """

    position: Vector
    look_at: Vector
    up: Vector = (0.0, 0.0, 1.0)
    fov: float = FIELD_OF_VIEW
    near: float = 0.01


class View:
    """Base of all views.

    Attributes:
        kind: the ROS 2 class id, such as "rviz_default_plugins/Orbit".
        help: one sentence for the list of views.
        properties: the declaration of everything a user can set.
    """

    kind: ClassVar[str]
    help: ClassVar[str]
    properties: ClassVar[tuple[Property, ...]]

    def __init__(self, config: ViewConfig) -> None:
        self.config = config

    def camera(self, target: Vector) -> Camera:
        """The camera of the present properties.

        Args:
            target: origin of the target frame in the fixed frame [m].
        """
        raise NotImplementedError

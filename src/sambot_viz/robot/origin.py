"""A pose as URDF writes it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from sambot_viz.errors import Place
from sambot_viz.geometry import Matrix, Vector3, rotation_from_rpy


@dataclass(frozen=True)
class Origin:
    """A pose as URDF writes it: translation xyz [m], fixed-axis rpy [rad]."""

    xyz: Vector3 = (0.0, 0.0, 0.0)
    rpy: Vector3 = (0.0, 0.0, 0.0)
    place: Place | None = field(default=None, compare=False)

    @cached_property
    def matrix(self) -> Matrix:
        """The read-only (4, 4) transform, R = Rz(yaw) @ Ry(pitch) @ Rx(roll)."""
        T = np.eye(4)
        T[:3, :3] = rotation_from_rpy(*self.rpy)
        T[:3, 3] = self.xyz
        T.flags.writeable = False
        return T

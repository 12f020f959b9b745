"""The geometry of one display, which answers rays."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from sambot_viz.displays.picking.pick_buffer import PickBuffer
from sambot_viz.displays.picking.rays import Array, RayGrid
from sambot_viz.displays.picking.selectable import Hit, Selectable


@dataclass(frozen=True, slots=True, eq=False)
class Nearby:
    """A point that a ray goes past.

    Attributes:
        distance: distance to the point along the ray [m].
        hit: the result if the ray is treated as one through the point.
    """

    distance: float
    hit: Hit


class PickGeometry:
    """The geometry of one display at one moment.

    It is made with the session locked, and may be asked in another thread afterwards:
    it keeps what it needs and never looks at its display again.
    """

    @property
    def triangles(self) -> int:
        """The number of triangles, to judge how long a ray or a rectangle takes."""
        return 0

    @property
    def is_clear(self) -> bool:
        """Whether some of it selects something and can be seen through."""
        return False

    def cut_off(self, pixels: RayGrid) -> Iterable[Selectable]:
        """Return whatever can be seen through and lies beside the pixels in part."""
        del pixels
        return ()

    def draw(self, buffer: PickBuffer) -> None:
        """Draw all that a buffer takes."""
        del buffer

    def nearby(self, ray: RayGrid) -> Nearby | None:
        """Return the point that a ray goes past, and that was probably meant."""
        del ray

    def cast(self, origin: Array, direction: Array, pixel: float) -> float:
        """Follow a ray to what can be pointed at, but seen through, such as lines.

        Args:
            origin: (3,), in the fixed frame [m].
            direction: (3,), of length 1.
            pixel: size of a pixel at 1 m [m].

        Returns:
            The distance [m]; infinite where the ray meets nothing of that kind.
        """
        del origin, direction, pixel
        return np.inf

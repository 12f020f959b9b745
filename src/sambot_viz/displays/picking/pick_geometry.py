"""Geometry of one display at one moment, for rays and rectangles to meet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from sambot_viz.displays.picking.rays import Array, RayGrid

Corners = tuple[Array, Array]
"""The lowest and the highest corner of a box along the axes, (3,) [m]."""


@dataclass(frozen=True, slots=True)
class Selectable:
    """Something that can be selected: a link of the robot, or a TF frame."""

    kind: Literal["link", "frame"]
    name: str


@dataclass(frozen=True, slots=True, eq=False)
class Hit:
    """The result of following a ray from the cursor.

    Attributes:
        point: the nearest point of what is drawn, in the fixed frame, (3,) [m]; None
            for the background.
        item: the link or frame; None for the grid and the background.
    """

    point: Array | None
    item: Selectable | None


class PickBuffer:
    """Pixels with what is in front in each, as in a renderer with a depth buffer.

    A ray is followed as a rectangle of one pixel.

    Args:
        pixels: the rays through the pixels.

    Attributes:
        near: (rows, columns), 1 by the distance along the ray, which is counted in
            multiples of its direction; 0 for the background.
    """

    def __init__(self, pixels: RayGrid) -> None:
        self.pixels = pixels
        self.near: Array = np.zeros((pixels.rows, pixels.columns))
        self._front = np.full(self.near.shape, -1, np.int64)
        self._items: list[Selectable | None] = []

    def cover(self, left: int, top: int, near: Array, item: Selectable | None) -> None:
        """Put something in front of what is farther away.

        Args:
            left: the first column of a part of the pixels.
            top: its first row.
            near: how near it is there, (rows, columns), as in the attribute.
            item: what it belongs to; None for what cannot be selected.
        """
        rows, columns = near.shape
        window = np.s_[top : top + rows, left : left + columns]
        nearer = near > self.near[window]
        self.near[window][nearer] = near[nearer]
        self._front[window][nearer] = len(self._items)
        self._items.append(item)

    @property
    def items(self) -> set[Selectable]:
        """The links and frames that have at least one of the pixels."""
        numbers: list[int] = np.unique(self._front).tolist()
        items = {self._items[number] for number in numbers if number >= 0}
        return {item for item in items if item is not None}


class PickGeometry:
    """The geometry of one display at one moment.

    It is made with the session locked, and may be asked in another thread afterwards:
    it keeps what it needs and never looks at its display again.
    """

    @property
    def triangles(self) -> int:
        """The number of triangles, to judge how long a ray or a rectangle takes."""
        return 0

    def draw(self, buffer: PickBuffer) -> None:
        """Draw all that hides what is behind it."""
        del buffer

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

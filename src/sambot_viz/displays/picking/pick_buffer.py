"""Pixels with the nearest drawn object in each, like a renderer's depth buffer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from sambot_viz.displays.picking.rays import Array, Indices, RayGrid
from sambot_viz.displays.picking.selectable import Selectable, Selection


class Owner(Protocol):
    """What has pixels: a shape, or many under numbers, such as points."""

    @property
    def count(self) -> int:
        """How many numbers it has."""
        ...

    @property
    def is_clear(self) -> bool:
        """Whether it is transparent."""
        ...

    @property
    def selects(self) -> bool:
        """Whether a click on it may select something."""
        ...

    def selection(self, numbers: Indices) -> Selection:
        """Return what its numbers mean to a selection."""
        ...

    def position(self, number: int) -> Array | None:
        """Return the point that a number means, (3,) [m]; None for the surface."""
        ...


def hides(owner: Owner) -> bool:
    """Return whether an object hides others from selection.

    Transparent objects that select nothing do not: otherwise a robot in a map, or
    within the ellipsoid of a covariance, could not be selected.
    """
    return owner.selects or not owner.is_clear


class PickBuffer:
    """Pixels with the nearest drawn object in each.

    A single ray is a rectangle of one pixel.

    Args:
        pixels: the rays through the pixels.
        takes: which objects are drawn.

    Attributes:
        pixels: as given.
        takes: as given; it may be changed between two objects.
        writes: whether an object takes the pixels where it is in front; otherwise it is
            only noted that it is visible there.
        near: (rows, columns), 1 / distance along the ray, which is counted in multiples
            of its direction; 0 for the background.
    """

    def __init__(self, pixels: RayGrid, takes: Callable[[Owner], bool] = hides) -> None:
        self.pixels = pixels
        self.takes = takes
        self.writes = True
        self.near: Array = np.zeros((pixels.rows, pixels.columns))
        self._front = np.full(self.near.shape, -1, np.int64)
        self._owners: list[Owner] = []
        self._begins: list[int] = []
        self._count = 0
        self._seen_too: list[tuple[Owner, Indices]] = []

    def cover(
        self, left: int, top: int, near: Array, owner: Owner, number: int = 0
    ) -> None:
        """Draw an object where it is nearer than the others.

        Args:
            left: the first column of a part of the pixels.
            top: its first row.
            near: its nearness there, (rows, columns), as in the attribute.
            owner: the drawn object.
            number: one of its numbers.
        """
        rows, columns = near.shape
        window = np.s_[top : top + rows, left : left + columns]
        nearer = near > self.near[window]
        if not nearer.any():
            return
        if not self.writes:
            self._seen_too.append((owner, np.array([number])))
            return
        self.near[window][nearer] = near[nearer]
        self._front[window][nearer] = self._begin(owner) + number

    def cover_pixels(
        self, pixels: Indices, near: Array, owner: Owner, numbers: Indices
    ) -> None:
        """Draw many small parts where they are nearer than the others.

        Args:
            pixels: (F,), row · columns + column of each; repetitions are allowed.
            near: (F,), nearness of each.
            owner: the drawn object.
            numbers: (F,), the number of each part.
        """
        nearer = np.flatnonzero(near > self.near.ravel()[pixels])
        if not self.writes:
            self._seen_too.append((owner, np.unique(numbers[nearer])))
            return
        # Of several in one pixel the nearest is written last.
        last = nearer[np.argsort(near[nearer], kind="stable")]
        self.near.ravel()[pixels[last]] = near[last]
        self._front.ravel()[pixels[last]] = self._begin(owner) + numbers[last]

    def _begin(self, owner: Owner) -> int:
        if not self._owners or self._owners[-1] is not owner:
            self._owners.append(owner)
            self._begins.append(self._count)
            self._count += owner.count
        return self._begins[-1]

    def front(self) -> tuple[Owner, int] | None:
        """Return what has the first pixel, and its number; None for the background."""
        found = int(self._front[0, 0])
        if found < 0:
            return None
        which = int(np.searchsorted(self._begins, found, "right")) - 1
        return self._owners[which], found - self._begins[which]

    @property
    def selection(self) -> dict[Selectable, Indices | None]:
        """What has at least one of the pixels."""
        found: Indices = np.unique(self._front)
        found = found[found >= 0]
        which = np.searchsorted(self._begins, found, "right") - 1
        met: dict[Selectable, Indices | None] = {}
        for number, owner in enumerate(self._owners):
            own = found[which == number] - self._begins[number]
            met |= owner.selection(own) if len(own) else {}
        for one, some in self._seen_too:
            met |= one.selection(some)
        return met

"""Ask the displays of a session what rays and rectangles meet."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from sambot_viz.displays.display import Display
from sambot_viz.displays.picking.pick_geometry import (
    Array,
    Corners,
    Hit,
    PickBuffer,
    PickGeometry,
    RayGrid,
    Selectable,
)


@dataclass(frozen=True, slots=True)
class PickSnapshot:
    """Everything drawn at one moment; rays can be followed without any lock.

    Attributes:
        geometries: of the displays that are shown, in their order.
    """

    geometries: tuple[PickGeometry, ...]

    @property
    def triangles(self) -> int:
        """The number of triangles."""
        return sum(geometry.triangles for geometry in self.geometries)

    def first_hit(self, origin: Array, direction: Array, pixel: float) -> Hit:
        """Return what one ray meets first.

        What can be seen through, such as the lines of a grid, only counts where the ray
        meets nothing else.

        Args:
            origin: (3,), in the fixed frame [m].
            direction: (3,), of length 1.
            pixel: size of a pixel at 1 m [m].
        """
        buffer = self._drawn(RayGrid.through(origin, direction))
        near = buffer.near[0, 0]
        if near > 0.0:
            return Hit(origin + direction / near, next(iter(buffer.items), None))
        thin = (one.cast(origin, direction, pixel) for one in self.geometries)
        nearest = min(thin, default=np.inf)
        if not np.isfinite(nearest):
            return Hit(None, None)
        return Hit(origin + nearest * direction, None)

    def items_met(self, pixels: RayGrid) -> set[Selectable]:
        """Return the links and frames that have at least one of some pixels."""
        return self._drawn(pixels).items

    def _drawn(self, pixels: RayGrid) -> PickBuffer:
        buffer = PickBuffer(pixels)
        for geometry in self.geometries:
            geometry.draw(buffer)
        return buffer


class PickScene:
    """Asks the displays of a session what they show, with the session locked.

    Args:
        displays: returns the displays of the session.
    """

    def __init__(self, displays: Callable[[], Sequence[Display]]) -> None:
        self._displays = displays

    def snapshot(self) -> PickSnapshot:
        """Return everything that is drawn now; files are not read for it."""
        return PickSnapshot(tuple(d.pick_geometry() for d in self._shown()))

    def boxes_of(self, items: Iterable[Selectable]) -> dict[Selectable, Corners]:
        """Return the boxes around the shapes of links and the axes of frames.

        Args:
            items: which; one that is not drawn now has no box.
        """
        wanted = set(items)
        boxes: dict[Selectable, Corners] = {}
        for display in self._shown() if wanted else ():
            for item, box in display.boxes(lambda item: item in wanted):
                if item is not None:
                    boxes[item] = _union(box, boxes.get(item))
        return {item: boxes[item] for item in wanted if item in boxes}

    def robot_box(self) -> Corners | None:
        """Return the box around all links, or else around all that is drawn.

        Returns:
            None when nothing is drawn.
        """
        return self._box(
            lambda item: item is not None and item.kind == "link"
        ) or self._box(lambda _: True)

    def _box(self, of: Callable[[Selectable | None], bool]) -> Corners | None:
        box: Corners | None = None
        for display in self._shown():
            for _, corners in display.boxes(of):
                box = _union(corners, box)
        return box

    def _shown(self) -> Iterator[Display]:
        return (display for display in self._displays() if display.shown)


def _union(one: Corners, other: Corners | None) -> Corners:
    """Return the box around two boxes."""
    if other is None:
        return one
    return np.minimum(one[0], other[0]), np.maximum(one[1], other[1])

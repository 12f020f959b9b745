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
    Part,
    PickBuffer,
    PickGeometry,
    RayGrid,
    Selectable,
    TurnedBox,
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
        """Return the links and frames that have at least one of some pixels.

        As in RViz that is what is in front. Here it is also what is seen through other
        shapes and lies in the rectangle as a whole; of what is cut off, such as the
        body behind a wheel, nobody can say that it was meant.
        """
        front = self._drawn(pixels).items
        if not any(geometry.clear for geometry in self.geometries):
            return front
        buffer = PickBuffer(pixels)
        for buffer.clear in (False, True):
            for geometry in self.geometries:
                geometry.draw(buffer)
        cut = {item for one in self.geometries for item in one.cut_off(pixels)}
        return front | (buffer.items - cut)

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

    def boxes_of(self, items: Iterable[Selectable]) -> dict[Selectable, TurnedBox]:
        """Return the boxes around the shapes of links and the axes of frames.

        They turn with the shapes.

        Args:
            items: which; one that is not drawn now has no box.
        """
        wanted = set(items)
        parts: dict[Selectable | None, list[Part]] = {}
        for display in self._shown() if wanted else ():
            for item, part in display.parts(lambda item: item in wanted):
                parts.setdefault(item, []).append(part)
        return {i: TurnedBox.around(parts[i]) for i in wanted if i in parts}

    def box_of(self, items: Iterable[Selectable]) -> Corners | None:
        """Return the box around some links and frames; None when none is drawn."""
        wanted = set(items)
        return self._box(lambda item: item in wanted)

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
            for _, part in display.parts(of):
                box = _union(part.box(), box)
        return box

    def _shown(self) -> Iterator[Display]:
        return (display for display in self._displays() if display.shown)


def _union(one: Corners, other: Corners | None) -> Corners:
    """Return the box around two boxes."""
    if other is None:
        return one
    return np.minimum(one[0], other[0]), np.maximum(one[1], other[1])

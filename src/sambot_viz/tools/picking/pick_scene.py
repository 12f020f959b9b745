"""Ask the displays of a session what rays and rectangles meet."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from sambot_viz import limits
from sambot_viz.displays.display import Display
from sambot_viz.displays.picking.handle import Handle
from sambot_viz.displays.picking.pick_buffer import Owner, PickBuffer, hides
from sambot_viz.displays.picking.pick_geometry import PickGeometry
from sambot_viz.displays.picking.rays import Array, RayGrid
from sambot_viz.displays.picking.selectable import Hit, Selectable, Selection
from sambot_viz.displays.picking.selected import Cubes, SelectedData
from sambot_viz.displays.picking.triangle_mesh import Corners, Part, TurnedBox
from sambot_viz.geometry import Matrix
from sambot_viz.text import columns
from sambot_viz.views.view import Name

LETTER_WIDTH, LINE_HEIGHT = 0.55, 1.5
"""Of a usual letter and of a line, by the size of letters."""
AROUND = 4.0
"""Distance shown around a robot, in lengths of the robot."""
BESIDE = 0.05
"""Points this near to a box, in parts of its diagonal, count as inside."""


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

    def first_hit(
        self, origin: Array, direction: Array, pixel: float, up: Array | None = None
    ) -> Hit:
        """Return the first hit of a ray.

        A point of a cloud is also hit from some pixels away, unless the ray hits a
        selectable object. Transparent objects that select nothing, such as the lines of
        a grid, only count where the ray hits nothing else.

        Args:
            origin: (3,), in the fixed frame [m].
            direction: (3,), of length 1.
            pixel: size of a pixel at 1 m [m].
            up: the direction up in the picture, (3,).
        """
        ray = RayGrid.through(origin, direction, pixel, up)
        front = _front(self._drawn(ray))
        if front is not None and front[1].item is not None:
            return front[1]
        passed = (one.nearby(ray) for one in self.geometries)
        near = [one for one in passed if one is not None]
        if near:
            nearest = min(near, key=lambda one: one.distance)
            # What is seen at a flat angle is farther away a few pixels beside.
            slack = 1.0 + FLAT * pixel
            if front is None or nearest.distance <= front[0] * slack:
                return nearest.hit
        if front is not None:
            return front[1]
        clear = _front(self._drawn(ray, lambda owner: not hides(owner)))
        thin = (one.cast(origin, direction, pixel) for one in self.geometries)
        distance = min(thin, default=np.inf)
        if clear is not None and clear[0] <= distance:
            return clear[1]
        if not np.isfinite(distance):
            return Hit(None, None)
        return Hit(origin + distance * direction, None)

    def items_met(self, pixels: RayGrid) -> Selection:
        """Return the items that have at least one of some pixels.

        As in RViz these are the ones in front. Items that are visible through
        transparent shapes count too if they are in the rectangle as a whole: a partly
        enclosed one, such as the body beyond a wheel, may not be meant.
        """
        front = self._drawn(pixels).selection
        if not any(geometry.is_clear for geometry in self.geometries):
            return front
        buffer = self._drawn(pixels, lambda owner: not owner.is_clear)
        buffer.takes, buffer.writes = _is_clear, False
        for geometry in self.geometries:
            geometry.draw(buffer)
        cut = {item for one in self.geometries for item in one.cut_off(pixels)}
        seen = buffer.selection
        return front | {item: seen[item] for item in seen if item not in cut}

    def _drawn(
        self, pixels: RayGrid, takes: Callable[[Owner], bool] = hides
    ) -> PickBuffer:
        buffer = PickBuffer(pixels, takes)
        for geometry in self.geometries:
            geometry.draw(buffer)
        return buffer


FLAT = 30.0
"""How many pixels deeper a surface may be where a point is meant."""


def _is_clear(owner: Owner) -> bool:
    return owner.is_clear


def _front(buffer: PickBuffer) -> tuple[float, Hit] | None:
    """Return the distance along a single ray and what it meets; None for nothing."""
    found = buffer.front()
    if found is None:
        return None
    owner, number = found
    distance = 1.0 / float(buffer.near[0, 0])
    ray = buffer.pixels
    meant = owner.position(number)
    point = ray.origin + distance * ray.axes[:, 2] if meant is None else meant
    for item, numbers in owner.selection(np.array([number])).items():
        return distance, Hit(point, item, None if numbers is None else int(numbers[0]))
    return distance, Hit(point, None)


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

    def with_handles(self, facing: Matrix) -> PickSnapshot:
        """Return everything that is drawn now, with all that a hand can move.

        Args:
            facing: rotation of what faces the view, (4, 4).
        """
        return PickSnapshot(tuple(d.handle_geometry(facing) for d in self._shown()))

    @property
    def has_handles(self) -> bool:
        """Whether something is shown that a hand can move."""
        return any(display.has_handles for display in self._shown())

    def handle(self, item: Selectable) -> Handle | None:
        """Return the movable marker that a ray has hit; None without one."""
        known = (display.handle(item) for display in self._shown())
        return next((one for one in known if one is not None), None)

    def boxes_of(self, selection: Selection) -> dict[Selectable, Array]:
        """Return the boxes around a selection, as the lines of their edges.

        They turn with shapes; boxes of points are parallel to the fixed frame.

        Args:
            selection: the selected items; those not drawn now have no box.

        Returns:
            Item → (N, 2, 3), start and end of each line in the fixed frame [m].
        """
        wanted = {item for item, numbers in selection.items() if numbers is None}
        parts: dict[Selectable | None, list[Part]] = {}
        for display in self._shown() if wanted else ():
            for item, part in display.parts(lambda item: item in wanted):
                parts.setdefault(item, []).append(part)
        boxes = {i: TurnedBox.around(parts[i]).lines for i in wanted if i in parts}
        for item, cubes in self._cubes(selection):
            boxes[item] = cubes.lines(limits.SELECTED_BOXES.value)
        return boxes

    def box_of(self, selection: Selection) -> Corners | None:
        """Return the box around a selection; None if nothing of it is drawn."""
        wanted = {item for item, numbers in selection.items() if numbers is None}
        box = self._box(lambda item: item in wanted)
        for _, cubes in self._cubes(selection):
            box = _union(cubes.box, box)
        return box

    def robot_box(self) -> Corners | None:
        """Return the box around all links, or else around all that is drawn.

        Returns:
            None when nothing is drawn.
        """
        return self.link_box() or self._box(lambda _: True)

    def link_box(self) -> Corners | None:
        """Return the box around all links; None while none is drawn."""
        return self._box(lambda item: item is not None and item.kind == "link")

    def first_box(self) -> Corners | None:
        """Return the box around the robot and the data; None if nothing is drawn.

        Without these it is the box around the whole scene. Data far from a robot are
        left out, so that the robot is large enough to see.
        """
        robot = box = self.link_box()
        for display in self._shown():
            for _, part in display.parts(lambda _: True) if display.is_data else ():
                box = _union(part.box(), box)
        if box is None or robot is None:
            return box or self._box(lambda _: True)
        room = AROUND * float(np.max(robot[1] - robot[0]))
        return np.maximum(box[0], robot[0] - room), np.minimum(box[1], robot[1] + room)

    @property
    def data_drawn(self) -> int:
        """How many displays have drawn data."""
        return sum(
            any(True for _ in display.parts(lambda _: True))
            for display in self._shown()
            if display.is_data
        )

    def names_in(self, box: Corners) -> list[Name]:
        """Return the names that are drawn of frames in a box of the fixed frame."""
        low, high = box
        room = BESIDE * float(np.linalg.norm(high - low))
        found: list[Name] = []
        for display in self._shown():
            for frame, size in display.names().items():
                T = display.context.pose(frame)
                if T is None:
                    continue
                at = T[:3, 3]
                if np.all(at >= low - room) and np.all(at <= high + room):
                    width = columns(frame) * LETTER_WIDTH * size
                    found.append(Name(at, width, LINE_HEIGHT * size))
        return found

    def data_of(self, item: Selectable) -> SelectedData | None:
        """Return a display's details of data; None if they are no longer drawn."""
        known = (display.selected(item) for display in self._shown())
        return next((one for one in known if one is not None), None)

    def kept(self, selection: Selection) -> Selection:
        """Return a selection without data that is gone, such as points of old scans."""
        return {
            item: numbers
            for item, numbers in selection.items()
            if not item.is_data or self.data_of(item) is not None
        }

    def _cubes(self, selection: Selection) -> Iterator[tuple[Selectable, Cubes]]:
        for item, numbers in selection.items():
            data = None if numbers is None else self.data_of(item)
            if data is not None and numbers is not None:
                yield item, data.cubes(numbers)

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

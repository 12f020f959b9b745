"""How a drag moves an interactive marker, as RViz does for each mode of interaction.

All is in the fixed frame. A drag that has no meaning, such as one to the horizon,
leaves the marker where it is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import ClassVar

import numpy as np

from sambot_viz.displays.picking.aim import Aim
from sambot_viz.displays.picking.rays import Array
from sambot_viz.geometry import Matrix, rotation_from_axis

(
    NONE,
    MENU,
    BUTTON,
    MOVE_AXIS,
    MOVE_PLANE,
    ROTATE_AXIS,
    MOVE_ROTATE,
    MOVE_3D,
    ROTATE_3D,
    MOVE_ROTATE_3D,
) = range(10)
"""Modes of visualization_msgs/InteractiveMarkerControl."""
TURN = 2.0 * 3.14 / 300.0
"""Of a marker that turns freely, by pixel [rad]: RViz's value."""
_LEAST = 1e-9


class Drag:
    """A marker that a hand has taken.

    Args:
        mode: of the control.
        T: pose of the marker, T_fixed_marker, (4, 4).
        axis: of the control, (3,), of length 1.
        grabbed: the point that was grabbed, (3,) [m].
        aim: where the pointer was.

    Attributes:
        pose: of the marker now, T_fixed_marker.
    """

    def __init__(
        self, mode: int, T: Matrix, axis: Array, grabbed: Array, aim: Aim
    ) -> None:
        self.pose = T
        self._begin: Matrix = T
        self._axis, self._grabbed = axis, grabbed
        self._aim = self._last = aim
        self._held = np.linalg.inv(T) @ np.append(grabbed, 1.0)
        self._move = self._MOVES.get(mode)

    def to(self, aim: Aim, *, shift: bool = False, ctrl: bool = False) -> bool:
        """Follow the pointer; return whether the marker has moved.

        Args:
            aim: where it is.
            shift: whether Shift is held: in depth, or about the direction of view.
            ctrl: whether Ctrl is held: what moves and turns freely turns.
        """
        if self._move is None:
            return False
        before = self.pose
        found = self._move(self, aim, shift, ctrl)
        self._last = aim
        if found is not None and np.isfinite(found).all():
            self.pose = found
        return self.pose is not before

    # One function for each mode

    def _along(self, aim: Aim, shift: bool, ctrl: bool) -> Matrix | None:
        """Go along the axis, to where it is nearest to the pointer in the picture."""
        del shift, ctrl
        there, way = self._grabbed, self._axis
        away = there - aim.origin
        depth, ahead = float(away @ aim.forward), float(way @ aim.forward)
        if depth < _LEAST:
            return None
        sides = np.array([way @ aim.right, way @ aim.up])
        line = sides - aim.seen(there) * ahead
        length = float(line @ line)
        if length < _LEAST:
            return None
        seen = aim.seen(there)
        ray = aim.through(seen + line * float((aim.at - seen) @ line) / length)
        # The point of the axis that is nearest to that ray.
        across = float(way @ ray)
        square = float(ray @ ray)
        spread = square - across * across
        if spread < _LEAST * square:
            return None
        step = (float(away @ ray) * across - float(away @ way) * square) / spread
        # Beyond its vanishing point the axis is not visible.
        return self._moved(step * way) if depth + step * ahead > 0.0 else None

    def _in_plane(self, aim: Aim, shift: bool, ctrl: bool) -> Matrix | None:
        """Go in the plane across the axis."""
        del shift, ctrl
        met = aim.on_plane(self._grabbed, self._axis)
        return None if met is None else self._moved(met - self._grabbed)

    def _about(self, aim: Aim, shift: bool, ctrl: bool) -> Matrix | None:
        """Turn about the axis."""
        del shift, ctrl
        middle = self._middle(self._begin[:3, 3], self._grabbed)
        met = aim.on_plane(middle, self._axis)
        if met is None:
            return None
        angle = self._angle(self._grabbed - middle, met - middle)
        return None if angle is None else _turned(self._begin, self._axis, angle)

    def _tow(self, aim: Aim, shift: bool, ctrl: bool) -> Matrix | None:
        """Turn so that what was grabbed looks at the pointer, then follow it."""
        del shift, ctrl
        held: Array = (self.pose @ self._held)[:3]
        middle = self._middle(self.pose[:3, 3], held)
        met = aim.on_plane(middle, self._axis)
        if met is None:
            return None
        before, after = held - middle, met - middle
        angle = self._angle(before, after)
        if angle is None:
            return None
        found = _turned(self.pose, self._axis, angle)
        short = float(np.linalg.norm(before)) / float(np.linalg.norm(after))
        found[:3, 3] += after * (1.0 - short)
        return found

    def _freely(self, aim: Aim, shift: bool, ctrl: bool) -> Matrix | None:
        """Go in the plane of the picture, or with Shift in depth."""
        del ctrl
        if not shift:
            met = aim.on_plane(self._grabbed, self._aim.forward)
            return None if met is None else self._moved(met - self._grabbed)
        right, up = self._pixels(aim)
        far = up if abs(up) >= abs(right) else right
        depth = float((self._grabbed - self._aim.origin) @ self._aim.forward)
        step = far * self._aim.pixel * max(depth, 0.0)
        self._shift(step * self._aim.direction)
        return np.array(self._begin)

    def _turn(self, aim: Aim, shift: bool, ctrl: bool) -> Matrix | None:
        """Turn with the pointer, or with Shift about the direction of view."""
        del ctrl
        right, up = self._pixels(aim)
        if shift:
            far = -up if abs(up) > abs(right) else right
            return _turned(self.pose, aim.forward, TURN * far)
        found = _turned(self.pose, aim.right, -TURN * up)
        return _turned(found, aim.up, TURN * right)

    def _move_or_turn(self, aim: Aim, shift: bool, ctrl: bool) -> Matrix | None:
        """Turn while Ctrl is held, else go."""
        return (self._turn if ctrl else self._freely)(aim, shift, ctrl)

    _MOVES: ClassVar[Mapping[int, Callable[..., Matrix | None]]] = {
        MOVE_AXIS: _along,
        MOVE_PLANE: _in_plane,
        ROTATE_AXIS: _about,
        MOVE_ROTATE: _tow,
        MOVE_3D: _freely,
        ROTATE_3D: _turn,
        MOVE_ROTATE_3D: _move_or_turn,
    }

    # What they share

    def _moved(self, by: Array) -> Matrix:
        found: Matrix = np.array(self.pose)
        found[:3, 3] = self._begin[:3, 3] + by
        return found

    def _shift(self, by: Array) -> None:
        """Begin somewhere else: what comes next is from there."""
        self._begin = np.array(self.pose)
        self._begin[:3, 3] += by
        self._grabbed = self._grabbed + by

    def _pixels(self, aim: Aim) -> tuple[float, float]:
        """Return how far the pointer has moved to the right and up [pixels]."""
        right, up = ((aim.at - self._last.at) / aim.pixel).tolist()
        return right, up

    def _middle(self, place: Array, grabbed: Array) -> Array:
        """Return the point of the axis through a place nearest to a point."""
        return place + float((grabbed - place) @ self._axis) * self._axis

    def _angle(self, before: Array, after: Array) -> float | None:
        """Return the angle about the axis from one direction to another [rad]."""
        across = float(np.cross(before, after) @ self._axis)
        along = float(before @ after)
        if math.hypot(across, along) < _LEAST:
            return None
        return math.atan2(across, along)


def _turned(T: Matrix, axis: Array, angle: float) -> Matrix:
    """Return a pose turned about an axis through its own origin."""
    x, y, z = axis.tolist()
    found: Matrix = np.array(T)
    found[:3, :3] = np.array(rotation_from_axis((x, y, z), angle)) @ T[:3, :3]
    return found

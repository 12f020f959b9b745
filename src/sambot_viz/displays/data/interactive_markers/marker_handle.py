"""A control of an interactive marker in a hand."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from sambot_viz.displays.data.interactive_markers.controls import (
    FIXED,
    VIEW_FACING,
    Control,
)
from sambot_viz.displays.data.interactive_markers.dragging import (
    BUTTON,
    MENU,
    MOVE_3D,
    MOVE_AXIS,
    MOVE_PLANE,
    MOVE_ROTATE,
    MOVE_ROTATE_3D,
    ROTATE_3D,
    ROTATE_AXIS,
    Drag,
)
from sambot_viz.displays.data.interactive_markers.interactive_markers import (
    InteractiveMarkers,
)
from sambot_viz.displays.data.interactive_markers.known_marker import KnownMarker
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.aim import Aim
from sambot_viz.displays.picking.handle import HandlePose, MenuEntry
from sambot_viz.displays.picking.rays import Array
from sambot_viz.frames import LookupRefused
from sambot_viz.geometry import Matrix, Vector3, wxyz_from_matrix, wxyz_rotated

_HINTS = {
    MENU: "Left: show menu.",
    BUTTON: "Left: activate.",
    MOVE_AXIS: "Left: move along the axis.",
    MOVE_PLANE: "Left: move in the plane.",
    ROTATE_AXIS: "Left: turn about the axis.",
    MOVE_ROTATE: "Left: move and turn.",
    MOVE_3D: "Left: move. Shift and left: move in depth.",
    ROTATE_3D: "Left: turn. Shift and left: turn about the view.",
    MOVE_ROTATE_3D: "Left: move. Shift: in depth. Ctrl: turn.",
}
_RIGHT = "Right: show menu."


class MarkerHandle:
    """Implements `displays.picking.handle.Handle`.

    Args:
        context: the context, with the frames.
        markers: the markers of the display.
        found: name of the marker, the marker, and its control.
        topic: the topic for feedback to its program.
        draw: draws the changes.
    """

    def __init__(
        self,
        context: DisplayContext,
        markers: InteractiveMarkers,
        found: tuple[str, KnownMarker, Control],
        topic: str,
        draw: Callable[[], None],
    ) -> None:
        self.marker, self._known, self._control = found
        self.control, self.topic = self._control.name, topic
        self._context, self._markers, self._draw = context, markers, draw
        self._drag: Drag | None = None

    @property
    def menu(self) -> Sequence[MenuEntry]:
        """The menu of the marker."""
        return self._known.menu

    @property
    def opens_menu(self) -> bool:
        """Whether a click opens the menu."""
        return self._control.mode == MENU

    @property
    def is_button(self) -> bool:
        """Whether a click presses it."""
        return self._control.mode == BUTTON

    @property
    def hint(self) -> str:
        """What can be done with it; empty for nothing."""
        own = _HINTS.get(self._control.mode, "")
        more = _RIGHT if self.menu and not self.opens_menu else ""
        return " ".join(filter(None, (own, more)))

    @property
    def is_there(self) -> bool:
        """Whether the marker still is the one that the ray has hit."""
        return self._markers.known.get(self.marker) is self._known

    def grab(self, point: Array, aim: Aim) -> bool:
        """Take it; return whether no other hand has the marker."""
        T = self._known.pose(self._context)
        axis = self._axis(aim)
        if T is None or axis is None or self._known.is_held:
            return False
        self._known.is_held = True
        self._drag = Drag(self._control.mode, T, axis, point, aim)
        return True

    def drag(self, aim: Aim, *, shift: bool, ctrl: bool) -> bool:
        """Follow the pointer; return whether the marker has moved."""
        drag = self._drag
        if (
            drag is None
            or not self.is_there
            or not drag.to(aim, shift=shift, ctrl=ctrl)
        ):
            return False
        self._known.put(drag.pose, self._context)
        self._markers.moved(self.marker)
        self._draw()
        return True

    def release(self) -> None:
        """Leave it: what its program has said meanwhile counts now."""
        if self._drag is not None:
            self._drag = None
            self._markers.release(self._known)
            self._draw()

    def pose(self, point: Array | None) -> HandlePose | None:
        """Return where the marker is, in its frame, or in the fixed frame."""
        T = self._known.pose(self._context)
        if T is None:
            return None
        if not self._known.is_locked:
            return _pose_in(np.eye(4), T, point, self._context.fixed_frame, 0)
        reference = self._known.reference(self._context)
        if reference is None:
            return None
        T_frame_fixed = np.asarray(np.linalg.inv(reference), np.float64)
        return _pose_in(T_frame_fixed, T, point, self._known.frame, self._stamp_ns)

    @property
    def _stamp_ns(self) -> int:
        """The time for which the place of the frame is known [ns]."""
        tree, fixed = self._context.tree, self._context.fixed_frame
        if tree.history is None or self._known.frame == fixed:
            return 0
        try:
            found = tree.history.latest_common_time(self._known.frame, fixed, tree)
        except LookupRefused:
            return 0
        return found or 0

    def _axis(self, aim: Aim) -> Array | None:
        """Return the axis of the control, (3,) in the fixed frame."""
        if self._control.turning == VIEW_FACING:
            return aim.forward
        is_fixed = self._control.turning == FIXED
        known = self._known
        T = known.reference(self._context) if is_fixed else known.pose(self._context)
        own = np.array(wxyz_rotated(self._control.wxyz, (1.0, 0.0, 0.0)))
        return None if T is None else T[:3, :3] @ own


def _pose_in(
    T_frame_fixed: Matrix, T: Matrix, point: Array | None, frame: str, stamp_ns: int
) -> HandlePose:
    """Return the pose of a marker, and a point, in a frame."""
    T_frame = T_frame_fixed @ T
    w, x, y, z = wxyz_from_matrix(T_frame)
    mouse = None
    if point is not None:
        mouse = _xyz((T_frame_fixed @ np.append(point, 1.0))[:3])
    return HandlePose(frame, stamp_ns, _xyz(T_frame[:3, 3]), (x, y, z, w), mouse)


def _xyz(place: Array) -> Vector3:
    x, y, z = place.tolist()
    return x, y, z

"""One interactive marker: its message, its pose, and where its controls are."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from sambot_viz.displays.data.interactive_markers.control_marker import ControlMarker
from sambot_viz.displays.data.interactive_markers.control_nodes import (
    InteractiveMarkerNodes,
)
from sambot_viz.displays.data.interactive_markers.controls import (
    INHERIT,
    VIEW_FACING,
    Control,
    Group,
    controls_of,
    require_valid,
    scale_of,
    title_of,
)
from sambot_viz.displays.data.interactive_markers.menu import menu_of
from sambot_viz.displays.data.markers.marker_fields import MarkerPose
from sambot_viz.displays.data.message_numbers import point_of, wxyz_of
from sambot_viz.displays.display import DisplayContext
from sambot_viz.frames import LookupRefused, Transform
from sambot_viz.geometry import (
    IDENTITY,
    Matrix,
    Vector3,
    Wxyz,
    rotation_from_xyzw,
    unit_wxyz,
    wxyz_from_matrix,
    wxyz_product,
)
from sambot_viz.topics.decoding import frame_and_stamp


@dataclass(frozen=True, slots=True, eq=False)
class ControlPart:
    """A marker of a control, with its place.

    Attributes:
        control: its control; "" for the description.
        group: the controls that it is turned and hidden with.
        marker: the drawn fields.
        place: pose of its own frame in its group.
    """

    control: str
    group: Group
    marker: ControlMarker
    place: MarkerPose


class KnownMarker:
    """An interactive marker that has come.

    Args:
        message: a visualization_msgs/InteractiveMarker.
        nodes: draw it.

    Raises:
        MessageRefused: it has numbers that cannot be drawn.

    Attributes:
        nodes: as given.
        scale: size [m].
        frame: the frame of its pose.
        shown: the numbers of its shown parts.
        drawn: the drawn parts, and their options.
        wrong: the fault of one of them; empty without any.
        refused: why the last message was rejected; empty if it was accepted.
        controls: name → drawn control.
        menu: its menu.
        is_held: whether a user is dragging it.
        later: updates from messages during a drag, applied after it.
    """

    def __init__(self, message: Any, nodes: InteractiveMarkerNodes) -> None:
        require_valid(message)
        self.nodes = nodes
        self.scale = scale_of(message)
        self.shown: list[int] = []
        self.drawn: object = None
        self.wrong = self.refused = ""
        self._message = message
        self.frame, self._stamp_ns = frame_and_stamp(message)
        self._wxyz = wxyz_of(message.pose.orientation)
        self._position = point_of(message.pose.position)
        self._T_fixed_frame: Transform | None = None
        self._parts: tuple[ControlPart, ...] | None = None
        self.controls: dict[str, Control] = {}
        self.menu = menu_of(message)
        self.is_held = False
        self.later: dict[str, Callable[[], None]] = {}

    @property
    def is_locked(self) -> bool:
        """Whether it follows its frame; else it stays where that was."""
        return self._stamp_ns is None

    def move(self, message: Any) -> None:
        """Take another pose, a visualization_msgs/InteractiveMarkerPose.

        Raises:
            MessageRefused: it is not finite.
        """
        self._wxyz = wxyz_of(message.pose.orientation)
        self._position = point_of(message.pose.position)
        frame, stamp_ns = frame_and_stamp(message)
        self.refused = ""
        if frame:
            self.frame, self._stamp_ns = frame, stamp_ns
        self._T_fixed_frame = None

    def place_again(self) -> None:
        """Forget where frames were: they are looked up again."""
        self._T_fixed_frame = self._parts = None

    def place(self, context: DisplayContext) -> tuple[str, Wxyz, Vector3]:
        """Return the node that it hangs below, and its rotation and position [m] there.

        Raises:
            LookupRefused: its frame has no place in the fixed frame, or not yet.
        """
        fixed = context.fixed_frame
        if self._stamp_ns is None:
            if self.frame != fixed:
                context.tree.lookup(fixed, self.frame)
            return context.above(self.frame), self._wxyz, self._position
        if self._T_fixed_frame is None:
            found = context.tree.lookup(fixed, self.frame, self._stamp_ns)
            self._T_fixed_frame = found
        T = self._T_fixed_frame
        x, y, z, w = T.rotation_xyzw
        at = T.matrix @ np.array([*self._position, 1.0])
        wxyz = wxyz_product((w, x, y, z), self._wxyz)
        return "", wxyz, (float(at[0]), float(at[1]), float(at[2]))

    # A hand that moves it

    def pose(self, context: DisplayContext) -> Matrix | None:
        """Return T_fixed_marker, (4, 4); None when its frame has no place."""
        try:
            _, wxyz, position = self.place(context)
        except LookupRefused:
            return None
        T_fixed_above = context.pose(self.frame) if self.is_locked else np.eye(4)
        return (
            None if T_fixed_above is None else T_fixed_above @ _matrix(wxyz, position)
        )

    def reference(self, context: DisplayContext) -> Matrix | None:
        """Return T_fixed_frame, (4, 4), of the frame that its pose is in."""
        if self.is_locked:
            return context.pose(self.frame)
        return None if self._T_fixed_frame is None else self._T_fixed_frame.matrix

    def put(self, T_fixed_marker: Matrix, context: DisplayContext) -> None:
        """Take another pose from a hand; without a place of its frame nothing."""
        T_fixed_frame = self.reference(context)
        if T_fixed_frame is not None:
            T = np.linalg.inv(T_fixed_frame) @ T_fixed_marker
            self._wxyz = unit_wxyz(wxyz_from_matrix(T))
            x, y, z = T[:3, 3].tolist()
            self._position = (x, y, z)

    # Its controls

    def group_poses(
        self, context: DisplayContext, facing: Matrix | None
    ) -> Mapping[str, Matrix]:
        """Return where groups of controls are.

        Args:
            context: has the frames.
            facing: rotation of what faces the view, (4, 4); None for those only that
                any tool shows and the view does not turn.

        Returns:
            Name of the node of a group → T_fixed_group, (4, 4).
        """
        try:
            _, wxyz, position = self.place(context)
        except LookupRefused:
            return {}
        T_fixed_above = context.pose(self.frame) if self.is_locked else np.eye(4)
        if T_fixed_above is None:
            return {}
        found: dict[str, Matrix] = {}
        for group in dict.fromkeys(part.group for part in self._parts or ()):
            turn = wxyz if group.turning == INHERIT else IDENTITY
            T_fixed_group = T_fixed_above @ _matrix(turn, position)
            if group.turning == VIEW_FACING and facing is not None:
                T_fixed_group[:3, :3] = facing[:3, :3]
            elif facing is None and (
                group.turning == VIEW_FACING or not group.is_always
            ):
                continue
            found[self.nodes.path(group)] = T_fixed_group
        return found

    def control_of(self, number: int) -> Control | None:
        """Return the control of a part; None for the description."""
        part = self._parts[number] if self._parts else None
        return None if part is None else self.controls.get(part.control)

    def parts(
        self, context: DisplayContext, *, transparency: bool
    ) -> Sequence[ControlPart]:
        """Return the drawn parts of its controls; the description is the last one.

        A part with its own frame is placed there once, in the first call.

        Args:
            context: the context, with the frames.
            transparency: whether handles keep their alpha.

        Raises:
            LookupRefused: a part's own frame has no place.
        """
        if self._parts is None:
            controls = controls_of(self._message, is_transparent=transparency)
            self.controls = {one.name: one for one in controls}
            title = title_of(self._message)
            made = [part for c in controls for part in self._parts_of(c, context)]
            if title is not None:
                made += self._parts_of(title, context)
            self._parts = tuple(made)
        return self._parts

    def _parts_of(
        self, control: Control, context: DisplayContext
    ) -> Iterator[ControlPart]:
        turning = control.group.turning
        w, x, y, z = control.wxyz
        # The x axis of the control is what faces the view.
        turned = Transform.trusted(
            _matrix((w, -x, -y, -z) if turning == VIEW_FACING else IDENTITY)
        )
        for marker in control.markers:
            place = MarkerPose(turned) if turning == VIEW_FACING else MarkerPose()
            if marker.frame:
                _, wxyz, position = self.place(context)
                T_group = _matrix(wxyz if turning == INHERIT else IDENTITY, position)
                T_fixed = self._reference(context, marker)
                found = Transform.trusted(T_group).inverse() @ T_fixed
                place = MarkerPose(turned @ found)
            yield ControlPart(control.name, control.group, marker, place)

    def _reference(self, context: DisplayContext, marker: ControlMarker) -> Transform:
        """Return the pose of a marker's own frame in the frame of this one."""
        target = self.frame if self.is_locked else context.fixed_frame
        return context.tree.lookup(target, marker.frame, marker.stamp_ns)


def _matrix(wxyz: Wxyz, position: Vector3 = (0.0, 0.0, 0.0)) -> Matrix:
    w, x, y, z = wxyz
    matrix = np.eye(4)
    matrix[:3, :3] = rotation_from_xyzw((x, y, z, w))
    matrix[:3, 3] = position
    return matrix

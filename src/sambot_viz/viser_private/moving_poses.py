"""The poses of nodes that move: kept up to date in place, and sent as one message.

viser makes a message for each pose, puts it behind all others and takes out the one
before; each is packed with the name of its node. Here the message that tells a pose
first has a number. Later the pose is changed in that message, where it is, so that
viser's buffer has the newest one for who comes later; and who has had the message gets
all that has moved since as one message of numbers and values, which is among viser's
messages in the order of the changes.

viser_poses.js takes both apart again, before viser sees them.
"""

from __future__ import annotations

import itertools
import struct
from typing import Any, cast

import viser
from viser import (
    _messages,  # pyright: ignore[reportPrivateUsage]
)

from sambot_viz.geometry import Vector3, Wxyz

FRAME = "~poses"
"""The name in a message with what has moved. To viser it is the position of a node that
is not there."""
_KINDS: dict[str, Any] = {
    "wxyz": _messages.SetOrientationMessage,
    "position": _messages.SetPositionMessage,
}
_pairs = itertools.count(1)
"""Rotations have even numbers, positions odd ones; each number has one meaning as long
as the program runs, so a node that is made again with the same name has others."""


class _Track:
    """A rotation or a position of one node.

    Attributes:
        number: which one it is, for pages.
        state: viser's of the node.
        message: viser's, with the newest value.
        place: the number of the message in its buffer.
        value: the newest one.
        frame: the number of the frame in which it has moved last.
    """

    __slots__ = ("frame", "message", "number", "place", "state", "value")

    def __init__(self, number: int, state: Any, message: Any, place: int) -> None:
        self.number = number
        self.state = state
        self.message = message
        self.place = place
        self.value: tuple[float, ...] = ()
        self.frame = -1


class MovingPoses:
    """What moves in one buffer of messages.

    Args:
        buffer: viser's; it has a frame, which stands for what has moved.
    """

    def __init__(self, buffer: Any) -> None:
        self._buffer = buffer
        self._tracks: dict[tuple[str, str], _Track] = {}
        # By number; the one that has moved last is the last one.
        self._moved: dict[int, _Track] = {}
        self._frame = _messages.SetPositionMessage(FRAME, (0.0, 0.0, 0.0))
        # It says nothing to those who read the scene from the buffer.
        vars(self._frame)["include_in_scene_serialization"] = False
        self._place = -1
        # Whether the change goes on in which the frame was put where it is.
        self._is_open = False
        self._sweep_at = 1000
        buffer.sambot_poses = self

    @staticmethod
    def of(buffer: Any) -> MovingPoses:
        """Return what moves in a buffer."""
        found = _poses_of(buffer)
        return MovingPoses(buffer) if found is None else found

    def move(self, state: Any, kind: str, value: tuple[float, ...]) -> bool:
        """Change a pose in place; False where its message is not there.

        Args:
            state: viser's of the node.
            kind: "wxyz" or "position".
            value: of this kind.
        """
        track, buffer = self._tracks.get((state.name, kind)), self._buffer
        if track is None or track.state is not state:
            return False
        with buffer.buffer_lock:
            if buffer.persistent_messages:
                # A program may have moved it by viser's own setter.
                there = buffer.message_from_id.get(track.place)
                if there is not track.message:
                    return False
            track.value = value
            setattr(track.message, kind, value)
            if not self._is_open:
                self._put_frame()
            if track.frame != self._place:
                track.frame = track.message.moved_in = self._place
                self._moved.pop(track.number, None)
                self._moved[track.number] = track
        return True

    def tell(self, state: Any, kind: str, value: tuple[float, ...]) -> None:
        """Send a pose as viser does, with a number for what comes later; see `move`."""
        key = (state.name, kind)
        before = self._tracks.get(key)
        if before is not None and before.state is state:
            number = before.number
        else:
            number = 2 * next(_pairs) + (kind == "position")
        message = _KINDS[kind](state.name, value)
        as_viser = message.as_serializable_dict

        def numbered(arrays: list[memoryview] | None = None) -> dict[str, Any]:
            return {**as_viser(arrays), "number": number}

        message.as_serializable_dict, message.moved_in = numbered, -1
        state.api._queue_scene_message(message)
        buffer = self._buffer
        with buffer.buffer_lock:
            place = buffer.id_from_redundancy_key.get(message.redundancy_key(), -1)
            if before is not None:
                self._moved.pop(before.number, None)
            self._tracks[key] = _Track(number, state, message, place)
            if len(self._tracks) > self._sweep_at:
                self._sweep()

    def change_ended(self) -> None:
        """What moves from now on goes into another frame; the buffer is locked."""
        self._is_open = False

    def is_frame(self, message: Any) -> bool:
        """Tell whether a message stands for what has moved."""
        return message is self._frame

    def between(self, after: int, last: int) -> Any:
        """Return a message with what has moved, but not since, in some frames.

        Args:
            after: the number of the last frame before them; -1 for all.
            last: the number of the last one.
        """
        numbers: list[int] = []
        values: list[float] = []
        with self._buffer.buffer_lock:
            for track in reversed(self._moved.values()):
                if track.frame <= after:
                    break
                if track.frame <= last and not track.state.removed:
                    numbers.append(track.number)
                    values += track.value
        content = struct.pack(
            f"<{1 + len(numbers)}I{len(values)}d", len(numbers), *numbers, *values
        )
        return _messages.SetPositionMessage(FRAME, cast(Any, content))

    def _put_frame(self) -> None:
        """Put the frame behind all other messages, and wake who waits for them."""
        buffer = self._buffer
        buffer.message_from_id.pop(self._place, None)
        self._place = buffer.message_counter
        buffer.message_from_id[self._place] = self._frame
        buffer.message_counter += 1
        # While a change is being made nothing goes out, so the frame can still grow.
        self._is_open = buffer.atomic_counter > 0
        buffer.message_event.set()
        if not self._is_open:
            try:
                buffer.event_loop.call_soon_threadsafe(buffer.message_event.set)
            except RuntimeError:
                # The loop has ended: there are no clients.
                pass

    def _sweep(self) -> None:
        """Forget nodes that are gone."""
        for key in [key for key, track in self._tracks.items() if track.state.removed]:
            self._moved.pop(self._tracks.pop(key).number, None)
        self._sweep_at = 1000 + 2 * len(self._tracks)


def _poses_of(buffer: Any) -> MovingPoses | None:
    return getattr(buffer, "sambot_poses", None)


def set_pose(
    handle: viser.SceneNodeHandle, wxyz: Wxyz | None, position: Vector3 | None
) -> None:
    """Give a node another rotation, position [m] or both, and send them.

    viser's own setters compare every value with the last one by `numpy.allclose`, which
    is two thirds of what a step of a joint costs, and which drops small steps.

    Args:
        handle: the node; it was not removed.
        wxyz: a unit quaternion; None leaves the rotation as it is.
        position: finite numbers; None leaves the position as it is.
    """
    state: Any = handle._impl  # pyright: ignore[reportPrivateUsage]
    if wxyz is not None:
        state.wxyz[:] = wxyz
        _send(state, "wxyz", wxyz)
    if position is not None:
        state.position[:] = position
        _send(state, "position", position)


def _send(state: Any, kind: str, value: tuple[float, ...]) -> None:
    interface = state.api._websock_interface
    poses = _poses_of(interface.get_message_buffer())
    if poses is None:
        # What is drawn without a server is recorded.
        state.api._queue_scene_message(_KINDS[kind](state.name, value))
        return
    with interface._record_lock:
        # viser's recordings of a running scene hear of messages when they are sent.
        if interface._record_handles or not poses.move(state, kind, value):
            poses.tell(state, kind, value)

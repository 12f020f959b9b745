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
from collections.abc import Iterable, Sequence
from contextlib import suppress
from typing import Any, cast

import viser
from viser import (
    _messages,  # pyright: ignore[reportPrivateUsage]
)

from sambot_viz.geometry import Vector3, Wxyz

FRAME = "~"
"""The name in a message with what has moved. To viser it is the position of a node that
is not there."""
_KINDS: dict[str, Any] = {
    "wxyz": _messages.SetOrientationMessage,
    "position": _messages.SetPositionMessage,
}
_TRACKS = {kind: f"sambot_{kind}" for kind in _KINDS}
"""Where a node has its tracks: in viser's state of it."""
_pairs = itertools.count(1)
"""Rotations have even numbers, positions odd ones; each number has one meaning as long
as the program runs, so a node that is made again with the same name has others."""
_SWEEP = 1000
"""Number of surplus tracks at which nodes that are gone are forgotten."""

Value = tuple[float, ...]
Move = tuple[Any, str, Value]
"""viser's state of a node, "wxyz" or "position", and what that is now."""


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
        self.value: Value = ()
        self.frame = -1


class MovingPoses:
    """What moves in one buffer of messages.

    Args:
        buffer: viser's; it has a frame, which stands for what has moved.
    """

    def __init__(self, buffer: Any) -> None:
        self._buffer = buffer
        # By number; the one that has moved last is the last one.
        self._moved: dict[int, _Track] = {}
        self._sweep_at = _SWEEP
        self._frame = _messages.SetPositionMessage(FRAME, (0.0, 0.0, 0.0))
        # It says nothing to those who read the scene from the buffer.
        vars(self._frame)["include_in_scene_serialization"] = False
        self._place = -1
        # Whether the change goes on in which the frame was put where it is.
        self._is_open = False
        buffer.sambot_poses = self

    @staticmethod
    def of(buffer: Any) -> MovingPoses:
        """Return what moves in a buffer."""
        found = _poses_of(buffer)
        return MovingPoses(buffer) if found is None else found

    def move(self, moves: Iterable[Move]) -> list[Move]:
        """Change poses in place.

        Returns:
            Those whose messages are not there.
        """
        left: list[Move] = []
        buffer, moved = self._buffer, self._moved
        with buffer.buffer_lock:
            for move in moves:
                state, kind, value = move
                track = _track_of(state, kind)
                if track is None or self._is_replaced(track):
                    left.append(move)
                    continue
                if not self._is_open:
                    self._put_frame()
                track.value = value
                setattr(track.message, kind, value)
                if track.frame != self._place:
                    track.frame = track.message.moved_in = self._place
                    moved.pop(track.number, None)
                    moved[track.number] = track
            if len(moved) > self._sweep_at:
                self._sweep()
        return left

    def tell(self, move: Move) -> None:
        """Send a pose as viser does, with a number for what comes later; see `move`."""
        state, kind, value = move
        before = _track_of(state, kind)
        if before is None:
            number = 2 * next(_pairs) + (kind == "position")
        else:
            number = before.number
        message = _KINDS[kind](state.name, value)
        as_viser = message.as_serializable_dict

        def numbered(arrays: list[memoryview] | None = None) -> dict[str, Any]:
            return {**as_viser(arrays), "number": number}

        message.as_serializable_dict, message.moved_in = numbered, -1
        state.api._queue_scene_message(message)
        buffer = self._buffer
        with buffer.buffer_lock:
            self._moved.pop(number, None)
            place = buffer.id_from_redundancy_key.get(message.redundancy_key(), -1)
            track = _Track(number, state, message, place)
            setattr(state, _TRACKS[kind], track)

    def change_ended(self) -> None:
        """What moves from now on goes into another frame; the buffer is locked."""
        self._is_open = False

    def is_frame(self, message: Any) -> bool:
        """Return whether a message stands for what has moved."""
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
                if track.frame > last or track.state.removed:
                    continue
                if not self._is_replaced(track):
                    numbers.append(track.number)
                    values += track.value
        content = packed_numbers(numbers) + struct.pack(f"<{len(values)}d", *values)
        return _messages.SetPositionMessage(FRAME, cast(Any, content))

    def _is_replaced(self, track: _Track) -> bool:
        """Return whether a program has moved the node by viser's own setter since."""
        buffer = self._buffer
        # Others are gone as soon as their only client has had them.
        return buffer.persistent_messages and (
            buffer.message_from_id.get(track.place) is not track.message
        )

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
            # A loop that has ended has no clients.
            with suppress(RuntimeError):
                buffer.event_loop.call_soon_threadsafe(buffer.message_event.set)

    def _sweep(self) -> None:
        """Forget nodes that are gone."""
        there = {n: one for n, one in self._moved.items() if not one.state.removed}
        self._moved = there
        self._sweep_at = _SWEEP + 2 * len(there)


def packed_numbers(numbers: Iterable[int]) -> bytes:
    """Return numbers above 0 in seven bits a byte, the lowest first, and a 0 behind."""
    packed = bytearray()
    for number in numbers:
        while number > 127:
            packed.append(128 | (number & 127))
            number >>= 7
        packed.append(number)
    packed.append(0)
    return bytes(packed)


def _track_of(state: Any, kind: str) -> _Track | None:
    return getattr(state, _TRACKS[kind], None)


def _poses_of(buffer: Any) -> MovingPoses | None:
    return getattr(buffer, "sambot_poses", None)


Posed = tuple[viser.SceneNodeHandle, Wxyz | None, Vector3 | None]
"""A node, and its rotation and position [m]; what is None stays."""


def set_pose(
    handle: viser.SceneNodeHandle, wxyz: Wxyz | None, position: Vector3 | None
) -> None:
    """Give a node another rotation, position [m] or both, and send them.

    viser's own setters compare every value with the last one, and drop small steps.

    Args:
        handle: the node; it was not removed.
        wxyz: a unit quaternion; None leaves the rotation as it is.
        position: finite numbers; None leaves the position as it is.
    """
    set_poses([(handle, wxyz, position)])


def set_poses(posed: Iterable[Posed]) -> None:
    """Do the same with several nodes of one scene."""
    moves: list[Move] = []
    state: Any = None
    for handle, wxyz, position in posed:
        state = handle._impl  # pyright: ignore[reportPrivateUsage]
        if wxyz is not None:
            # Each by itself takes half the time of a slice.
            now = state.wxyz
            now[0], now[1], now[2], now[3] = wxyz
            moves.append((state, "wxyz", wxyz))
        if position is not None:
            now = state.position
            now[0], now[1], now[2] = position
            moves.append((state, "position", position))
    if moves:
        _send(state.api, moves)


def _send(api: Any, moves: Sequence[Move]) -> None:
    interface = api._websock_interface
    poses = _poses_of(interface.get_message_buffer())
    if poses is None:
        # What is drawn without a server is recorded.
        for state, kind, value in moves:
            api._queue_scene_message(_KINDS[kind](state.name, value))
        return
    with interface._record_lock:
        # viser's recordings of a running scene hear of messages when they are sent.
        left = moves if interface._record_handles else poses.move(moves)
        for move in left:
            poses.tell(move)

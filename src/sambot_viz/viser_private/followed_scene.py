"""A scene that comes from another server, in the packed frames that its pages get.

The messages go into the buffer of this server as if a program had drawn here, so who
comes later gets what is there then, and a slow page the newest.
"""

from __future__ import annotations

import itertools
import struct
from collections.abc import Iterable, Sequence
from types import SimpleNamespace
from typing import Any, cast

import msgspec.msgpack
import numpy as np
import viser
import zstandard
from viser import (
    _messages,  # pyright: ignore[reportPrivateUsage]
)
from viser.infra import (
    _messages as _infra_messages,  # pyright: ignore[reportPrivateUsage]
)

from sambot_viz.viser_private.moving_poses import (
    FRAME,
    Move,
    MovingPoses,
    Value,
)
from sambot_viz.viser_private.outgoing import MORE_FOLLOWS, broadcast_buffer

_POSES = {"SetOrientationMessage": "wxyz", "SetPositionMessage": "position"}
Fields = dict[str, Any]
_ZSTD = zstandard.ZstdDecompressor()
"""Only one thread unpacks: that of the event loop."""


class FollowedScene:
    """Draws in a server what another one has drawn.

    All is called on the event loop of the server.

    Args:
        server: has nothing in its scene that is not drawn from here.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._api = server.scene
        self._buffer = broadcast_buffer(server)
        self._moving = MovingPoses.of(self._buffer)
        self._atomic = server.atomic
        self._kinds: dict[str, Any] = cast(
            Any, _messages.Message
        )._subclass_from_type_string()
        # Of the other server: the number of a pose → the node, and its kind.
        self._posed: dict[int, tuple[Any, str]] = {}
        self._nodes: dict[str, Any] = {}
        self._waiting: list[Fields] = []

    def take(self, frame: bytes) -> None:
        """Draw what a frame says; what belongs to the next one waits for it.

        Raises:
            ValueError: it is not a frame of a server of the same version.
        """
        messages = unpacked_frame(frame)
        self._waiting += messages
        if not (messages and _is_more(messages[-1])):
            waiting, self._waiting = self._waiting, []
            with self._atomic():
                self._apply(waiting)

    def replace(self, frames: Iterable[bytes], *, same: bool) -> None:
        """Draw all that another server shows, and take away what it does not.

        Args:
            frames: of a page that has just been opened.
            same: whether what is there came from the same server: then what has not
                changed is not sent to the pages again.

        Raises:
            ValueError: as of `take`.
        """
        self._waiting = []
        messages = [one for frame in frames for one in unpacked_frame(frame)]
        made = {one.redundancy_key(): one for one in map(self._message, messages)}
        with self._atomic():
            for key in [*self._buffer.id_from_redundancy_key]:
                if not same or key not in made:
                    self._take_away(self._held(key))
            self._apply(
                fields for fields in messages if not (same and self._is_there(fields))
            )

    def _held(self, key: str) -> Any:
        buffer = self._buffer
        return buffer.message_from_id.get(buffer.id_from_redundancy_key.get(key))

    def _is_there(self, fields: Fields) -> bool:
        if fields.get("number") is not None:
            return False
        held = self._held(self._message(fields).redundancy_key())
        return held is not None and _same(getattr(held, "followed", None), fields)

    def _take_away(self, held: Any) -> None:
        """Take away a node or a widget."""
        if getattr(held, "lifecycle_phase", None) != "create":
            return
        if held.entity_type == "scene":
            self._put({"type": "RemoveSceneNodeMessage", "name": held.name})
        elif held.entity_type == "gui":
            self._put({"type": "GuiRemoveMessage", "uuid": held.uuid})

    def _apply(self, messages: Iterable[Fields]) -> None:
        for fields in messages:
            if fields.get("name") == FRAME:
                self._move(fields["position"])
            elif not _is_more(fields):
                self._put(fields)

    def _put(self, fields: Fields) -> None:
        kind, number = fields["type"], fields.get("number")
        if kind in _POSES and number is not None:
            self._pose(fields["name"], _POSES[kind], number, fields)
            return
        message = self._message(fields)
        if message.entity_type == "scene" and message.lifecycle_phase != "update_dict":
            self._forget(message)
        self._buffer.push(message)

    def _forget(self, message: Any) -> None:
        """Forget the poses of a node that is gone, or made again."""
        if message.lifecycle_phase not in ("create", "remove"):
            return
        self._buffer.remove_entity_state_from_buffer("scene", message.name)
        node = self._nodes.pop(message.name, None)
        if node is not None:
            node.removed = True
            self._posed = {n: at for n, at in self._posed.items() if at[0] is not node}

    def _pose(self, name: str, kind: str, number: int, fields: Fields) -> None:
        node = self._nodes.get(name)
        if node is None:
            node = SimpleNamespace(name=name, api=self._api, removed=False)
            self._nodes[name] = node
        value = tuple(fields[kind])
        if self._posed.get(number) != (node, kind):
            self._posed[number] = (node, kind)
            setattr(node, kind, value)
            self._moving.tell((node, kind, value))
        elif getattr(node, kind) != value:
            self._change([(node, kind, value)])

    def _move(self, content: bytes) -> None:
        self._change(
            (*self._posed[number], value)
            for number, value in unpacked_poses(content)
            if number in self._posed
        )

    def _change(self, moves: Iterable[Move]) -> None:
        changed = [*moves]
        for node, kind, value in changed:
            setattr(node, kind, value)
        for move in self._moving.move(changed):
            self._moving.tell(move)

    def _message(self, fields: Fields) -> Any:
        """Return a message of viser that says what another server has said."""
        kind = self._kinds.get(fields["type"])
        if kind is None:
            raise ValueError(f"viser has no message {fields['type']}")
        message = kind.__new__(kind)
        own = cast(Fields, vars(message))
        own.update(fields)
        own.setdefault("owner", "")
        del own["type"]
        if isinstance(own.get("props"), dict):
            # As it is in a message that was made here: it is asked for its length.
            own["props"] = SimpleNamespace(**own["props"])

        def as_sent(arrays: list[memoryview] | None = None) -> Fields:
            return _prepared(fields, arrays)

        own["as_serializable_dict"], own["followed"] = as_sent, fields
        return message


def _prepared(fields: Fields, arrays: list[memoryview] | None) -> Fields:
    prepare: Any = _infra_messages._prepare_for_serialization  # pyright: ignore[reportPrivateUsage]
    return prepare(fields, dict, arrays)


def _is_more(fields: Fields) -> bool:
    return fields.get("name") == MORE_FOLLOWS


def _same(one: Any, two: Any) -> bool:
    """Return whether two messages say the same."""
    if isinstance(one, np.ndarray) or isinstance(two, np.ndarray):
        return np.array_equal(cast(Any, one), cast(Any, two))
    if isinstance(one, dict) and isinstance(two, dict):
        a, b = cast(Fields, one), cast(Fields, two)
        return a.keys() == b.keys() and all(_same(a[key], b[key]) for key in a)
    return bool(one == two)


def unpacked_frame(frame: bytes) -> list[Fields]:
    """Return the messages in a packed frame, with their arrays.

    Raises:
        ValueError: it is not a packed frame.
    """
    # As viser writes it: two lengths, the messages, and each array behind zeros to a
    # multiple of eight.
    try:
        size, packed = (int.from_bytes(frame[at : at + 8], "little") for at in (0, 8))
        place = 16 + packed
        content = _ZSTD.decompress(frame[16:place], max_output_size=size)
        decoded: Fields = msgspec.msgpack.decode(content)
        arrays: list[memoryview] = []
        for length in decoded["binaryBufferLengths"]:
            place += -place % 8
            arrays.append(memoryview(frame)[place : place + length])
            place += length
        return [_filled(message, arrays) for message in decoded["messages"]]
    except (zstandard.ZstdError, msgspec.DecodeError, LookupError, TypeError) as error:
        raise ValueError(f"not a packed frame: {error}") from error


def _filled(value: Any, arrays: Sequence[memoryview]) -> Any:
    """Put the arrays where they belong."""
    if isinstance(value, dict):
        fields = cast(Fields, value)
        if _infra_messages.is_binary_placeholder(fields):
            place, kind = int(fields["__binary_index"]), str(fields["dtype"])
            return np.frombuffer(arrays[place], kind)
        return {key: _filled(part, arrays) for key, part in fields.items()}
    if isinstance(value, list):
        return [_filled(part, arrays) for part in cast("list[Any]", value)]
    return value


def unpacked_poses(content: bytes) -> list[tuple[int, Value]]:
    """Return what has moved, from the content of a frame of poses.

    Returns:
        The number of each pose, and its value: of four numbers or three.

    Raises:
        ValueError: it is no such content.
    """
    numbers: list[int] = []
    number = shift = place = 0
    while place < len(content):
        byte = content[place]
        place += 1
        if byte == 0 and shift == 0:
            break
        number |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            numbers.append(number)
            number = shift = 0
    lengths = [3 if number % 2 else 4 for number in numbers]
    try:
        values = iter(struct.unpack(f"<{sum(lengths)}d", content[place:]))
    except struct.error as error:
        raise ValueError(f"not a frame of poses: {error}") from error
    return [
        (number, tuple(itertools.islice(values, length)))
        for number, length in zip(numbers, lengths, strict=True)
    ]

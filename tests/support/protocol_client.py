"""A light browser without a picture: it speaks viser's protocol and records it.

    def test_one_step_is_one_message(protocol, server):
        client = protocol(server.port)                    # connected, replay received
        mark = client.mark()
        client.set_value(client.uuid_of("left wheel"), 0.5)
        client.settle(server)                             # all effects have arrived
        assert [m.type for m in client.since(mark)] == ["SetOrientationMessage"]

What it offers:

    client.messages            every message so far, oldest first (`Received`)
    client.mark(), .since(m)   a place in that list, and what came after it
    client.types(since=m)      how many of each type, as a Counter
    client.node(name)          the last message that created this scene node
    client.rows                the rows of the panels by id, as the page has them now
    client.row(id)             one of them
    client.row_named(*names)   by panel, names of rows above it, and its name
    client.id_of(*names)       its id; client.shown(*names) is what it shows
    client.edit(id, value)     what the page sends when a user changes a row
    client.act(id, *values)    what a button, a key or a menu sends
    client.uuid_of(label)      a widget that a program has added; .widgets for all
    client.value_of(label)     the widget's value as the server last sent it
    client.set_value(uuid, v)  what a browser sends when a widget was moved
    client.send(type, **f)     any other message
    client.wait_until(cond)    until cond() is true; fails after `timeout` seconds
    client.settle(server)      a fence, see below
    client.ticket, .channel_code   which page it is, and how its channel has ended
    client.close()

`settle` proves without sleeping that "nothing arrived" is final. The client writes to
a text field of its own; the server's answer takes the same way as everything
that was queued before it, once through the buffer of all browsers and once through the
buffer of this one; and a ping of the page's own channel is answered behind the rows.
Both keep the order in both directions, so what was sent before has been handled
(as far as its callbacks are `async def` and wait for nothing but the sessions'
workers), and every message that came of it has arrived, changes of
rows too, which are held back for a moment. What a program holds back for longer, such
as the later poses of a stream, comes when its timer says so: wait for that with
`wait_until`. The messages of the fence itself are left out of `messages`.
"""

from __future__ import annotations

import asyncio
import json
import math
import secrets
import threading
import time
import weakref
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, cast

import msgspec.msgpack
import viser
import zstandard
from hand_clock import HandClock
from page_rows import PageRows, Row, decode, named
from patience import patience, until
from pose_tracks import PoseTracks
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from sambot_viz.panels.row_sync import PERIOD
from sambot_viz.server.channel import PING, PONG, SUBPROTOCOL
from sambot_viz.session.worker import Worker

ROW_PATCH = "RowPatch"
"""The type in `messages` of what the channel brings: changes of rows."""
CAMERA_ASKED = "CameraAsked"
"""The same for the camera that the page is asked for, and the frame to follow."""
ROWS_TIME = 5.0
"""How long the first rows are waited for [s]."""
FENCE_REQUEST = "~fence request"
FENCE_REPLY = "~fence reply"
CAMERA: dict[str, Any] = {
    "wxyz": (0.5, -0.5, -0.5, 0.5),
    "position": (3.0, 0.0, 0.0),
    "fov": 0.785,
    "near": 0.01,
    "far": 1000.0,
    "image_height": 480,
    "image_width": 640,
    "look_at": (0.0, 0.0, 0.0),
    "up_direction": (0.0, 0.0, 1.0),
}
"""What `send_camera` reports."""
_fences: weakref.WeakKeyDictionary[viser.ViserServer, _Fence] = (
    weakref.WeakKeyDictionary()
)


@dataclass(frozen=True)
class Received:
    """One message.

    Attributes:
        type: its class in viser, such as "SetOrientationMessage".
        fields: what it says, by field name; arrays as their raw bytes.
        size: bytes of the message alone, not compressed, arrays included.
        frame: number of the websocket frame it came in, from 0.
        frame_size: bytes of that whole frame as it was on the wire.
        at: when it arrived (`time.perf_counter`) [s].
    """

    type: str
    fields: dict[str, Any]
    size: int
    frame: int
    frame_size: int
    at: float


class ProtocolClient:
    """One connection that records; the module's docstring lists what it offers."""

    def __init__(
        self,
        port: int,
        host: str = "127.0.0.1",
        *,
        camera: bool = True,
        path: str = "",
        headers: Mapping[str, str] | None = None,
        ticket: str = "",
    ):
        """Connect, wait for the end of the replay, and report a camera pose.

        Args:
            port: where the server listens.
            host: name or address of the server.
            camera: viser hands a browser to the program when the first camera pose
                arrives; False leaves that out.
            path: of the address, such as "/copy" or "/?token=…".
            headers: what a browser would send too, such as its cookies.
            ticket: which page it belongs to; "" for a new one.
        """
        self._changed = threading.Condition()
        self._messages: list[Received] = []
        self._fence_uuids: set[str] = set()
        self._fence_values: dict[str, str] = {}
        self._fence_count = 0
        # What goes out to all does not reach a browser with a copy of its own.
        self._sides = ("own",) if path.startswith("/copy") else ("all", "own")
        self._frames = 0
        self._page_rows = PageRows()
        self._tracks = PoseTracks()
        self._pongs = 0
        self.replayed = False
        self.closed = False
        self.ticket = ticket or secrets.token_urlsafe(16)
        ticket = f"{'&' if '?' in path else '?'}ticket={self.ticket}"

        def open_socket(subprotocol: str) -> ClientConnection:
            return connect(
                f"ws://{host}:{port}{path}{ticket}",
                subprotocols=[Subprotocol(subprotocol)],
                additional_headers=headers,
                max_size=None,
                compression=None,
                # A student's page of a class begins with a server of its own.
                open_timeout=patience(20.0),
            )

        self._socket = open_socket(f"viser-v{viser.__version__}")
        self._channel = open_socket(SUBPROTOCOL)
        self._threads = [
            threading.Thread(target=read, daemon=True)
            for read in (self._read, self._read_channel)
        ]
        for thread in self._threads:
            thread.start()
        self.wait_until(lambda: self.replayed)
        if camera:
            self.send_camera()

    # What arrived.

    @property
    def messages(self) -> list[Received]:
        """Every message so far, oldest first, without those of the fence."""
        with self._changed:
            return list(self._messages)

    def mark(self) -> int:
        """The present end of `messages`."""
        with self._changed:
            return len(self._messages)

    def since(self, mark: int) -> list[Received]:
        """The messages that came after `mark`."""
        return self.messages[mark:]

    def types(self, since: int = 0) -> Counter[str]:
        """How many messages of each type came after `since`."""
        return Counter(message.type for message in self.since(since))

    @property
    def widgets(self) -> dict[str, str]:
        """Label → uuid of the widgets that the server created."""
        found: dict[str, str] = {}
        for message in self.messages:
            label = message.fields.get("props", {}).get("label")
            if label is not None and "uuid" in message.fields:
                found[label] = message.fields["uuid"]
        return found

    def uuid_of(self, label: str) -> str:
        """The uuid of the newest widget with this label."""
        widgets = self.widgets
        if label not in widgets:
            raise AssertionError(f"no widget '{label}'; there are {sorted(widgets)}")
        return widgets[label]

    def value_of(self, label: str) -> Any:
        """The value that the server last gave to the widget with this label."""
        uuid = self.uuid_of(label)
        value: Any = None
        for message in self.messages:
            if message.fields.get("uuid") != uuid:
                continue
            if "value" in message.fields:
                value = message.fields["value"]
            value = message.fields.get("updates", {}).get("value", value)
        return value

    def node(self, name: str) -> Received:
        """The last message that created the scene node `name`."""
        for message in reversed(self.messages):
            if message.fields.get("name") == name and "props" in message.fields:
                return message
        raise AssertionError(f"no scene node '{name}'")

    @property
    def rows(self) -> dict[str, Row]:
        """The rows of all panels by id, in order, as the page has them now."""
        with self._changed:
            scopes = self._page_rows.scopes
            self._changed.wait_for(lambda: len(scopes) >= 2 or self.closed, ROWS_TIME)
            return self._page_rows.by_id()

    def row(self, row_id: str) -> Row:
        """The row with this id."""
        rows = self.rows
        if row_id not in rows:
            raise AssertionError(f"no row '{row_id}'; there are {list(rows)}")
        return rows[row_id]

    def row_named(self, *names: str) -> Row:
        """The row of a panel with this name: ("joints", "left_wheel_joint")."""
        return named(self.rows, names)

    def id_of(self, *names: str) -> str:
        """The id of the row that `row_named` finds."""
        return str(self.row_named(*names)["id"])

    def shown(self, *names: str) -> Any:
        """What the row that `row_named` finds shows."""
        return self.row_named(*names).get("value")

    # What is sent.

    def send(self, type: str, **fields: Any) -> None:
        """Send the viser message `type` with these fields."""
        self.send_raw(msgspec.msgpack.encode({"type": type, **fields}))

    def send_raw(self, data: bytes | str) -> None:
        """Send a frame as it is."""
        self._socket.send(data)

    def send_camera(self) -> None:
        """Report a camera 3 m in front of the origin, 640 x 480 pixels."""
        self.send("ViewerCameraMessage", **CAMERA)

    def set_value(self, uuid: str, value: Any) -> None:
        """Move a widget as a browser does."""
        self.send("GuiUpdateMessage", uuid=uuid, updates={"value": value})

    def edit(self, row_id: str, value: Any, gesture: int | None = None) -> None:
        """Set a row; with the same number for all values of one drag."""
        edit = [row_id, value] if gesture is None else [row_id, value, gesture]
        self.send_edit(edit)

    def send_edit(self, edit: Any) -> None:
        """Send anything through the channel, as the page sends edits and cameras."""
        self._channel.send(json.dumps(_as_in_a_page(edit)))

    def act(self, row_id: str, *values: Any) -> None:
        """Do what an action row does."""
        self.edit(row_id, list(values))

    # Waiting.

    def wait_until(self, condition: Callable[[], bool], timeout: float = 10.0) -> None:
        """Return when `condition()` is true; it is asked after every frame, and between
        them for what no frame reports, such as a file.

        Raises:
            AssertionError: it did not become true within `timeout` seconds.
        """
        last = time.monotonic() + patience(timeout)
        with self._changed:
            while not (condition() or self.closed) and time.monotonic() < last:
                self._changed.wait(0.05)
            if not condition():
                end = "the connection ended" if self.closed else f"{timeout} s passed"
                counts = dict(Counter(m.type for m in self._messages))
                raise AssertionError(f"{end} while waiting; received {counts}")

    def settle(self, server: viser.ViserServer, timeout: float = 10.0) -> None:
        """Wait until everything caused so far has arrived (see above)."""
        if server not in _fences:
            _fences[server] = _Fence(server)

        def is_built() -> bool:
            _fences[server].build()
            return self._fence_request is not None

        self.wait_until(is_built, timeout)
        # What was sent through the channel is handled before the fence is.
        self._ping(timeout)
        self._fence_count += 1
        wanted = {f"{side} {id(self)} {self._fence_count}" for side in self._sides}
        uuid = cast(str, self._fence_request)
        self.set_value(uuid, f"{id(self)} {self._fence_count}")
        self.wait_until(lambda: wanted <= set(self._fence_values.values()), timeout)
        # The answer comes behind all rows that have changed so far.
        self._ping(timeout)

    def settle_channel(self, timeout: float = 10.0) -> None:
        """Wait until all that was sent through the channel has been handled."""
        self._ping(timeout)

    def _ping(self, timeout: float) -> None:
        wanted = self._pongs + 1
        try:
            self._channel.send(PING)
        except ConnectionClosed:
            # A server of viser alone has no channels.
            return
        self.wait_until(lambda: self._pongs >= wanted, timeout)

    def close(self) -> None:
        """End both connections and the threads that read them."""
        self._channel.close()
        self._socket.close()
        for thread in self._threads:
            thread.join(timeout=5.0)

    # The reading thread.

    _fence_request: str | None = None

    def _read(self) -> None:
        try:
            for frame in self._socket:
                received = decode_frame(cast(bytes, frame), self._frames)
                with self._changed:
                    self._frames += 1
                    for message in received:
                        for one in self._unpacked(message):
                            self._record(one)
                    self._changed.notify_all()
        except ConnectionClosed:
            pass
        finally:
            with self._changed:
                self.closed = True
                self._changed.notify_all()

    @property
    def channel_code(self) -> int | None:
        """The code that the server has closed the page's own channel with."""
        return self._channel.close_code

    def _read_channel(self) -> None:
        try:
            for frame in self._channel:
                with self._changed:
                    self._take_channel(frame)
                    self._changed.notify_all()
        except ConnectionClosed:
            pass
        finally:
            with self._changed:
                # One that has brought nothing may belong to a server without panels.
                self.closed = self.closed or bool(self._page_rows.scopes)
                self._changed.notify_all()

    def _take_channel(self, frame: str | bytes) -> None:
        if frame == PONG:
            self._pongs += 1
            return
        patch = decode(frame)
        kind = CAMERA_ASKED if patch["of"] == "camera" else ROW_PATCH
        if kind == ROW_PATCH:
            self._page_rows.take(patch)
        size, on_wire = len(json.dumps(patch)), len(frame)
        now = time.perf_counter()
        self._messages.append(Received(kind, patch, size, self._frames, on_wire, now))
        self._frames += 1

    def _unpacked(self, message: Received) -> list[Received]:
        """What viser sees of a message in a page."""
        found = self._tracks.unpacked(message.type, message.fields)
        return [
            replace(
                message,
                type=fields.pop("type", message.type),
                fields=fields,
                size=message.size // len(found),
            )
            for fields in found
        ]

    def _record(self, message: Received) -> None:
        fields = message.fields
        label = fields.get("props", {}).get("label")
        if label in (FENCE_REQUEST, FENCE_REPLY):
            self._fence_uuids.add(fields["uuid"])
            if label == FENCE_REQUEST:
                self._fence_request = fields["uuid"]
            else:
                self._fence_values[fields["uuid"]] = fields["value"]
        elif fields.get("uuid") in self._fence_uuids:
            if fields.get("updates", {}).get("value") is not None:
                self._fence_values[fields["uuid"]] = fields["updates"]["value"]
        else:
            self._messages.append(message)
            self.replayed = self.replayed or message.type == "ReplayDoneMessage"


def _as_in_a_page(value: Any) -> Any:
    """What JSON of a page has in place of a value: it has no infinite numbers."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, list | tuple):
        return [_as_in_a_page(part) for part in cast(list[Any], value)]
    return value


def decode_frame(data: bytes, number: int = 0) -> list[Received]:
    """The messages in one websocket frame of viser's server.

    The frame starts with two little-endian 64-bit lengths (msgpack unpacked, packed),
    then the packed msgpack, then the arrays, each aligned to 8 bytes.
    """
    now = time.perf_counter()
    unpacked_size = int.from_bytes(data[:8], "little")
    packed_end = 16 + int.from_bytes(data[8:16], "little")
    content = zstandard.ZstdDecompressor().decompress(
        data[16:packed_end], max_output_size=unpacked_size
    )
    decoded: dict[str, Any] = msgspec.msgpack.decode(content)
    arrays: list[bytes] = []
    position = packed_end
    for length in decoded["binaryBufferLengths"]:
        position += -position % 8
        arrays.append(data[position : position + length])
        position += length
    received: list[Received] = []
    messages: list[dict[str, Any]] = decoded["messages"]
    for fields in messages:
        size = len(msgspec.msgpack.encode(fields))
        used: list[bytes] = []
        filled = _fill_arrays(fields, arrays, used)
        kind: str = filled.pop("type")
        size += sum(map(len, used))
        received.append(Received(kind, filled, size, number, len(data), now))
    return received


def _fill_arrays(value: Any, arrays: list[bytes], used: list[bytes]) -> Any:
    """Put the arrays into the places kept for them; `used` collects this message's."""
    if isinstance(value, list):
        return [_fill_arrays(v, arrays, used) for v in cast(list[Any], value)]
    if isinstance(value, dict):
        fields = cast(dict[str, Any], value)
        if "__binary_index" in fields and "dtype" in fields:
            array = arrays[int(fields["__binary_index"])]
            used.append(array)
            return array
        return {k: _fill_arrays(v, arrays, used) for k, v in fields.items()}
    return value


def wait_for_workers(timeout: float = 10.0, put_off: float = 0.0) -> None:
    """Wait until the sessions' threads have run what was posted so far.

    That goes two rounds deep: what an action of the first round posts is waited for,
    and also the changes of rows that it has put off. A clock that a test moves goes on
    by as much.

    Args:
        timeout: how long each round may take [s].
        put_off: wait also for what was put off for so long before [s].
    """
    for delay in (put_off, PERIOD):
        # All of them at the same time: a browser test has several sessions open.
        waited: list[tuple[Worker, threading.Event]] = []
        for thread in threading.enumerate():
            if isinstance(thread, Worker):
                done = threading.Event()
                thread.post_later(delay, partial(_behind_all, thread, done.set))
                if isinstance(thread.clock, HandClock):
                    thread.clock.advance(delay)
                waited.append((thread, done))
        # A worker that is closed meanwhile drops what was posted to it.
        until(
            lambda waited=waited: all(
                done.is_set() or not thread.is_alive() for thread, done in waited
            ),
            timeout,
            "a session hangs",
        )


def _behind_all(worker: Worker, action: Callable[[], None]) -> None:
    """Run an action when what waits now is done, for whichever client it waits."""
    with worker._changed:  # pyright: ignore[reportPrivateUsage]
        clients = {*worker._inbox, None}  # pyright: ignore[reportPrivateUsage]
        left = set(clients)

        def done(client: int | None) -> None:
            left.discard(client)
            if not left:
                action()

        for client in clients:
            worker.post(partial(done, client), client=client)


class _Fence:
    """The text fields of `settle` on one server.

    Every browser has a field to write to of its own, because not every browser may
    write to one that all have.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._reply = server.gui.add_text(FENCE_REPLY, "", visible=False)
        self._own: dict[int, viser.GuiTextHandle] = {}

    def build(self) -> None:
        """Give a field to each browser that has none."""
        for client_id, client in self._server.get_clients().items():
            if client_id not in self._own:
                own = client.gui.add_text(FENCE_REPLY, "", visible=False)
                self._own[client_id] = own
                client.gui.add_text(FENCE_REQUEST, "").on_update(self._answer)
                client.flush()

    async def _answer(self, event: viser.GuiEvent[viser.GuiTextHandle]) -> None:
        client, value = event.client, event.target.value
        if client is None or event.client_id is None:
            return
        await asyncio.to_thread(wait_for_workers)
        self._reply.value = f"all {value}"
        self._own[event.client_id].value = f"own {value}"
        self._server.flush()
        client.flush()

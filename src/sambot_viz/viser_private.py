"""Every use of a private name of viser, each with its reason and a test.

viser is pinned to a minor version (pyproject.toml); tests/test_viser_private.py fails
when one of these names has moved.
"""

from __future__ import annotations

import asyncio
import contextlib
import functools
import logging
import secrets
import threading
import weakref
from collections.abc import (
    Awaitable,
    Callable,
    Coroutine,
    Generator,
    Mapping,
    Sequence,
)
from types import SimpleNamespace
from typing import Any, Protocol, cast

import rich
import viser
from viser import (
    _assignable_props_api,  # pyright: ignore[reportPrivateUsage]
    _messages,  # pyright: ignore[reportPrivateUsage]
)
from viser.infra import (
    _async_message_buffer,  # pyright: ignore[reportPrivateUsage]
    _infra,  # pyright: ignore[reportPrivateUsage]
)
from websockets.asyncio.server import ServerConnection

from sambot_viz.geometry import Vector3, Wxyz

_prepared: weakref.WeakSet[viser.ViserServer] = weakref.WeakSet()


def on_connection(
    server: viser.ViserServer, prepare: Callable[[int, ServerConnection], object]
) -> None:
    """Call `prepare` with every browser's number and connection before it is read.

    Connections that are open already are prepared too. A second call for the same
    server does nothing.
    """
    if server in _prepared:
        return
    _prepared.add(server)
    websocket = cast(Any, server)._websock_server
    connections: dict[int, ServerConnection] = websocket._live_connections

    def connected(browser: Any) -> None:
        prepare(browser.client_id, connections[browser.client_id])

    websocket.on_client_connect(connected)
    for number, connection in list(connections.items()):
        prepare(number, connection)


def replace_methods(connection: ServerConnection, **methods: Any) -> None:
    """Have viser call other functions in place of methods of a connection."""
    vars(connection).update(methods)


def broadcast_buffer(server: viser.ViserServer) -> Any:
    """The messages for all browsers of a server."""
    return cast(Any, server)._websock_server._broadcast_buffer


def own_buffer(server: viser.ViserServer, client_id: int) -> Any:
    """The messages for one browser of a server."""
    return (
        cast(Any, server)
        ._websock_server._client_state_from_id[client_id]
        .message_buffer
    )


def connection_of(server: viser.ViserServer, client_id: int) -> ServerConnection:
    """The connection of a browser.

    Raises:
        KeyError: it has ended.
    """
    return cast(Any, server)._websock_server._live_connections[client_id]


class WindowLoop(Protocol):
    """What viser asks for the messages of a browser."""

    async def __anext__(self) -> Sequence[Any]:
        """The next messages; they are packed, and sent as one."""
        ...

    async def aclose(self) -> None:
        """The browser has left."""


def replace_window_loop(
    buffer: Any, loop: Callable[[int, int, Any], WindowLoop]
) -> None:
    """Have viser ask another loop for what goes out to a browser.

    Args:
        buffer: one of viser's buffers of messages.
        loop: is called with a browser's number, the number of the last message there
            was when it came, and a message to send behind that one.
    """
    vars(buffer)["_window_loop"] = loop


class Packer:
    """Packs messages as viser does, by the function of viser that sends them.

    That function gets its messages from here, and sends what it has packed to here.
    """

    done = False

    def __init__(self) -> None:
        self._packed = b""
        self._start()

    def _start(self) -> None:
        self._producer: Coroutine[Any, Any, None] = cast(Any, _infra)._message_producer(
            self, self, 0
        )
        self._producer.send(None)

    def pack(self, messages: Sequence[Any]) -> bytes:
        """What goes over the wire for these messages.

        Raises:
            Exception: of viser, for a message that cannot be packed.
        """
        try:
            self._producer.send(messages)
        except BaseException:
            self._start()
            raise
        packed, self._packed = self._packed, b""
        return packed

    def window_generator(self, *_: Any, **__: Any) -> Packer:
        """For viser: where it gets its messages."""
        return self

    def __anext__(self) -> Awaitable[Sequence[Any]]:
        """For viser: the next messages."""
        return _NextCall()

    async def aclose(self) -> None:
        """For viser: it wants no more."""

    async def send(self, data: bytes) -> None:
        """For viser: what it has packed."""
        self._packed = data


class _NextCall:
    """Waits for the next call of `Packer.pack`, and is what that was given."""

    def __await__(self) -> Generator[None, Sequence[Any], Sequence[Any]]:
        return (yield)


def _client(server: viser.ViserServer, client_id: int) -> Any:
    """The handle of a browser that has reported its camera, or None."""
    return cast(Any, server)._connected_clients.get(client_id)


def input_handle(server: viser.ViserServer, client_id: int, uuid: str) -> Any:
    """The widget of this id in a browser's page, common or its own; None: no such."""
    client = _client(server, client_id)
    for gui in (server.gui, *(() if client is None else (client.gui,))):
        handle = cast(Any, gui)._gui_input_handle_from_uuid.get(uuid)
        if handle is not None:
            return handle
    return None


def is_for_all(server: viser.ViserServer, uuid: str) -> bool:
    """Whether the widget of this id is common to all browsers."""
    return uuid in cast(Any, server.gui)._gui_input_handle_from_uuid


def send_value(server: viser.ViserServer, client_id: int, handle: Any) -> None:
    """Send a widget's present value to one browser, which shows another one."""
    client = _client(server, client_id)
    if client is not None:
        client._websock_connection.queue_message(
            _messages.GuiUpdateMessage(handle._impl.uuid, {"value": handle.value})
        )


def awaits_picture(server: viser.ViserServer, client_id: int) -> bool:
    """Whether a browser was asked for a picture that has not come yet."""
    client = _client(server, client_id)
    if client is None:
        return False
    handlers = client._websock_connection._incoming_handlers
    return bool(handlers.get(_messages.GetRenderResponseMessage))


@contextlib.contextmanager
def larger_messages(client: viser.ClientHandle, most: int) -> Generator[None]:
    """Let a browser send longer messages for a while, for a picture.

    Args:
        client: the browser.
        most: length of a message [bytes].
    """
    server: Any = cast(Any, client)._viser_server
    connection = server._websock_server._live_connections.get(client.client_id)
    before = None if connection is None else connection.protocol.max_message_size
    if connection is not None:
        connection.protocol.max_message_size = most
    try:
        yield
    finally:
        if connection is not None:
            connection.protocol.max_message_size = before


def allow_late_messages(client: viser.ClientHandle) -> None:
    """Let viser drop messages to a browser that has left without a warning.

    A browser may leave at any moment, also while its session is drawn.
    """
    buffer = cast(Any, client)._websock_connection.get_message_buffer()
    buffer._warned_push_after_done = True


async def drawn_by(
    client: viser.ClientHandle,
    width: int,
    height: int,
    camera: Mapping[str, Any],
    timeout: float,
) -> bytes:
    """Have a browser draw its view; viser's own way holds a thread while it waits.

    Args:
        client: the browser.
        width: of the picture [pixels].
        height: of the picture [pixels].
        camera: its pose and angle: position, wxyz and fov.
        timeout: the browser gets this long [s].

    Returns:
        What the browser sent, which should be a PNG file.

    Raises:
        TimeoutError: it sent nothing in time.
    """
    connection = cast(Any, client)._websock_connection
    number = secrets.token_hex(8)
    arrived: asyncio.Future[bytes] = asyncio.get_running_loop().create_future()

    def take(_: int, message: Any) -> None:
        if message.render_uuid == number and not arrived.done():
            arrived.set_result(message.payload)

    answer = _messages.GetRenderResponseMessage
    connection.register_handler(answer, take)
    try:
        # Four bytes for each pixel, if the browser compresses nothing.
        with larger_messages(client, 5 * width * height + 2**16):
            cast(Any, client)._viser_server.flush()
            connection.queue_message(
                _messages.GetRenderRequestMessage(
                    "image/png", height, width, 80, render_uuid=number, **camera
                )
            )
            client.flush()
            try:
                return await asyncio.wait_for(arrived, timeout)
            except asyncio.TimeoutError:
                raise TimeoutError from None
    finally:
        connection.unregister_handler(answer, take)


def node_count(scene: viser.SceneApi) -> int:
    """How many nodes a scene has: a page that shows as many shows all of it."""
    return len(scene._handle_from_node_name)  # pyright: ignore[reportPrivateUsage]


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
    send = state.api._queue_scene_message
    if wxyz is not None:
        state.wxyz[:] = wxyz
        send(_messages.SetOrientationMessage(state.name, wxyz))
    if position is not None:
        state.position[:] = position
        send(_messages.SetPositionMessage(state.name, position))


def share_arrays(handle: viser.SceneNodeHandle, **arrays: object) -> None:
    """Have a node keep these arrays, which nobody changes, in place of viser's copies.

    A robot with 50 MB of meshes would be in memory once for each private session.
    """
    props: Any = handle._impl.props  # pyright: ignore[reportPrivateUsage]
    for name, array in arrays.items():
        setattr(props, name, array)


def is_removed(handle: viser.SceneNodeHandle | viser.GuiInputHandle[Any]) -> bool:
    """Whether a node or widget is gone, itself or with one above it.

    viser warns about what is done with such a node, and raises for such a widget.
    """
    return bool(cast(Any, handle)._impl.removed)


def remember_prop_types() -> None:
    """Let viser find out the types of a kind of node once, not for every node.

    It is half of what a node costs: 0.5 ms, for each of the 900 nodes of a robot of
    300 links. The widgets of viser are remembered by viser itself.
    """
    module: Any = _assignable_props_api
    if not hasattr(module.get_type_hints, "cache_info"):
        module.get_type_hints = functools.cache(module.get_type_hints)


class Recorder:
    """Takes what is drawn, in place of browsers: a scene without a server.

    It is the audience of a session, and for the camera also its only browser.

    Args:
        height: of the picture that the camera is set for [pixels].

    Attributes:
        scene: where to draw.
        camera: the camera of a page that shows the scene.
        client_id: none; what has no number is for all.
        gui: not there.
    """

    client_id = ""
    gui: Any = None

    def __init__(self, height: int) -> None:
        self._websock_connection = _Messages()
        self._viser_server = SimpleNamespace(_scene_lifecycle_lock=threading.RLock())
        serializer = self._websock_connection.get_message_serializer
        self._recording = serializer(lambda m: m.include_in_scene_serialization)
        itself = cast(Any, self)
        # Neither threads nor a loop: nobody clicks on what is drawn.
        self.scene = viser.SceneApi(itself, cast(Any, None), cast(Any, None))
        self.camera = viser.CameraHandle(itself)
        state = self.camera._state  # pyright: ignore[reportPrivateUsage]
        state.image_height, state.update_timestamp = height, 1.0
        # A camera is somewhere, and looks elsewhere.
        state.position[:], state.up_direction[:] = (3.0, 3.0, 3.0), (0.0, 0.0, 1.0)

    def flush(self) -> None:
        """There is nothing to send."""

    def atomic(self) -> Any:
        """Nothing is sent, so nothing is held back."""
        return contextlib.nullcontext()

    def bytes(self) -> bytes:
        """What was drawn until now, as a recording that viser's page can show."""
        return self._recording.serialize()

    def listen(self, take: Callable[[Any, list[memoryview]], object]) -> None:
        """Call `take` with each message from now on, and with its arrays.

        In place of an array, the message has ``{"__binary_index": i, "dtype": "<f4"}``.
        """

        def hear(message: Any) -> None:
            arrays: list[memoryview] = []
            take(message.as_serializable_dict(arrays), arrays)

        self._websock_connection.hear = hear


class _Messages(_infra.WebsockMessageHandler):
    """Gives messages to viser's recording, and to whoever listens."""

    def __init__(self) -> None:
        super().__init__()
        self.hear: Callable[[Any], object] = lambda message: None
        # Its loop is only asked for when a message is to be sent.
        self._buffer = _async_message_buffer.AsyncMessageBuffer(cast(Any, None), True)

    def get_message_buffer(self) -> _async_message_buffer.AsyncMessageBuffer:
        return self._buffer

    def queue_message(self, message: Any) -> None:
        for recording in self._record_handles:
            recording._insert_message(message)  # pyright: ignore[reportPrivateUsage]
        self.hear(message)


@contextlib.contextmanager
def without_banner() -> Generator[None]:
    """Keep viser's own lines off the terminal while it starts or stops."""
    console = rich.get_console()
    before = console.quiet
    console.quiet = True
    try:
        yield
    finally:
        console.quiet = before


def quiet_websockets() -> None:
    """Keep the tracebacks of half-open connections off the terminal.

    Browsers open connections on speculation and drop them; the websockets library
    logs each as an error with a traceback. A dropped connection does no harm here.
    """
    logging.getLogger("websockets.server").setLevel(logging.CRITICAL)

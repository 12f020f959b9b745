"""A scene without a server."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import (
    Callable,
)
from types import SimpleNamespace
from typing import Any, cast

import viser
from viser.infra import (
    _async_message_buffer,  # pyright: ignore[reportPrivateUsage]
    _infra,  # pyright: ignore[reportPrivateUsage]
)


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

"""A scene without a server, and what is sent to it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np
import pytest
import viser
from glb_parts import document_of, numbers_of

from sambot_viz import viser_private


class Drawn:
    """A scene that nobody looks at.

    Attributes:
        scene: where to draw.
    """

    def __init__(self) -> None:
        recorder = viser_private.Recorder(480)
        self.scene: viser.SceneApi = recorder.scene
        self._messages: list[tuple[dict[str, Any], int]] = []
        recorder.listen(self._hear)

    def _hear(self, message: dict[str, Any], arrays: list[memoryview]) -> None:
        size = len(msgspec.msgpack.encode(message)) + sum(a.nbytes for a in arrays)
        props = message.get("props") or message.get("updates") or {}
        if isinstance(props.get("glb_data"), dict):
            # A long file travels as an array.
            props["glb_data"] = bytes(arrays[props["glb_data"]["__binary_index"]])
        self._messages.append((message, size))

    def sent(self) -> list[str]:
        """The types of all messages since it was asked last."""
        return [message["type"] for message, _ in self.taken()]

    def bytes(self) -> int:
        """How long all messages since it was asked last are."""
        return sum(size for _, size in self.taken())

    def taken(self) -> list[tuple[dict[str, Any], int]]:
        """All messages since it was asked last, and how long they are [bytes]."""
        taken, self._messages = self._messages, []
        return taken

    def files(self) -> dict[str, bytes]:
        """Name of a node → the GLB file that came for it since it was asked last."""
        found = {}
        for message, _ in self.taken():
            props = message.get("props") or message.get("updates") or {}
            if "glb_data" in props:
                found[message["name"]] = props["glb_data"]
        return found


@pytest.fixture
def drawn() -> Drawn:
    return Drawn()


@pytest.fixture
def document() -> Callable[[bytes], dict[str, Any]]:
    return document_of


@pytest.fixture
def numbers() -> Callable[[bytes, str], np.ndarray[Any, Any]]:
    return numbers_of

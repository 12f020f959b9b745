"""Looks at every number that is sent to browsers."""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
import viser

from sambot_viz import viser_private

LARGEST = 3.4028235e38
"""Browsers compute with 32 bits."""
_FLOAT = 5126


@contextmanager
def bad_numbers(server: viser.ViserServer) -> Iterator[list[str]]:
    """Yield a list that gets a line for each number that no browser can draw."""
    found: list[str] = []
    # viser has no public list of what it sends.
    handler: Any = server._websock_server  # pyright: ignore[reportPrivateUsage]
    queue = handler.queue_message

    def look(message: Any) -> None:
        name = type(message).__name__
        found.extend(f"{name}: {one}" for one in _bad_in(vars(message), ""))
        queue(message)

    # What moves is changed in the messages that are there.
    poses: Any = viser_private.MovingPoses.of(viser_private.broadcast_buffer(server))
    move = poses.move

    def look_at_moves(moves: Any) -> Any:
        for _, kind, value in moves:
            found.extend(f"moved: {one}" for one in _bad_in(value, kind))
        return move(moves)

    handler.queue_message, poses.move = look, look_at_moves
    try:
        yield found
    finally:
        handler.queue_message, poses.move = queue, move


def _bad_in(value: Any, path: str) -> Iterator[str]:
    if isinstance(value, bool | str) or value is None:
        return
    if isinstance(value, int | float):
        if not math.isfinite(value) or abs(value) > LARGEST:
            yield f"{path} {value}"
    elif isinstance(value, bytes):
        if value[:4] == b"glTF":
            yield from _bad_in_glb(value, path)
    elif isinstance(value, np.ndarray):
        if value.dtype.kind == "f" and not np.isfinite(value.astype(np.float32)).all():
            yield f"{path} {value.dtype}"
    elif isinstance(value, Mapping):
        for key, one in value.items():
            yield from _bad_in(one, f"{path}.{key}")
    elif isinstance(value, list | tuple):
        for one in value:
            yield from _bad_in(one, path)
    elif hasattr(value, "__dataclass_fields__"):
        yield from _bad_in(vars(value), path)


def _bad_in_glb(data: bytes, path: str) -> Iterator[str]:
    """Look at the numbers of a glTF file, those of its buffer too."""
    length, _ = struct.unpack_from("<II", data, 12)
    document = json.loads(data[20 : 20 + length])
    yield from _bad_in(document, f"{path} glTF")
    body = data[28 + length :]
    for accessor in document.get("accessors", ()):
        if accessor["componentType"] == _FLOAT:
            view = document["bufferViews"][accessor["bufferView"]]
            start = view.get("byteOffset", 0)
            inside = np.frombuffer(body[start : start + view["byteLength"]], "<f4")
            if not np.isfinite(inside).all():
                yield f"{path} glTF accessor"

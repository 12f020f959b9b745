"""Nodes of a scene."""

from __future__ import annotations

import functools
import itertools
import struct
import zlib
from collections.abc import Callable, Sequence
from typing import Any, cast

import viser
from viser import (
    _assignable_props_api,  # pyright: ignore[reportPrivateUsage]
    _messages,  # pyright: ignore[reportPrivateUsage]
    _scene_api,  # pyright: ignore[reportPrivateUsage]
    _scene_handles,  # pyright: ignore[reportPrivateUsage]
)

from sambot_viz.viser_private.moving_poses import set_pose


def node_count(scene: viser.SceneApi) -> int:
    """How many nodes a scene has: a page that shows as many shows all of it."""
    return len(scene._handle_from_node_name)  # pyright: ignore[reportPrivateUsage]


def scene_bytes(scene: viser.SceneApi) -> int:
    """Return how much a page has to receive and draw, such as meshes [bytes]."""
    handles = list(scene._handle_from_node_name.values())  # pyright: ignore[reportPrivateUsage]
    return sum(_content(cast(Any, handle)._impl.props) for handle in handles)


def _content(props: Any) -> int:
    values: list[Any] = list(cast(dict[str, Any], vars(props)).values())
    texts = sum(len(value) for value in values if isinstance(value, bytes))
    return texts + sum(int(getattr(value, "nbytes", 0)) for value in values)


def fill_background(scene: viser.SceneApi, color: tuple[int, int, int]) -> None:
    """Give the picture behind a scene one colour.

    viser's own function loads Pillow for the encoding of one pixel, which is a sixth of
    what the start of a server computes.

    Args:
        scene: the scene.
        color: red, green and blue, 0 to 255.
    """
    interface: Any = scene._websock_interface  # pyright: ignore[reportPrivateUsage]
    interface.queue_message(
        _messages.BackgroundImageMessage("png", _pixel(color), None)
    )


def _pixel(color: tuple[int, int, int]) -> bytes:
    """A PNG file of one pixel."""
    # Width, height, 8 bits for each of red, green and blue.
    header = struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0)
    row = zlib.compress(bytes((0, *color)))
    chunks = b"IHDR" + header, b"IDAT" + row, b"IEND"
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(chunk) - 4) + chunk + struct.pack(">I", zlib.crc32(chunk))
        for chunk in chunks
    )


def share_arrays(handle: viser.SceneNodeHandle, **arrays: object) -> None:
    """Have a node keep these arrays, which nobody changes, in place of viser's copies.

    A robot with 50 MB of meshes would be in memory once for each private session, and
    again as long as it waits to be sent.

    Args:
        handle: a node that was added just now.
        arrays: by the name of the property.
    """
    state: Any = handle._impl  # pyright: ignore[reportPrivateUsage]
    buffer: Any = state.api._websock_interface.get_message_buffer()
    holders = [state.props]
    with buffer.buffer_lock:
        # Behind the message that made the node are a few about its pose.
        for message in itertools.islice(reversed(buffer.message_from_id.values()), 10):
            if (
                isinstance(message, _messages.MeshMessage)
                and message.name == state.name
            ):
                holders.append(message.props)
    for holder, (name, array) in itertools.product(holders, arrays.items()):
        setattr(holder, name, array)


def send_file(handle: viser.GlbHandle, content: bytes) -> None:
    """Give a node another file, which nobody changes, and send it.

    viser's own setter compares it with the last one, and copies it twice: of a cloud of
    100,000 points that is a fifth of what it costs to draw it.

    Args:
        handle: the node; it was not removed.
        content: the file; an array (uint8) is sent as it is, bytes are compressed.
    """
    state: Any = handle._impl  # pyright: ignore[reportPrivateUsage]
    state.props.glb_data = content
    update = _messages.SceneNodeUpdateMessage(state.name, {"glb_data": content})
    state.api._queue_scene_message(update)


def is_removed(handle: viser.SceneNodeHandle | viser.GuiInputHandle[Any]) -> bool:
    """Whether a node or widget is gone, itself or with one above it.

    viser warns about what is done with such a node, and raises for such a widget.
    """
    return bool(cast(Any, handle)._impl.removed)


def tell_poses_of_remade_nodes() -> None:
    """Let viser tell the pose of a node that is made again before its removal went out.

    The new node takes the place of the removal among the messages: a page never hears
    of it and keeps the pose that the node had. viser tells a pose without a rotation
    or a shift only of nodes that were not removed before.
    """
    kind: Any = viser.SceneNodeHandle
    if hasattr(kind._make, "tells_poses"):
        return
    make = kind._make.__func__

    def made(
        of: type, api: Any, message: Any, name: str, *more: Any, **named: Any
    ) -> Any:
        removal = _messages.RemoveSceneNodeMessage(name).redundancy_key()
        buffer: Any = api._websock_interface.get_message_buffer()
        is_remade = removal in buffer.id_from_redundancy_key
        handle = make(of, api, message, name, *more, **named)
        if is_remade:
            state = handle._impl
            set_pose(handle, tuple(state.wxyz.tolist()), tuple(state.position.tolist()))
        return handle

    vars(made)["tells_poses"] = True
    kind._make = classmethod(made)


def remember_prop_types() -> None:
    """Let viser find out the types of a kind of node once, not for every node.

    It is half of what a node costs: 0.5 ms, for each of the 900 nodes of a robot of
    300 links. The widgets of viser are remembered by viser itself.
    """
    module: Any = _assignable_props_api
    if not hasattr(module.get_type_hints, "cache_info"):
        module.get_type_hints = functools.cache(module.get_type_hints)


def compare_poses_quickly() -> None:
    """Let viser compare the pose of a node with the last one without numpy.

    It does so twice for every node that is made, and takes 40 µs, a fifth of the node.
    """
    module: Any = _scene_handles
    module._set_pose_vector = _set_vector


def _set_vector(
    current: Any,
    value: Sequence[float],
    length: int,
    queue: Callable[[Any], object],
    make_message: Callable[[Any], Any],
) -> None:
    """Set a rotation or a position as viser does, with the tolerance of `allclose`."""
    cast_value: tuple[float, ...] = cast(Any, _scene_api).cast_vector(value, length)
    before: list[float] = current.tolist()
    if all(
        abs(a - b) <= 1e-8 + 1e-5 * abs(b)
        for a, b in zip(cast_value, before, strict=True)
    ):
        return
    current[:] = cast_value
    queue(make_message(cast_value))

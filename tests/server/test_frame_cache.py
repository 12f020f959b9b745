"""What is packed for the wire: once for all browsers, and let go when it is sent."""

from __future__ import annotations

import asyncio
import gc
import weakref
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
import viser
from protocol_client import ProtocolClient
from viser.infra import Message

from sambot_viz import viser_private
from sambot_viz.options import Options
from sambot_viz.server.listener import listen
from sambot_viz.server.outgoing.frame_cache import (
    HEAVY,
    RECENT,
    Batch,
    FrameCache,
    weight,
)


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    with listen(Options(port=0)) as listener:
        yield listener.viser


def longest(server: viser.ViserServer) -> Message:
    """The longest message to a browser that joins now."""
    there = viser_private.broadcast_buffer(server).message_from_id.values()
    return max(there, key=weight)


def batch(server: viser.ViserServer, number: int = 0) -> Batch:
    """The longest message, as if it had this number."""
    message = longest(server)
    return Batch((number,), [message], weight(message))


def heavy(server: viser.ViserServer, number: int = 0) -> Batch:
    add_mesh(server, HEAVY)
    return batch(server, number)


def add_mesh(server: viser.ViserServer, size: int) -> np.ndarray[Any, Any]:
    """Show a mesh with so many bytes of corners."""
    corners = np.random.default_rng(0).random((size // 12, 3), np.float32)
    server.scene.add_mesh_simple("/mesh", corners, np.array([[0, 1, 2]], np.uint32))
    return corners


def test_a_mesh_is_packed_once_for_all_that_join_together(
    server: viser.ViserServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    packed: list[int] = []
    pack = viser_private.Packer.pack

    def counted(packer: viser_private.Packer, messages: Any) -> bytes:
        packed.append(len(messages))
        return pack(packer, messages)

    monkeypatch.setattr(viser_private.Packer, "pack", counted)
    mesh, cache = heavy(server), FrameCache()

    async def join() -> None:
        alike = await asyncio.gather(*(cache.packed(mesh) for _ in range(30)))
        assert len(set(map(id, alike))) == 1

    asyncio.run(join())
    assert packed == [1]


def test_a_browser_that_leaves_meanwhile_does_not_take_it_from_the_others(
    server: viser.ViserServer,
) -> None:
    mesh, cache = heavy(server), FrameCache()

    async def leave() -> bytes:
        first = asyncio.create_task(cache.packed(mesh))
        await asyncio.sleep(0)
        second = asyncio.create_task(cache.packed(mesh))
        await asyncio.sleep(0)
        first.cancel()
        return (await second).content

    assert len(asyncio.run(leave())) > HEAVY


def test_what_is_heavy_is_let_go_and_of_what_is_light_the_newest_stay(
    server: viser.ViserServer,
) -> None:
    cache, light = FrameCache(), batch(server)

    async def send(what: Batch) -> weakref.ref[Any]:
        return weakref.ref(await cache.packed(what))

    def there(frame: weakref.ref[Any]) -> bool:
        gc.collect()
        return frame() is not None

    first = asyncio.run(send(light))
    assert not there(asyncio.run(send(heavy(server, 1))))
    assert there(first)
    for number in range(2, RECENT + 2):
        asyncio.run(send(Batch((number,), light.messages, light.weight)))
    assert not there(first)


def test_all_that_may_be_long_in_a_message_is_weighed(
    server: viser.ViserServer,
) -> None:
    server.gui.add_html("x" * 1000)
    assert 1000 <= weight(longest(server)) < 1200
    server.scene.add_glb("/glb", bytes(5000))
    assert 5000 <= weight(longest(server)) < 5300
    add_mesh(server, 60_000)
    assert 60_000 <= weight(longest(server)) < 60_400
    server.gui.add_html("").content = "x" * 80_000
    assert 80_000 <= weight(longest(server)) < 80_400


def test_a_mesh_arrives_as_it_is_and_all_else_in_its_order(
    server: viser.ViserServer, protocol: Callable[..., ProtocolClient]
) -> None:
    server.scene.add_frame("/before")
    corners = add_mesh(server, 5_000_000)
    server.scene.add_frame("/after")
    client = protocol(server.get_port())
    mesh = client.node("/mesh")
    assert mesh.fields["props"]["vertices"] == corners.tobytes()
    names = [m.fields.get("name") for m in client.messages if "props" in m.fields]
    order = [names.index(name) for name in ("/before", "/mesh", "/after")]
    assert order == sorted(order)
    assert len([m for m in client.messages if m.frame == mesh.frame]) == 1

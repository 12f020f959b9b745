"""What goes out to a browser, over real connections and in any order of events."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any, cast

import numpy as np
import pytest
import viser
from patience import patience, until
from protocol_client import ProtocolClient, decode_frame
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from sambot_viz import viser_private
from sambot_viz.options import Options
from sambot_viz.server.listener import listen
from sambot_viz.server.outgoing.news import News

Connect = Callable[..., ProtocolClient]
POSITION = "SetPositionMessage"
A_LONG_TIME = 50_000_000
"""So many messages are sent for 50 joints at 60 Hz within five hours."""


class Asked(dict[int, Any]):
    """Messages that count how often one is asked for."""

    count = 0

    def get(self, key: int, default: Any = None) -> Any:
        self.count += 1
        return super().get(key, default)


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    with listen(Options(port=0)) as listener:
        yield listener.viser


def nodes(client: ProtocolClient) -> list[str]:
    """The frames of the test that a browser was sent, in this order."""
    messages = client.messages
    names = [m.fields["name"] for m in messages if m.type == "FrameMessage"]
    return [name for name in names if name != "/WorldAxes"]


def test_a_browser_that_joins_late_asks_for_no_message_that_is_gone(
    server: viser.ViserServer, protocol: Connect
) -> None:
    buffer = viser_private.broadcast_buffer(server)
    names = [f"/{number}" for number in range(300)]
    for name in names[:200]:
        server.scene.add_frame(name)
    buffer.message_counter += A_LONG_TIME
    for name in names[200:]:
        server.scene.add_frame(name)
    buffer.message_from_id = asked = Asked(buffer.message_from_id)
    client = protocol(server.get_port())
    assert nodes(client) == names
    assert asked.count <= len(asked) + 1


def test_messages_come_in_order_while_others_are_sent_and_replaced(
    server: viser.ViserServer, protocol: Connect
) -> None:
    first = protocol(server.get_port())
    moved = server.scene.add_frame("/moved")
    for number in range(500):
        server.scene.add_frame(f"/{number}")
        moved.position = (number, 0.0, 0.0)
    first.settle(server)
    late = protocol(server.get_port())
    late.settle(server)
    wanted = ["/moved", *(f"/{number}" for number in range(500))]
    assert nodes(first) == nodes(late) == wanted
    for client in (first, late):
        poses = [m for m in client.messages if m.type == "SetPositionMessage"]
        assert [m.fields["position"][0] for m in poses][-1] == 499.0


def test_nothing_goes_out_while_changes_belong_together(
    server: viser.ViserServer, protocol: Connect
) -> None:
    client = protocol(server.get_port())
    mark = client.mark()
    with server.atomic():
        for number in range(10):
            server.scene.add_frame(f"/{number}")
    client.settle(server)
    frames = [m.frame for m in client.since(mark) if m.type == "FrameMessage"]
    assert len(frames) == 10
    assert len(set(frames)) == 1


def test_all_parts_of_a_change_but_the_last_say_that_more_follows(
    server: viser.ViserServer, protocol: Connect
) -> None:
    client = protocol(server.get_port())
    mark = client.mark()
    with server.atomic():
        for number in range(300):
            server.scene.add_frame(f"/{number}")
    client.settle(server)
    late = protocol(server.get_port())
    late.settle(server)
    said = client.since(mark)
    parts = list(dict.fromkeys(m.frame for m in said if m.type == "FrameMessage"))
    unfinished = [m.frame for m in said if m.fields.get("name") == "~more"]
    assert len(parts) > 2
    assert unfinished == parts[:-1]
    assert not [m for m in late.messages if m.fields.get("name") == "~more"]


def test_messages_are_collected_once_for_all_clients(
    server: viser.ViserServer, protocol: Connect
) -> None:
    buffer = viser_private.broadcast_buffer(server)
    frames = [server.scene.add_frame(f"/{number}") for number in range(100)]
    clients = [protocol(server.get_port()) for _ in range(4)]
    for client in clients:
        client.settle(server)
    buffer.message_from_id = asked = Asked(buffer.message_from_id)
    with server.atomic():
        for frame in frames:
            frame.position = (1.0, 0.0, 0.0)
    for client in clients:
        client.wait_until(lambda c=client: c.types()["SetPositionMessage"] == 100)
    assert asked.count < 2 * len(frames)


def test_a_message_that_one_client_does_not_get_reaches_the_others(
    server: viser.ViserServer, protocol: Connect
) -> None:
    buffer = viser_private.broadcast_buffer(server)
    moved = server.scene.add_frame("/moved")
    clients = [protocol(server.get_port()) for _ in range(3)]
    without = list(server.get_clients())[1]
    for client in clients:
        client.settle(server)
    with server.atomic():
        moved.position = (1.0, 0.0, 0.0)
        newest = buffer.message_from_id[buffer.message_counter - 1]
        newest.excluded_self_client = without
    for client in clients:
        client.settle(server)
    assert [c.types()["SetPositionMessage"] for c in clients] == [1, 0, 1]


def test_a_thread_that_adds_a_message_touches_nobody_who_waits(
    server: viser.ViserServer,
) -> None:
    """viser's own event raises there when a browser comes or goes at that moment."""
    buffer = viser_private.broadcast_buffer(server)
    news, seen = News.of(buffer), list[bool]()

    async def wait() -> None:
        waiting = asyncio.ensure_future(news.wait())
        await asyncio.sleep(0)
        await asyncio.to_thread(buffer.message_event.set)
        await asyncio.sleep(0)
        seen.append(waiting.done())
        await asyncio.to_thread(server.scene.add_frame, "/a")
        await asyncio.wait_for(waiting, patience(10.0))

    loop = server.get_event_loop()
    asyncio.run_coroutine_threadsafe(wait(), loop).result(20.0)
    assert seen == [False]


def test_a_change_wakes_the_clients_once(
    server: viser.ViserServer, protocol: Connect, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A flush right after it asks for nothing, nor does a change of nothing."""
    frames = [server.scene.add_frame(f"/{number}") for number in range(20)]
    client = protocol(server.get_port())
    client.settle(server)
    loop, calls = server.get_event_loop(), list[str]()
    call = loop.call_soon_threadsafe

    def counted(action: Callable[..., Any], *args: Any, **more: Any) -> Any:
        calls.append(getattr(action, "__name__", ""))
        return call(action, *args, **more)

    monkeypatch.setattr(loop, "call_soon_threadsafe", counted)
    with server.atomic():
        for frame in frames:
            frame.position = (1.0, 0.0, 0.0)
    server.flush()
    client.wait_until(lambda: client.types()["SetPositionMessage"] == 20)
    with server.atomic():
        pass
    server.flush()
    assert len(calls) == 1


def test_a_browser_that_comes_during_a_change_has_all_when_nothing_changed(
    server: viser.ViserServer, protocol: Connect
) -> None:
    server.scene.add_frame("/a")
    protocol(server.get_port()).settle(server)
    buffer = viser_private.broadcast_buffer(server)
    with ThreadPoolExecutor(1) as pool:
        with server.atomic():
            coming = pool.submit(protocol, server.get_port())
            until(lambda: len(buffer.generator_cursors) == 2)
        client = coming.result(20.0)
    assert nodes(client) == ["/a"]


def test_a_browser_that_reads_slowly_gets_fewer_clouds_and_never_an_old_one(
    server: viser.ViserServer,
) -> None:
    """What it has not been sent when a newer one comes is left out."""
    count, content = 150, cast(bytes, np.zeros(200_000, np.uint8))
    cloud = server.scene.add_glb("/cloud", content)
    buffer = viser_private.broadcast_buffer(server)
    with connect(
        f"ws://127.0.0.1:{server.get_port()}/?ticket=slow",
        subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
        max_size=None,
        max_queue=1,
        compression=None,
    ) as slow:
        until(lambda: buffer.generator_cursors)
        for number in range(1, count):
            cloud.glb_data = cast(bytes, np.full(200_000, number, np.uint8))
            server.flush()
        found: list[int] = []
        while not found or found[-1] < count - 1:
            for message in decode_frame(cast(bytes, slow.recv(20.0))):
                if "glb_data" in message.fields.get("updates", {}):
                    found.append(message.fields["updates"]["glb_data"][0])
    assert found == sorted(found)
    assert len(found) < count / 2


def test_without_a_client_a_change_wakes_nobody(
    server: viser.ViserServer, protocol: Connect, monkeypatch: pytest.MonkeyPatch
) -> None:
    moved = server.scene.add_frame("/moved")
    woken: list[object] = []
    buffer = viser_private.broadcast_buffer(server)
    wake = buffer.event_loop.call_soon_threadsafe

    def counted(callback: Callable[..., object], *arguments: Any) -> Any:
        woken.append(callback)
        return wake(callback, *arguments)

    def step(number: int) -> None:
        with server.atomic():
            viser_private.set_pose(moved, None, (number, 0.0, 0.0))
        server.flush()

    step(1)
    monkeypatch.setattr(buffer.event_loop, "call_soon_threadsafe", counted)
    step(2)
    assert woken == []
    monkeypatch.undo()
    client = protocol(server.get_port())
    for number in (3, 4):
        step(number)
        client.wait_until(
            lambda at=number: (
                [m for m in client.messages if m.type == POSITION][-1].fields
                == {"name": "/moved", "position": [at, 0.0, 0.0]}
            )
        )


def test_single_messages_are_collected_for_a_moment(
    server: viser.ViserServer, protocol: Connect
) -> None:
    moved = server.scene.add_frame("/moved")
    client = protocol(server.get_port())
    client.settle(server)
    mark = client.mark()
    for number in range(1, 200):
        moved.position = (number, 0.0, 0.0)
    client.settle(server)
    poses = [m for m in client.since(mark) if m.type == "SetPositionMessage"]
    assert len(poses) < 50
    assert poses[-1].fields["position"][0] == 199.0

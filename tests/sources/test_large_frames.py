"""A message above the limit costs its topic alone: the connection goes on."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace

import pytest
from live_peers import WAIT, FoxglovePeer, Inbox, LivePeer
from patience import until
from rosbridge_peer import RosbridgePeer, cbor
from websockets.frames import Frame, Opcode

from sambot_viz import limits
from sambot_viz.sources.rosbridge_wire import topic_of
from sambot_viz.sources.source import Source
from sambot_viz.sources.websocket.large_frames import HEAD, LargeFrames

LIMIT = 50_000
ANSWER = b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n\r\n"


@pytest.mark.parametrize("kind", [FoxglovePeer, RosbridgePeer])
def test_a_message_above_the_limit_costs_its_topic_alone(
    kind: Callable[[], LivePeer],
    opened: Callable[[str], Source],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(limits, "MESSAGE", replace(limits.MESSAGE, value=LIMIT))
    peer, large, other = kind(), Inbox(), Inbox()
    try:
        peer.advertise("/large")
        peer.advertise("/other")
        source = opened(peer.uri)
        source.subscribe("/large", large)
        source.subscribe("/other", other)
        until(lambda: peer.subscribed() == ["/large", "/other"], WAIT)
        peer.publish("/large", "x" * LIMIT)
        peer.publish("/large", "y" * 2 * LIMIT)
        peer.publish("/large", "fits")
        peer.publish("/other", "before" * 100)
        large.wait_for("fits")
        other.wait_for("before" * 100)
        said = f"the limit is {LIMIT:,}"
        until(
            lambda: "2 messages" in source.topics()["/large"].left_out,
            WAIT,
            # rosapi lists them after a while.
            not_yet=KeyError,
        )
        assert said in source.topics()["/large"].left_out
        until(lambda: said in source.status.sentence, WAIT)
        assert "of /large, 2 messages are left out" in source.status.sentence
        assert source.topics()["/other"].left_out == ""
        assert source.status.session == 1
        assert source.status.is_connected
    finally:
        peer.stop()


@pytest.mark.parametrize("seed", range(30))
def test_what_goes_through_does_not_depend_on_how_it_comes(seed: int) -> None:
    rng = random.Random(seed)
    most = 2000
    sizes = rng.choices([0, 1, 125, 126, most, most + 1, 9 * most, 17 * most], k=12)
    contents = [rng.randbytes(size) for size in sizes]
    frames = [
        Frame(rng.choice([Opcode.BINARY, Opcode.TEXT]), one).serialize(mask=False)
        for one in contents
    ]
    cut = [n for n, size in enumerate(sizes) if most < size <= 16 * most]
    wanted = ANSWER + b"".join(f for n, f in enumerate(frames) if n not in cut)
    found: list[tuple[bytes, int]] = []
    filters = LargeFrames(most, lambda head, size: found.append((head, size)))
    stream, through = ANSWER + b"".join(frames), b""
    while stream:
        size = rng.choice([1, 2, 5, 60, 700, 5000, 65_536])
        through += filters.filtered(stream[:size])
        stream = stream[size:]
    assert through == wanted
    assert found == [(contents[n][:HEAD], sizes[n]) for n in cut]


def test_an_answer_that_is_no_websocket_goes_through_as_it_is() -> None:
    filters = LargeFrames(10, lambda head, size: None)
    for part in (b"HT", b"TP/1.1 404 Not Found\r\n\r\n", b"\x82\x7e\xff\xff" * 100):
        assert filters.filtered(part) in (part, b"HTTP/1.1 404 Not Found\r\n\r\n", b"")


def test_messages_in_several_frames_are_left_to_websockets() -> None:
    filters = LargeFrames(10, lambda head, size: None)
    filters.filtered(ANSWER)
    first = Frame(Opcode.BINARY, bytes(20), fin=False).serialize(mask=False)
    rest = Frame(Opcode.CONT, bytes(20)).serialize(mask=False)
    assert filters.filtered(first + rest) == first + rest


@pytest.mark.parametrize("length", [1, 22, 23, 24, 255, 256, 900])
def test_the_topic_stands_in_the_head_of_a_publication(length: int) -> None:
    topic = "/" + "é" + "t" * (length - 1)
    message = {"op": "publish", "topic": topic, "msg": {"bytes": bytes(100)}}
    assert topic_of(cbor(message)) == topic
    assert topic_of(b'{"op": "publish", "topic": "/a\\u00e9\\"b", "msg"') == '/aé"b'
    assert topic_of(b'{"op": "publish", "msg": {"data": ') == ""

"""Peers that lie, send garbage or vanish cost one sentence, and nothing is stuck."""

from __future__ import annotations

import json
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from live_peers import WAIT, Inbox, free_port
from lower_limit import lower
from mcap.reader import make_reader
from patience import until
from rosbridge_peer import RosbridgePeer, cbor
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import Server, ServerConnection, serve

from sambot_viz import limits
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.recorder import SourceRecorder
from sambot_viz.sources.source import Source

Open = Callable[[str], Source]
Play = Callable[[ServerConnection], object]
SERVER_INFO = '{"op":"serverInfo","name":"liar","capabilities":[],"sessionId":"1"}'
CHANNEL = (
    '{"op":"advertise","channels":[{"id":1,"topic":"/a","encoding":"cdr",'
    '"schemaName":"std_msgs/msg/String","schemaEncoding":"ros2msg",'
    '"schema":"string data"}]}'
)
GOOD = b"\1\1\0\0\0" + bytes(8) + b"\0\1\0\0\4\0\0\0yes\0"


@pytest.fixture
def play() -> Iterator[Callable[[Play], str]]:
    """Serves what a function does with each connection; gives the address."""
    servers: list[tuple[Server, threading.Thread]] = []

    def start(handler: Play) -> str:
        def handle(client: ServerConnection) -> None:
            with suppress(ConnectionClosed, OSError):
                handler(client)

        port = free_port()
        server = serve(
            handle,
            "127.0.0.1",
            port,
            subprotocols=["foxglove.websocket.v1"],  # type: ignore[list-item]
            select_subprotocol=lambda _, offered: offered[-1] if offered else None,
            compression=None,
        )
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        servers.append((server, thread))
        return f"127.0.0.1:{port}"

    yield start
    for server, thread in servers:
        server.shutdown()
        thread.join()


@pytest.fixture
def raw() -> Iterator[Callable[[bytes], str]]:
    """Answers each TCP connection with bytes and closes it; gives the address."""
    listener = socket.create_server(("127.0.0.1", 0))
    answer = b""

    def serve_raw() -> None:
        with suppress(OSError):
            while True:
                client, _ = listener.accept()
                with client, suppress(OSError):
                    client.recv(4096)
                    client.sendall(answer)

    thread = threading.Thread(target=serve_raw)

    def start(words: bytes) -> str:
        nonlocal answer
        answer = words
        thread.start()
        return f"127.0.0.1:{listener.getsockname()[1]}"

    yield start
    listener.shutdown(socket.SHUT_RDWR)
    listener.close()
    thread.join()


def says(source: Source, *words: str) -> None:
    until(
        lambda: all(word in source.status.sentence for word in words),
        WAIT,
        not_yet=(),
        why=f"never {words}",
    )
    assert "\n" not in source.status.sentence


def test_garbage_between_good_messages_is_counted_and_said(
    play: Callable[[Play], str], opened: Open, inbox: Inbox
) -> None:
    def liar(client: ServerConnection) -> None:
        client.send(SERVER_INFO)
        client.send(CHANNEL)
        subscribed = json.loads(client.recv())
        assert subscribed["subscriptions"] == [{"id": 1, "channelId": 1}]
        for frame in (
            b"",
            b"\1\1\0",
            b"\4\1\0\0\0\1\xff\xff\xff\xff",
            "{",
            "[]",
            '{"op":"unadvertise","channelIds":[-1]}',
            b"\xc8whatever",
            b"\1\x63\0\0\0" + bytes(8) + b"of nobody",
            '{"op":"unadvertise","channelIds":[12345]}',
            GOOD,
        ):
            client.send(frame)
        client.recv()

    source = opened(f"foxglove://{play(liar)}")
    source.subscribe("/a", inbox)
    inbox.wait_for("yes")
    says(source, "Connected to 127.0.0.1:", "6 of its frames made no sense")
    assert source.status.unreadable == 6


def test_messages_above_the_limit_cost_their_topic_in_any_number_of_frames(
    play: Callable[[Play], str],
    opened: Open,
    inbox: Inbox,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lower(monkeypatch, "MESSAGE", 1000)

    def many_frames(client: ServerConnection) -> None:
        client.send(SERVER_INFO)
        client.send(CHANNEL)
        client.recv()
        # One message is one frame for each part.
        client.send([GOOD[:13], *[b"a" * 60] * 50])
        client.send(GOOD[:13] + bytes(40_000))
        client.send([GOOD[:20], b"", GOOD[20:]])
        client.recv()

    source = opened(f"foxglove://{play(many_frames)}")
    source.subscribe("/a", inbox)
    inbox.wait_for("yes")
    says(source, "of /a, 2 messages are left out", "the limit is 1,000")
    assert source.status.session == 1
    assert source.status.unreadable == 0


def test_a_subscription_that_came_too_early_is_made_again(
    play: Callable[[Play], str], opened: Open, inbox: Inbox
) -> None:
    def slow(client: ServerConnection) -> None:
        client.send(SERVER_INFO)
        client.send(CHANNEL)
        client.recv()
        status = {"op": "status", "level": 2, "message": "Unknown channel ID: 1"}
        client.send(json.dumps(status))
        again = json.loads(client.recv())
        assert again["subscriptions"] == [{"id": 2, "channelId": 1}]
        client.send(b"\1\2" + GOOD[2:])
        client.recv()

    source = opened(f"foxglove://{play(slow)}")
    source.subscribe("/a", inbox)
    inbox.wait_for("yes")


def test_a_peer_that_vanishes_in_the_middle_of_a_message_is_said(
    play: Callable[[Play], str], opened: Open, inbox: Inbox
) -> None:
    count, seen = 0, threading.Event()

    def vanishing(client: ServerConnection) -> None:
        nonlocal count
        count += 1
        if count > 1:
            # What is said of the first connection ends with the next one.
            assert seen.wait(WAIT)
        client.send(SERVER_INFO)
        client.send(CHANNEL)
        client.recv()
        if count > 1:
            client.send(GOOD)
            client.recv()
        # A frame that announces a gigabyte and has eleven bytes.
        client.socket.sendall(b"\x82\x7f" + (2**20).to_bytes(8, "big") + b"abc")
        client.socket.shutdown(socket.SHUT_RDWR)

    source = opened(f"foxglove://{play(vanishing)}")
    source.subscribe("/a", inbox)
    says(source, "is gone, in the middle")
    seen.set()
    inbox.wait_for("yes")


def test_who_is_told_of_a_topic_gets_what_others_have_asked_for_before(
    play: Callable[[Play], str], opened: Open, inbox: Inbox
) -> None:
    def advertising(client: ServerConnection) -> None:
        client.send(SERVER_INFO)
        client.send(CHANNEL)
        # Until it is read, and not yet told.
        client.ping().wait(WAIT)
        is_advertised.set()
        client.recv()
        client.send(GOOD)
        client.recv()

    is_advertised = threading.Event()
    told, late = Inbox(), Inbox()
    source = opened(f"foxglove://{play(advertising)}")
    # What is kept comes to late subscribers.
    source.on_topics = lambda: source.subscribe("/a", told, late)
    assert is_advertised.wait(WAIT)
    source.subscribe("/a", inbox)
    inbox.wait_for("yes")
    told.wait_for("yes")
    assert not late.messages


def test_a_recording_of_a_peer_that_lies_and_vanishes_stays_readable(
    play: Callable[[Play], str], opened: Open, tmp_path: Path
) -> None:
    connections: list[ServerConnection] = []

    def liar(client: ServerConnection) -> None:
        connections.append(client)
        client.send(SERVER_INFO)
        client.send(CHANNEL)
        client.recv()
        client.send(GOOD)
        while len(connections) > 1:
            client.recv()
        # Channels by the thousand, whose names, encodings and texts are none.
        odd = [
            {
                "id": n,
                "topic": f"/\u202e{n}",
                "encoding": "cdr",
                "schemaName": "\n" * n,
            }
            for n in range(2, 2000)
        ]
        client.send(json.dumps({"op": "advertise", "channels": odd}))
        asked: set[int] = set()
        while len(asked) < 1998:
            said = json.loads(client.recv())
            asked |= {one["id"] for one in said.get("subscriptions", ())}
        # A time at the end of all times, lengths that lie, and nothing at all.
        for number in sorted(asked)[:200]:
            head = b"\1" + number.to_bytes(4, "little")
            client.send(head + b"\xff" * 8 + b"\0\1\0\0\xff\xff\xff\xff")
            client.send(head + bytes(8))
            client.send(head)
        # Until all that was sent is read.
        client.ping().wait(WAIT)
        client.socket.sendall(b"\x82\x7f" + (2**20).to_bytes(8, "big") + b"\1\1\0")
        client.socket.shutdown(socket.SHUT_RDWR)

    path = tmp_path / "liar.mcap"
    source = opened(f"foxglove://{play(liar)}")
    recorder = SourceRecorder(source, None, lambda: None, period=0.1)
    recorder.start(path)

    # Both good ones, and 400 in which a time is all that can be read.
    until(lambda: getattr(recorder.status, "messages", 0) >= 402, WAIT, not_yet=())
    recorder.close()
    assert recorder.status is not None and recorder.status.trouble == ""
    with open_recording(path) as recording:
        ours = sorted((one.log_ns, bytes(one.payload)) for one in recording.messages())
    with path.open("rb") as stream:
        messages = make_reader(stream, validate_crcs=True).iter_messages()
        theirs = sorted((one.log_time, one.data) for *_, one in messages)
    assert ours == theirs and len(ours) == recorder.status.messages == 402
    assert [payload for _, payload in ours].count(GOOD[13:]) == 2


@pytest.mark.parametrize("size", [2**40, 2**63])
def test_a_message_beyond_the_limit_is_said_before_it_is_there(
    play: Callable[[Play], str], opened: Open, size: int
) -> None:
    def boaster(client: ServerConnection) -> None:
        client.send(SERVER_INFO)
        client.send(CHANNEL)
        client.recv()
        head = b"\x82\x7f" + size.to_bytes(8, "big")
        client.socket.sendall(head + GOOD[:13] + bytes(2000))
        client.recv()

    source = opened(f"foxglove://{play(boaster)}")
    source.subscribe("/a", Inbox())
    says(source, f"{size:,} bytes; the limit is {limits.MESSAGE.value:,}")


def test_text_that_is_not_utf8_ends_the_connection(
    play: Callable[[Play], str], opened: Open
) -> None:
    def mumbler(client: ServerConnection) -> None:
        client.send(SERVER_INFO)
        client.socket.sendall(b"\x81\x02\xff\xff")
        client.recv()

    source = opened(f"foxglove://{play(mumbler)}")
    says(source, "127.0.0.1:", "was left")


def test_a_new_session_begins_a_new_connection(
    play: Callable[[Play], str], opened: Open, inbox: Inbox
) -> None:
    sessions: list[int] = []

    def restarting(client: ServerConnection) -> None:
        sessions.append(len(sessions))
        info = json.loads(SERVER_INFO)
        client.send(json.dumps({**info, "sessionId": str(len(sessions))}))
        client.send(CHANNEL)
        assert json.loads(client.recv())["op"] == "subscribe"
        client.send(GOOD)
        if len(sessions) == 1:
            client.send(json.dumps({**info, "sessionId": "2"}))
        client.recv()

    source = opened(f"foxglove://{play(restarting)}")
    source.subscribe("/a", inbox)
    inbox.wait_for("yes", "yes")
    until(lambda: source.status.is_connected, WAIT)
    assert sessions == [0, 1]
    assert source.status.session == 2


def test_more_topics_than_are_listed_are_said(
    play: Callable[[Play], str], opened: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "TOPICS", 10)

    def crowd(client: ServerConnection) -> None:
        client.send(SERVER_INFO)
        channels = [{"id": n, "topic": f"/{n}"} for n in range(1000)]
        client.send(json.dumps({"op": "advertise", "channels": channels}))
        client.recv()

    source = opened(f"foxglove://{play(crowd)}")
    says(source, "only the first 10 of its topics")
    until(lambda: len(source.topics()) == 10, WAIT)


def test_names_of_a_peer_cannot_break_a_page(
    play: Callable[[Play], str], opened: Open
) -> None:
    def painter(client: ServerConnection) -> None:
        name = "ro\u202ebot\n" + "x" * 10_000
        client.send(json.dumps({"op": "serverInfo", "name": name}))
        status = {"op": "status", "level": 2, "message": "y\0" * 10_000}
        client.send(json.dumps(status))
        client.recv()

    source = opened(f"foxglove://{play(painter)}")
    says(source, "Connected to", "it says: y")
    assert len(source.status.sentence) < 500
    assert source.status.sentence.isprintable()


def test_each_protocol_says_when_the_other_one_is_spoken(
    play: Callable[[Play], str], opened: Open
) -> None:
    def foxglove(client: ServerConnection) -> None:
        client.send(SERVER_INFO)
        client.recv()

    def rosbridge(client: ServerConnection) -> None:
        client.send('{"op":"status","level":"info","msg":"welcome"}')
        client.send('{"op":"publish","topic":"/a","msg":{}}')
        client.recv()

    place = play(foxglove)
    says(opened(f"rosbridge://{place}"), f"--source foxglove://{place}")
    place = play(rosbridge)
    says(opened(f"foxglove://{place}"), f"--source rosbridge://{place}")


@pytest.mark.parametrize(
    ("scheme", "answer", "words"),
    [
        ("foxglove", b"", ["does not speak websocket"]),
        ("foxglove+wss", b"", ["TLS", "--source foxglove://127"]),
        ("foxglove", b"SSH-2.0-OpenSSH_9.2\r\n", ["does not speak websocket"]),
        ("foxglove", bytes(range(256)) * 12, ["does not speak websocket"]),
        (
            "foxglove",
            b"HTTP/1.1 200 OK\r\n\r\n<html>",
            ["(200)", "port of foxglove?"],
        ),
        (
            "foxglove",
            b"HTTP/1.1 400 No\r\n\r\n",
            ["(400)", "--source rosbridge://127."],
        ),
        (
            "rosbridge",
            b"HTTP/1.1 400 No\r\n\r\n",
            ["(400)", "--source foxglove://127."],
        ),
        ("foxglove", b"HTTP/1.1 401 No\r\n\r\n", ["(401)", "?token="]),
        ("rosbridge", b"HTTP/1.1 403 No\r\n\r\n", ["(403)", "rosbridge://USER:"]),
        ("foxglove", b"HTTP/1.1 404 No\r\n\r\n", ["(404)", "/PATH"]),
        ("foxglove", b"HTTP/1.1 502 No\r\n\r\n", ["(502)", "foxglove_bridge_launch"]),
        (
            "foxglove+wss",
            b"HTTP/1.1 400 No\r\n\r\n",
            ["TLS", "--source foxglove://127"],
        ),
    ],
)
def test_what_is_no_bridge_costs_one_sentence(
    raw: Callable[[bytes], str],
    opened: Open,
    scheme: str,
    answer: bytes,
    words: list[str],
) -> None:
    source = opened(f"{scheme}://{raw(answer)}")
    until(lambda: source.status.retry_s is not None, WAIT)
    for word in words:
        assert word in source.status.sentence
    assert not source.status.is_connected


def test_a_rosbridge_that_lies_is_counted(opened: Open, inbox: Inbox) -> None:
    peer = RosbridgePeer()
    try:
        peer.advertise("/a")
        source = opened(peer.uri)
        source.subscribe("/a", inbox)
        until(lambda: peer.subscribed() == ["/a"], WAIT)
        good = cbor({"op": "publish", "topic": "/a", "msg": {"bytes": b"x"}})
        for frame in (
            good[:-1],
            good + b"\0",
            b"\x9b\xff\xff\xff\xff\xff\xff\xff\xff",
            b"\x81" * 1000,
            "{",
            '{"op":"publish","topic":"/a"}',
            cbor({"op": "publish", "topic": "/other", "msg": {"bytes": b"x"}}),
            '{"op":"service_response","id":"of nobody","values":7}',
        ):
            peer.send(frame)
        peer.publish("/a", "yes")
        inbox.wait_for("yes")
        says(source, "6 of its frames made no sense")
    finally:
        peer.stop()

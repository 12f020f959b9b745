"""Foxglove's protocol against the server of its own SDK."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import foxglove
import pytest
from foxglove.websocket import (
    Capability,
    Client,
    ConnectionGraph,
    Parameter,
    ParameterValue,
)
from live_peers import WAIT, FoxglovePeer, Inbox, cdr_string
from patience import until

from sambot_viz.errors import SourceError
from sambot_viz.sources.source import Source

Open = Callable[[str], Source]
Peer = Callable[..., FoxglovePeer]
DESCRIPTION = "/robot_state_publisher.robot_description"


class DescribedPeer(FoxglovePeer):
    """A robot whose description is a parameter."""

    def __init__(self, **options: Any) -> None:
        self.parameters: dict[str, str] = {DESCRIPTION: "<robot/>"}
        self.asked: list[list[str]] = []
        super().__init__(capabilities=[Capability.Parameters], **options)

    def on_get_parameters(
        self, client: Client, param_names: list[str], request_id: str | None = None
    ) -> list[Parameter]:
        self.asked.append(param_names)
        return [
            Parameter(name, value=ParameterValue.String(value))
            for name, value in self.parameters.items()
            if name in param_names
        ]


@pytest.fixture
def robot() -> Iterator[Peer]:
    """Starts servers of the SDK, with options."""
    peers: list[FoxglovePeer] = []

    def start(kind: type[FoxglovePeer] = FoxglovePeer, **options: Any) -> FoxglovePeer:
        peers.append(kind(**options))
        return peers[-1]

    yield start
    for peer in peers:
        peer.stop()


def test_a_file_is_fetched_once_for_all(robot: Peer, opened: Open) -> None:
    asked: list[str] = []

    def handler(uri: str) -> bytes | None:
        asked.append(uri)
        return b"solid " * 1000

    peer = robot(asset_handler=handler)
    source = opened(peer.uri)
    mesh = "package://sam_bot/meshes/a.stl"
    futures = [source.fetch_asset(mesh) for _ in range(30)]
    assert {future.result(WAIT) for future in futures} == {b"solid " * 1000}
    assert source.fetch_asset(mesh).result(WAIT) == b"solid " * 1000
    assert asked == [mesh]
    assert "files" in source.capabilities


def test_a_refused_file_has_the_text_of_the_server_and_the_option_that_allows_it(
    robot: Peer, opened: Open
) -> None:
    asked: list[str] = []

    def handler(uri: str) -> bytes | None:
        asked.append(uri)
        raise RuntimeError(f"Asset URI not allowed: {uri}")

    source = opened(robot(asset_handler=handler).uri)
    for _ in range(2):
        with pytest.raises(SourceError) as caught:
            source.fetch_asset("file:///etc/passwd").result(WAIT)
    (problem,) = caught.value.problems
    assert problem.code == "mesh-not-served"
    assert problem.message.startswith("file:///etc/passwd: the server says: ")
    assert "Asset URI not allowed: file:///etc/passwd" in problem.message
    assert "`asset_uri_allowlist`" in problem.hint
    assert asked == ["file:///etc/passwd"], "a refusal holds for the session, too"


def test_files_of_another_session_are_fetched_again(robot: Peer, opened: Open) -> None:
    asked: list[str] = []

    def handler(uri: str) -> bytes | None:
        asked.append(uri)
        return str(len(asked)).encode()

    peer = robot(asset_handler=handler)
    source = opened(peer.uri)
    assert source.fetch_asset("package://a").result(WAIT) == b"1"
    peer.stop()
    until(lambda: not source.status.is_connected, WAIT)
    peer.start()
    until(lambda: source.status.is_connected, WAIT)
    assert source.status.session == 1
    assert source.fetch_asset("package://a").result(WAIT) == b"1", "the same session"
    peer.stop()
    until(lambda: not source.status.is_connected, WAIT)
    peer.options["session_id"] = "second"
    peer.start()
    until(lambda: source.status.session == 2, WAIT)
    assert source.fetch_asset("package://a").result(WAIT) == b"2"


def test_a_server_without_files_says_so(robot: Peer, opened: Open) -> None:
    source = opened(robot().uri)
    with pytest.raises(SourceError, match="hands out no files; with foxglove_bridge"):
        source.fetch_asset("package://a").result(WAIT)


def test_a_file_that_waits_is_given_up_when_the_source_is_closed(
    opened: Open,
) -> None:
    source = opened("foxglove://127.0.0.1:1")
    waiting = source.fetch_asset("package://a")
    source.close()
    with pytest.raises(SourceError, match="is closed"):
        waiting.result(WAIT)
    with pytest.raises(SourceError, match="is closed"):
        source.fetch_asset("package://b").result(WAIT)


def test_the_time_of_the_server_is_the_clock(robot: Peer, opened: Open) -> None:
    peer = robot()
    source = opened(peer.uri)
    until(lambda: source.status.is_connected, WAIT)
    assert peer.server is not None
    peer.server.broadcast_time(17_000_000_005)
    until(lambda: source.clock_ns() == 17_000_000_005, WAIT)
    peer.server.broadcast_time(3)
    until(lambda: source.clock_ns() == 3, WAIT, "a clock may go back")


def test_the_graph_says_who_publishes_and_who_reads(robot: Peer, opened: Open) -> None:
    peer = robot()
    peer.advertise("/a")
    peer.advertise("/b")
    source = opened(peer.uri)
    until(lambda: len(source.topics()) == 2, WAIT)
    assert source.topics()["/a"].publishers is None
    graph = ConnectionGraph()
    graph.set_published_topic("/a", ["/talker", "/other"])
    graph.set_subscribed_topic("/b", ["/listener"])
    assert peer.server is not None

    def told() -> bool:
        # Only those that have asked for the graph get it.
        peer.server.publish_connection_graph(graph)
        return source.topics()["/a"].publishers is not None

    until(told, WAIT)
    assert set(source.topics()["/a"].publishers or ()) == {"/talker", "/other"}
    assert source.topics()["/b"].publishers == ()
    assert source.topics()["/a"].subscribers == ()
    assert source.topics()["/b"].subscribers == ("/listener",)


def test_warnings_of_the_server_are_said_until_it_takes_them_back(
    robot: Peer, opened: Open
) -> None:
    peer = robot()
    source = opened(peer.uri)
    until(lambda: source.status.is_connected, WAIT)
    assert peer.server is not None
    peer.server.publish_status(
        "The battery is low", foxglove.StatusLevel.Warning, "battery"
    )
    until(lambda: "it says: The battery is low" in source.status.sentence, WAIT)
    peer.server.remove_status(["battery"])
    until(lambda: source.status.sentence.endswith("(robot)"), WAIT)


def test_channels_of_one_topic_are_told_apart(
    robot: Peer, opened: Open, inbox: Inbox
) -> None:
    peer = robot()
    peer.advertise("/a")
    source = opened(peer.uri)
    source.subscribe("/a", inbox)
    until(lambda: peer.subscribed() == ["/a"], WAIT)
    second = foxglove.Channel("/a", message_encoding="json", context=peer.context)
    until(lambda: peer.subscribed() == ["/a", "/a"], WAIT)
    peer.publish("/a", "one")
    until(lambda: len(inbox.messages) == 1, WAIT)
    second.log(b'{"data": "two"}')
    until(lambda: len(inbox.messages) == 2, WAIT)
    encodings = [message.channel.message_encoding for message in inbox.messages]
    assert encodings == ["cdr", "json"]
    assert list(source.topics()) == ["/a"]


def test_a_description_may_come_from_a_parameter(
    robot: Peer, opened: Open, inbox: Inbox
) -> None:
    peer = robot(DescribedPeer)
    assert isinstance(peer, DescribedPeer)
    source = opened(peer.uri)
    source.subscribe("/robot_description", inbox)
    inbox.wait_for("<robot/>")
    (message,) = inbox.messages
    assert bytes(message.payload) == cdr_string("<robot/>")
    until(lambda: "/robot_description" in source.topics(), WAIT)
    topic = source.topics()["/robot_description"]
    assert topic.publishers == ("parameter of /robot_state_publisher",)
    assert (topic.schema.name, topic.is_latched) == ("std_msgs/msg/String", True)
    assert peer.asked == [[DESCRIPTION, "/robot_description"]]
    late = Inbox()
    source.subscribe("/robot_description", late)
    late.wait_for("<robot/>")


def test_a_topic_with_the_description_goes_before_the_parameter(
    robot: Peer, opened: Open, inbox: Inbox
) -> None:
    peer = robot(DescribedPeer)
    assert isinstance(peer, DescribedPeer)
    peer.advertise("/robot_description", latched=True)
    peer.publish("/robot_description", "<of the topic/>")
    source = opened(peer.uri)
    # A bridge gets a moment to name its topics, in which a busy machine does not.
    until(lambda: "/robot_description" in source.topics(), WAIT)
    source.subscribe("/robot_description", inbox)
    source.subscribe("/a/robot_description", inbox)
    inbox.wait_for("<of the topic/>")
    until(lambda: peer.asked, WAIT)
    expected = "/a/robot_state_publisher.robot_description"
    assert peer.asked == [[expected, "/a/robot_description"]]


def test_a_simulated_clock_is_read_as_soon_as_a_topic_is(
    robot: Peer, opened: Open, inbox: Inbox
) -> None:
    peer = robot(capabilities=[])
    clock = foxglove.Channel(
        "/clock",
        schema=foxglove.Schema(
            name="rosgraph_msgs/msg/Clock",
            encoding="ros2msg",
            data=b"builtin_interfaces/Time clock",
        ),
        message_encoding="cdr",
        context=peer.context,
    )
    peer.advertise("/a")
    source = opened(peer.uri)
    until(lambda: len(source.topics()) == 2, WAIT)
    assert peer.subscribed() == [], "nobody wants a topic yet"
    source.subscribe("/a", inbox)
    until(lambda: peer.subscribed() == ["/a", "/clock"], WAIT)
    clock.log(b"\0\1\0\0" + (5).to_bytes(4, "little") + (7).to_bytes(4, "little"))
    until(lambda: source.clock_ns() == 5_000_000_007, WAIT)
    source.unsubscribe("/a", inbox)
    until(lambda: peer.subscribed() == [], WAIT)

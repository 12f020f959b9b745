"""What is published to a robot, over every transport: it comes, or it is refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from foxglove.websocket import Capability
from live_peers import FoxglovePeer, LivePeer, cdr_string, cdr_word, eventually
from rosbridge_peer import RosbridgePeer

from sambot_viz.errors import SourceError
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.joined import JoinedSources
from sambot_viz.sources.playback import RecordingPlayback
from sambot_viz.sources.prefixed_source import PrefixedSource
from sambot_viz.sources.registry import open_source
from sambot_viz.sources.source import Outgoing, Receivers, Source

GOAL, WORDS = "/goal", "std_msgs/msg/String"


@pytest.fixture
def source(peer: LivePeer, opened: Callable[[str], Source]) -> Source:
    made = opened(peer.uri)
    eventually(lambda: made.status.is_connected)
    return made


def written(outgoing: Outgoing, word: str) -> bytes:
    """A message as the source wants it."""
    if outgoing.encoding == "json":
        return json.dumps({"data": word}).encode()
    return cdr_string(word)


def words(peer: LivePeer) -> list[str]:
    """What has come, in its order."""
    return [
        one.content["data"] if isinstance(one.content, dict) else cdr_word(one.content)
        for one in peer.came()
    ]


def test_what_is_published_comes_once_in_its_order(
    peer: LivePeer, source: Source
) -> None:
    outgoing = source.advertise(GOAL, WORDS)
    eventually(lambda: peer.advertised() == [(GOAL, WORDS)])
    for word in ("one", "two", 'three "3"'):
        outgoing.send(written(outgoing, word))
    eventually(lambda: words(peer) == ["one", "two", 'three "3"'])
    assert {(one.topic, one.type_name) for one in peer.came()} == {(GOAL, WORDS)}
    outgoing.close()
    outgoing.close()
    eventually(lambda: peer.advertised() == [])
    with pytest.raises(SourceError, match="it was closed"):
        outgoing.send(written(outgoing, "late"))


def test_nothing_is_sent_again_after_the_connection_was_lost(
    peer: LivePeer, source: Source
) -> None:
    outgoing = source.advertise(GOAL, WORDS)
    outgoing.send(written(outgoing, "before"))
    eventually(lambda: words(peer) == ["before"])
    peer.stop()
    eventually(lambda: not source.status.is_connected)
    with pytest.raises(SourceError, match="the connection was lost"):
        outgoing.send(written(outgoing, "meanwhile"))
    with pytest.raises(SourceError, match="nothing can be sent: "):
        source.advertise(GOAL, WORDS)
    peer.start()
    eventually(lambda: source.status.is_connected)
    with pytest.raises(SourceError, match="the connection was lost"):
        outgoing.send(written(outgoing, "after"))
    again = source.advertise(GOAL, WORDS)
    again.send(written(again, "again"))
    eventually(lambda: words(peer) == ["before", "again"])


def test_it_is_told_who_gets_it(peer: LivePeer, source: Source) -> None:
    outgoing = source.advertise(GOAL, WORDS)
    eventually(lambda: outgoing.receivers == Receivers(()))
    peer.listen_as(GOAL, "/navigator")
    eventually(lambda: outgoing.receivers.names == ("/navigator",))
    # What others publish on it says of which type it is, where subscribers do not.
    peer.advertise(GOAL)
    peer.listen_as(GOAL)
    eventually(lambda: outgoing.receivers == Receivers((), WORDS))


def test_a_refusal_is_said_in_the_words_of_the_robot(
    peer: LivePeer, source: Source
) -> None:
    one, other = source.advertise(GOAL, WORDS), source.advertise("/other", WORDS)
    eventually(lambda: len(peer.advertised()) == 2)
    peer.complain("the topic /goal is not in the whitelist")
    eventually(lambda: one.refused == "the topic /goal is not in the whitelist")
    assert other.refused == ""


def test_a_server_that_takes_nothing_says_how_it_would() -> None:
    for options, why in (
        ({"capabilities": [Capability.Time]}, "add clientPublish to its parameter"),
        ({"supported_encodings": ["ros1"]}, "takes ros1, and not the CDR of ROS 2"),
    ):
        peer = FoxglovePeer(**options)
        source = open_source(peer.uri)
        source.open()
        eventually(lambda one=source: one.status.is_connected)
        assert "publish" not in source.capabilities
        with pytest.raises(SourceError, match=why):
            source.advertise(GOAL, WORDS)
        source.close()
        peer.stop()


def test_a_recording_takes_nothing(repository: Path) -> None:
    recording = open_recording(repository / "assets" / "square.mcap")
    source = RecordingPlayback(recording, "square.mcap")
    with pytest.raises(SourceError, match=r"is a recording.*--source foxglove"):
        source.advertise(GOAL, WORDS)
    source.close()


def test_among_several_the_robot_that_has_the_topic_gets_it(repository: Path) -> None:
    recording = open_recording(repository / "assets" / "square.mcap")
    peers = [FoxglovePeer(), RosbridgePeer()]
    peers[1].advertise("/second/goal")
    robots = [open_source(peer.uri) for peer in peers]
    prefixed = PrefixedSource(robots[0], "a")
    source = JoinedSources([RecordingPlayback(recording, "r"), prefixed, robots[1]])
    source.open()
    eventually(lambda: source.status.is_whole and "/second/goal" in source.topics())
    for topic in ("/a/goal", "/second/goal"):
        outgoing = source.advertise(topic, WORDS)
        outgoing.send(written(outgoing, topic))
    eventually(lambda: [one.topic for one in peers[0].came()] == ["/goal"])
    eventually(lambda: words(peers[1]) == ["/second/goal"])
    source.close()
    for peer in peers:
        peer.stop()

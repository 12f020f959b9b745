"""Services of a robot, over every transport: they answer, or it is said why not."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from live_peers import LivePeer, cdr_string, eventually

from sambot_viz.errors import SourceError
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.playback import RecordingPlayback
from sambot_viz.sources.prefixed_source import PrefixedSource
from sambot_viz.sources.registry import open_source
from sambot_viz.sources.source import Encoding, Reply, Source

ECHO = "/echo"


@pytest.fixture
def source(peer: LivePeer, opened: Callable[[str], Source]) -> Source:
    peer.serve(ECHO)
    made = opened(peer.uri)
    eventually(lambda: made.status.is_connected)
    return made


def request(encoding: Encoding) -> bytes:
    """A string as the peer wants it."""
    return b'{"data": "so"}' if encoding == "json" else cdr_string("so")


def call(source: Source, service: str) -> Reply:
    """Call a service and wait for what becomes of it."""
    replies: list[Reply] = []
    source.call(service, request, replies.append)
    eventually(lambda: len(replies) == 1)
    return replies[0]


def test_a_service_answers(peer: LivePeer, source: Source) -> None:
    # It may be told of a moment after the connection is there.
    eventually(lambda: not call(source, ECHO).refusal)
    reply = call(source, ECHO)
    assert reply.content == request("json" if reply.is_json else "cdr")
    assert peer.calls()[-1] == ECHO


def test_a_service_that_there_is_not_says_so(source: Source) -> None:
    reply = call(source, "/nowhere")
    assert "/nowhere" in reply.refusal and not reply.content


def test_a_service_that_fails_says_why_in_its_own_words(
    peer: LivePeer, source: Source
) -> None:
    eventually(lambda: not call(source, ECHO).refusal)
    peer.serve(ECHO, "the battery is empty")
    assert "the battery is empty" in call(source, ECHO).refusal


def test_a_call_ends_with_the_connection(peer: LivePeer, source: Source) -> None:
    eventually(lambda: not call(source, ECHO).refusal)
    peer.stop()
    eventually(lambda: not source.status.is_connected)
    with pytest.raises(SourceError, match="nothing can be sent: "):
        source.call(ECHO, request, lambda reply: None)


def test_a_robot_with_a_prefix_is_called_by_its_own_names(
    peer: LivePeer, opened: Callable[[str], Source]
) -> None:
    peer.serve(ECHO)
    source = PrefixedSource(open_source(peer.uri), "a")
    source.open()
    try:
        eventually(lambda: source.status.is_connected)
        eventually(lambda: not call(source, "/a/echo").refusal)
    finally:
        source.close()


def test_a_recording_has_no_services(repository: Path) -> None:
    recording = open_recording(repository / "assets/square.mcap")
    source = RecordingPlayback(recording, "r")
    with pytest.raises(SourceError, match="is a recording"):
        source.call(ECHO, request, lambda reply: None)
    recording.close()

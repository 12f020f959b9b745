"""What every source does, a recording of any format or a robot of any transport."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import get_args

import pytest
from any_recording import FORMATS, Given, write_any
from live_peers import WAIT, FoxglovePeer, LivePeer, cdr_string
from patience import until
from rosbridge_peer import RosbridgePeer

from sambot_viz.errors import SourceError
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.playback import RecordingPlayback
from sambot_viz.sources.registry import open_source
from sambot_viz.sources.source import Capability, Source

CHATTER, STATIC = "/chatter", "/tf_static"
WORDS = ("one", "two", "three")
HELD = "wheels"
MERGED = "two files"


class World(ABC):
    """A robot that says some words on one topic, and holds one on another."""

    source: Source

    @abstractmethod
    def say(self, number: int) -> None:
        """Let the words up to a number be said."""

    @abstractmethod
    def wait(self, condition: Callable[[], bool]) -> None:
        """Wait until something has come."""

    @abstractmethod
    def close(self) -> None:
        """End it."""


class LiveWorld(World):
    """A robot on the network."""

    def __init__(self, peer: LivePeer) -> None:
        self._peer = peer
        self._said = 0
        peer.advertise(CHATTER)
        peer.advertise(STATIC, latched=True)
        peer.publish(STATIC, HELD)
        self.source = open_source(peer.uri)
        self.source.open()
        self.wait(lambda: {CHATTER, STATIC} <= set(self.source.topics()))

    def say(self, number: int) -> None:
        self.wait(lambda: CHATTER in self._peer.subscribed())
        for word in WORDS[self._said : number]:
            self._peer.publish(CHATTER, word)
        self._said = number

    def wait(self, condition: Callable[[], bool]) -> None:
        until(condition, WAIT)

    def close(self) -> None:
        self.source.close()
        self._peer.stop()


class RecordedWorld(World):
    """A recording, whose time goes on."""

    def __init__(self, folder: Path, kind: str) -> None:
        encode = _ros1_string if kind == "bag" else cdr_string
        held = Given(STATIC, [encode(HELD)])
        said = Given(CHATTER, [encode(word) for word in WORDS])
        if kind == MERGED:
            paths = [folder / "one", folder / "other"]
            for path in paths:
                path.mkdir()
            files = [
                write_any(paths[0], "mcap", [held]),
                write_any(paths[1], "db3", [said], start=10**6),
            ]
        else:
            files = [write_any(folder, kind, [held, said])]
        recording = open_recording(files)
        self._times = [m.log_ns for m in recording.messages(topics=[CHATTER])]
        self.source = RecordingPlayback(recording, "made")
        self.source.open()

    def say(self, number: int) -> None:
        playback = self.source.playback
        assert playback is not None
        playback.advance(self._times[number - 1])

    def wait(self, condition: Callable[[], bool]) -> None:
        assert condition()

    def close(self) -> None:
        self.source.close()


def _ros1_string(data: str) -> bytes:
    return len(data).to_bytes(4, "little") + data.encode()


LIVE: dict[str, Callable[[], LivePeer]] = {
    "foxglove": FoxglovePeer,
    "rosbridge": RosbridgePeer,
}


@pytest.fixture(params=[*LIVE, *FORMATS, MERGED])
def world(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[World]:
    peer = LIVE.get(request.param)
    world = (
        RecordedWorld(tmp_path, request.param) if peer is None else LiveWorld(peer())
    )
    yield world
    world.close()


class Heard:
    """A callback that keeps the words that come."""

    def __init__(self) -> None:
        self.messages: list[Recorded] = []

    def __call__(self, message: Recorded) -> None:
        self.messages.append(message)

    @property
    def words(self) -> list[str]:
        kept = list(self.messages)
        known = (*WORDS, HELD)
        return [w for m in kept for w in known if w.encode() in bytes(m.payload)]


def test_it_lists_its_topics(world: World) -> None:
    topics = world.source.topics()
    assert set(topics) == {CHATTER, STATIC}
    assert [topics[name].is_latched for name in (CHATTER, STATIC)] == [False, True]
    for name, topic in topics.items():
        assert topic.name == name
        assert topic.schema.name.replace("/msg/", "/") == "std_msgs/String"
        assert topic.message_encoding in ("cdr", "ros1")
        assert topic.reason is None
    assert world.source.status.is_connected


def test_a_subscriber_gets_each_message_once_in_its_order(world: World) -> None:
    heard, other = Heard(), Heard()
    for one in (heard, heard, other):
        world.source.subscribe(CHATTER, one)
    world.say(1)
    world.wait(lambda: heard.words == ["one"] == other.words)
    world.source.unsubscribe(CHATTER, other)
    world.source.unsubscribe(CHATTER, other)
    world.say(3)
    world.wait(lambda: heard.words == [*WORDS])
    assert other.words == ["one"]
    assert {message.topic for message in heard.messages} == {CHATTER}
    times = [message.log_ns for message in heard.messages]
    assert times == sorted(times)


def test_a_topic_need_not_exist(world: World) -> None:
    world.source.subscribe("/nowhere", Heard())
    heard = Heard()
    world.source.subscribe(CHATTER, heard)
    world.say(1)
    world.wait(lambda: heard.words == ["one"])


def test_those_who_come_late_get_what_holds(world: World) -> None:
    first, heard = Heard(), Heard()
    world.source.subscribe(STATIC, first)
    world.source.subscribe(CHATTER, heard)
    world.say(2)
    world.wait(lambda: first.words == [HELD] and heard.words == ["one", "two"])
    new, kept, last = Heard(), Heard(), Heard()
    world.source.subscribe(STATIC, new, kept)
    world.source.subscribe(CHATTER, Heard(), last)
    world.wait(lambda: kept.words == [HELD] and last.words == ["two"])
    assert new.words == []


def test_nothing_comes_after_the_end(world: World) -> None:
    heard, told = Heard(), list[str]()
    world.source.subscribe(CHATTER, heard)
    world.say(1)
    world.wait(lambda: heard.words == ["one"])
    world.source.close()
    world.source.close()
    world.source.on_topics = lambda: told.append("topics")
    world.source.on_status = lambda: told.append("status")
    late = Heard()
    world.source.subscribe(CHATTER, late)
    world.source.unsubscribe(CHATTER, heard)
    if world.source.playback is not None:
        world.source.playback.advance(world.source.playback.end_ns)
    world.source.open()
    assert not world.source.status.is_connected
    assert world.source.status.sentence.endswith("is closed")
    assert (heard.words, late.words, told) == (["one"], [], [])


def test_it_can_do_what_it_says(world: World) -> None:
    source = world.source
    assert source.capabilities <= set(get_args(Capability))
    assert {"topics", "subscribe", "latched"} <= source.capabilities
    # No source has these yet; one that has them says so here.
    assert not source.capabilities & {"parameters", "call"}
    is_live = source.live is not None
    assert ({"publish", "graph"} <= source.capabilities) == is_live
    assert ("seek" in source.capabilities) == (source.playback is not None)
    before = source.clock_ns()
    assert before > 0
    if "clock" in source.capabilities:
        world.wait(lambda: source.clock_ns() > before)
    else:
        assert source.clock_ns() == before
    assert "files" not in source.capabilities
    with pytest.raises(SourceError):
        source.fetch_asset("package://a/b.stl").result(WAIT)


def test_its_time_can_be_moved_if_it_has_one(world: World) -> None:
    heard, kept = Heard(), Heard()
    playback = world.source.playback
    if playback is None:
        assert world.source.of_session() is world.source
        return
    world.source.subscribe(CHATTER, heard, kept)
    world.say(3)
    playback.seek(playback.start_ns)
    assert playback.time_ns == world.source.clock_ns() == playback.start_ns
    world.say(2)
    assert heard.words == [*WORDS, "one", "two"]
    playback.seek(playback.end_ns + 10**9)
    assert playback.time_ns == playback.end_ns
    assert kept.words == ["three"]
    # Another session has another time, and its end is not that of the recording.
    own = world.source.of_session().playback
    assert own is not None
    own.seek(own.start_ns)
    assert playback.time_ns == playback.end_ns
    own.close()
    playback.seek(playback.start_ns)
    world.say(1)
    assert heard.words[-1] == "one"


def test_nothing_is_read_that_nobody_asks_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = RecordedWorld(tmp_path, "mcap")
    playback = world.source.playback
    assert playback is not None
    read = list[object]()
    messages = playback.recording.messages
    monkeypatch.setattr(
        playback.recording, "messages", lambda *a: read.append(a) or messages(*a)
    )
    playback.advance(playback.end_ns)
    playback.seek(playback.start_ns)
    assert read == []
    world.close()

"""A recording has all that a live source gives, and opens in other programs."""

from __future__ import annotations

import errno
import io
import os
import random
import resource
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event
from typing import Any

import pytest
from live_peers import WAIT, FoxglovePeer, LivePeer
from lower_limit import lower
from mcap.reader import make_reader
from patience import until
from rosbridge_peer import RosbridgePeer

from sambot_viz.errors import UsageError
from sambot_viz.messages import MessageTypes
from sambot_viz.sources import recorder as recorder_module
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.recorder import RecordingPlace, SourceRecorder
from sambot_viz.sources.recording_thread import RecordingStatus
from sambot_viz.sources.registry import open_source
from sambot_viz.sources.source import Source
from sambot_viz.topics.source_robot import SourceRobot


@pytest.fixture(params=[FoxglovePeer, RosbridgePeer])
def peer(request: pytest.FixtureRequest) -> Iterator[LivePeer]:
    made: LivePeer = request.param()
    yield made
    made.stop()


@pytest.fixture
def foxglove_peer() -> Iterator[FoxglovePeer]:
    made = FoxglovePeer()
    yield made
    made.stop()


@pytest.fixture
def source(request: pytest.FixtureRequest) -> Iterator[Source]:
    name = "foxglove_peer" if "foxglove_peer" in request.fixturenames else "peer"
    made = open_source(request.getfixturevalue(name).uri)
    yield made
    made.close()


def eventually(condition: Callable[[], Any], why: str = "it never came") -> None:
    until(condition, WAIT, not_yet=(), why=why)


def status(recorder: SourceRecorder) -> RecordingStatus:
    found = recorder.status
    assert found is not None
    return found


@contextmanager
def recorded(
    peer: LivePeer, source: Source, path: Path, topic: str = "/a"
) -> Iterator[SourceRecorder]:
    """Records a topic that the peer begins to publish; the file is whole afterwards."""
    peer.advertise(topic)
    recorder = SourceRecorder(source, None, lambda: None, period=0.1)
    recorder.start(path)
    source.open()
    eventually(lambda: peer.subscribed() == [topic])
    yield recorder
    recorder.stop()


def has(recorder: SourceRecorder, messages: int) -> Callable[[], bool]:
    return lambda: status(recorder).messages == messages


def strings(path: Path) -> list[tuple[str, str]]:
    """The strings of a recording by our reader, which the mcap package confirms."""
    with open_recording(path) as recording:
        ours = [(one.topic, bytes(one.payload)) for one in recording.messages()]
        assert not recording.problems
    with path.open("rb") as stream:
        theirs = [
            (channel.topic, message.data)
            for _, channel, message in make_reader(stream).iter_messages()
        ]
    assert sorted(ours) == sorted(theirs)
    return [(topic, payload[8:-1].decode()) for topic, payload in ours]


def test_everything_is_recorded_as_it_came(
    peer: LivePeer, source: Source, tmp_path: Path
) -> None:
    path = tmp_path / "all.mcap"
    recorder = SourceRecorder(source, None, lambda: None, period=0.1)
    peer.advertise("/a")
    peer.advertise("/tf_static", latched=True)
    peer.publish("/tf_static", "place")
    recorder.start(path)
    source.open()
    eventually(lambda: peer.subscribed() == ["/a", "/tf_static"])
    eventually(has(recorder, 1))
    for number in range(100):
        peer.publish("/a", f"message {number}")
    eventually(has(recorder, 101))
    peer.advertise("/later")
    eventually(lambda: "/later" in peer.subscribed())
    peer.publish("/later", "late")
    eventually(has(recorder, 102))
    recorder.stop()
    assert strings(path) == [
        ("/tf_static", "place"),
        *(("/a", f"message {number}") for number in range(100)),
        ("/later", "late"),
    ]
    with open_recording(path) as recording:
        topics = recording.topics
        assert topics["/a"].schema.name == "std_msgs/msg/String"
        assert topics["/a"].schema.text == "string data\n"
        assert topics["/a"].message_encoding == "cdr"
        assert topics["/tf_static"].is_latched
        assert not topics["/a"].is_latched
        assert [bytes(one.payload[8:-1]) for one in recording.latched()] == [b"place"]
    eventually(lambda: peer.subscribed() == [])


def test_latched_messages_from_before_the_start_stand_at_the_begin(
    peer: LivePeer, source: Source, tmp_path: Path
) -> None:
    peer.advertise("/a")
    peer.advertise("/map")
    peer.advertise("/tf_static", latched=True)
    seen: list[object] = []
    source.subscribe("/tf_static", seen.append)
    source.subscribe("/map", seen.append)
    source.subscribe("/a", seen.append)
    source.open()
    eventually(lambda: peer.subscribed() == ["/a", "/map", "/tf_static"])
    peer.publish("/map", "old walls")
    peer.publish("/map", "walls")
    peer.publish("/tf_static", "place")
    peer.publish("/a", "before")
    eventually(lambda: len(seen) == 4)
    recorder = SourceRecorder(
        source, RecordingPlace(tmp_path), lambda: None, period=0.1
    )
    recorder.start()
    eventually(has(recorder, 2))
    peer.publish("/a", "first")
    eventually(has(recorder, 3))
    recorder.stop()
    path = tmp_path / status(recorder).name
    *before, first = strings(path)
    assert sorted(before) == [("/map", "walls"), ("/tf_static", "place")]
    assert first == ("/a", "first")
    # Those who had subscribed before still get everything.
    peer.publish("/a", "after")
    eventually(lambda: len(seen) == 6)


def test_a_connection_that_comes_back_goes_on_in_the_same_file(
    peer: LivePeer, source: Source, tmp_path: Path
) -> None:
    path = tmp_path / "one.mcap"
    with recorded(peer, source, path) as recorder:
        peer.publish("/a", "before")
        eventually(has(recorder, 1))
        peer.stop()
        eventually(lambda: not source.status.is_connected)
        peer.start()
        eventually(lambda: peer.subscribed() == ["/a"])
        peer.publish("/a", "after")
        eventually(has(recorder, 2))
    assert strings(path) == [("/a", "before"), ("/a", "after")]
    with path.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None and len(summary.channels) == 1


def test_json_of_rosbridge_is_recorded_as_json(tmp_path: Path) -> None:
    peer = RosbridgePeer()
    peer.is_json = True
    source = open_source(peer.uri)
    try:
        path = tmp_path / "json.mcap"
        with recorded(peer, source, path) as recorder:
            peer.publish("/a", "words")
            eventually(has(recorder, 1))
    finally:
        source.close()
        peer.stop()
    with open_recording(path) as recording:
        topic = recording.topics["/a"]
        assert (topic.message_encoding, topic.schema.encoding) == ("json", "jsonschema")
        decoder = MessageTypes().decoder(topic.schema, topic.message_encoding)
        assert decoder.reason is None
        assert decoder.type_name == "std_msgs/msg/String"
        payloads = [one.payload for one in recording.messages()]
        assert [decoder.decode(one) for one in payloads] == [{"data": "words"}]


def test_a_live_robot_that_is_closed_ends_its_recording_with_all_that_came(
    foxglove_peer: FoxglovePeer, source: Source, tmp_path: Path
) -> None:
    path = tmp_path / "closed.mcap"
    foxglove_peer.advertise("/a")
    live = SourceRobot(source, MessageTypes(), recordings=RecordingPlace(tmp_path))
    came: list[object] = []
    live.recorder.start(path)
    source.open()
    eventually(lambda: foxglove_peer.subscribed() == ["/a"])
    # After the recorder, which so has each message before.
    source.subscribe("/a", came.append)
    foxglove_peer.publish("/a", "words")
    eventually(lambda: came)
    live.close()
    live.close()
    assert strings(path) == [("/a", "words")]
    assert not status(live.recorder).is_running
    assert not source.status.is_connected
    live.recorder.start()
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_is_never_overwritten(
    foxglove_peer: FoxglovePeer, source: Source, tmp_path: Path
) -> None:
    path = tmp_path / "there.mcap"
    path.write_bytes(b"precious")
    recorder = SourceRecorder(source, None, lambda: None, period=0.1)
    with pytest.raises(UsageError, match=r"there already; give a name for a new file"):
        recorder.start(path)
    assert path.read_bytes() == b"precious"
    assert recorder.status is None
    with pytest.raises(UsageError, match="not offered"):
        recorder.start()
    with pytest.raises(UsageError, match="cannot be written: there is no such file"):
        recorder.start(tmp_path / "none" / "new.mcap")


def test_recordings_of_one_second_have_different_names(tmp_path: Path) -> None:
    place = RecordingPlace(tmp_path)
    begun = [recorder_module._named(place, 1.0) for _ in range(3)]  # pyright: ignore[reportPrivateUsage]
    for target in begun:
        target.close()
    names = {target.name for target in begun}
    assert len(names) == 3
    assert all(name.endswith(".mcap") for name in names)


def test_a_recording_without_a_message_leaves_no_file(
    foxglove_peer: FoxglovePeer, source: Source, tmp_path: Path
) -> None:
    recorder = SourceRecorder(source, None, lambda: None, period=0.1)
    recorder.start(tmp_path / "nothing.mcap")
    recorder.stop()
    assert not status(recorder).is_running
    assert status(recorder).trouble == "No message came, so there is no file"
    assert list(tmp_path.iterdir()) == []


class FullDisk(io.RawIOBase):
    """Takes so many bytes, and then no more."""

    def __init__(self, room: int) -> None:
        self.room = room

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = 0) -> int:
        return 0

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        self.room -= len(data)
        if self.room < 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return len(data)


def test_a_full_disk_ends_the_recording_and_nothing_else(
    foxglove_peer: FoxglovePeer,
    source: Source,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    path = tmp_path / "full.mcap"
    path.touch()
    full = io.BufferedWriter(FullDisk(room=100))
    monkeypatch.setattr(recorder_module, "_created", lambda path: (path, full))
    shown: list[object] = []
    foxglove_peer.advertise("/a")
    source.subscribe("/a", shown.append)
    recorder = SourceRecorder(source, None, lambda: None, period=0.1)
    recorder.start(path)
    source.open()
    eventually(lambda: foxglove_peer.subscribed() == ["/a"])
    foxglove_peer.publish("/a", "x" * 1000)
    eventually(lambda: not status(recorder).is_running)
    sentence = "Recording full.mcap ended: no space left on device"
    assert status(recorder).trouble == sentence
    assert sentence in caplog.text
    foxglove_peer.publish("/a", "after")
    eventually(lambda: len(shown) == 2)
    # Another can begin.
    monkeypatch.undo()
    recorder.start(tmp_path / "next.mcap")
    foxglove_peer.publish("/a", "again")
    eventually(has(recorder, 1))
    recorder.stop()
    assert strings(tmp_path / "next.mcap") == [("/a", "again")]


def test_what_a_full_disk_has_is_whole_and_opens_in_other_programs(
    foxglove_peer: FoxglovePeer, source: Source, tmp_path: Path
) -> None:
    path, rng = tmp_path / "full.mcap", random.Random(7)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        with recorded(foxglove_peer, source, path) as recorder:
            for number in range(3):
                foxglove_peer.publish("/a", rng.randbytes(10_000).hex())
                # Each is in a chunk of its own; hexadecimal digits shrink by half.
                eventually(lambda n=number + 1: path.stat().st_size > n * 10_000)
            # No more than some thousand bytes of the next one.
            room = path.stat().st_size + 4096
            resource.setrlimit(resource.RLIMIT_FSIZE, (room, limits[1]))
            foxglove_peer.publish("/a", rng.randbytes(10_000).hex())
            eventually(lambda: not status(recorder).is_running)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert status(recorder).trouble == "Recording full.mcap ended: file too large"
    # Both readers agree, and miss nothing.
    assert len(strings(path)) == status(recorder).messages == 3
    with path.open("rb") as stream:
        summary = make_reader(stream, validate_crcs=True).get_summary()
    assert summary is not None and summary.statistics is not None
    assert summary.statistics.message_count == 3
    assert len(summary.chunk_indexes) == 3


def test_a_disk_that_is_too_slow_costs_messages_which_are_counted(
    foxglove_peer: FoxglovePeer,
    source: Source,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lower(monkeypatch, "RECORDING_MESSAGES", 0)
    path = tmp_path / "slow.mcap"
    with recorded(foxglove_peer, source, path) as recorder:
        foxglove_peer.publish("/a", "lost")
        eventually(lambda: status(recorder).dropped == 1)
        assert status(recorder).missing == (
            "1 message is not in it: the disk is too slow"
        )
        monkeypatch.undo()
        foxglove_peer.publish("/a", "kept")
        eventually(has(recorder, 1))
    assert strings(path) == [("/a", "kept")]


def test_messages_for_which_the_format_has_no_place_are_said_as_such(
    foxglove_peer: FoxglovePeer,
    source: Source,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lower(monkeypatch, "RECORDING_CHANNELS", 1)
    path = tmp_path / "many.mcap"
    with recorded(foxglove_peer, source, path) as recorder:
        foxglove_peer.advertise("/b")
        eventually(lambda: foxglove_peer.subscribed() == ["/a", "/b"])
        foxglove_peer.publish("/a", "first")
        eventually(has(recorder, 1))
        foxglove_peer.publish("/b", "no place")
        foxglove_peer.publish("/b", "nor for this")
        foxglove_peer.publish("/a", "last")
        eventually(has(recorder, 2))
        eventually(lambda: status(recorder).unfit == 2)
    assert strings(path) == [("/a", "first"), ("/a", "last")]
    assert status(recorder).dropped == 0
    assert status(recorder).missing == (
        "2 messages are not in it: MCAP has no place for their time, or for so many "
        "topics"
    )


def test_messages_that_were_lost_on_the_way_to_the_recorder_are_said(
    foxglove_peer: FoxglovePeer,
    source: Source,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lower(monkeypatch, "WAITING", 3)
    path, gate, entered = tmp_path / "lost.mcap", Event(), Event()

    def slow(message: object) -> None:
        entered.set()
        gate.wait(WAIT)

    with recorded(foxglove_peer, source, path) as recorder:
        source.subscribe("/a", slow)
        foxglove_peer.publish("/a", "first")
        assert entered.wait(WAIT)
        for number in range(10):
            foxglove_peer.publish("/a", f"{number}")
        eventually(lambda: source.status.dropped == 7)
        gate.set()
        eventually(has(recorder, 4))
    assert strings(path) == [("/a", word) for word in ("first", "7", "8", "9")]
    assert status(recorder).missing == (
        "7 messages are not in it: this computer is too slow"
    )
    # What was lost before is not missing from the next one.
    recorder.start(tmp_path / "next.mcap")
    foxglove_peer.publish("/a", "again")
    eventually(has(recorder, 1))
    recorder.stop()
    assert status(recorder).missing == ""


KILLED = """
import sys, time
from pathlib import Path
from sambot_viz.sources.recorder import RecordingPlace, SourceRecorder
from sambot_viz.sources.registry import open_source
source = open_source(sys.argv[1])
def tell():
    print(recorder.status.messages, flush=True)
recorder = SourceRecorder(source, None, tell, period=0.1)
recorder.start(Path(sys.argv[2]))
source.open()
time.sleep(1000)
"""


def test_what_was_flushed_is_there_after_a_kill(
    foxglove_peer: FoxglovePeer, tmp_path: Path
) -> None:
    path = tmp_path / "killed.mcap"
    foxglove_peer.advertise("/a")
    words = [sys.executable, "-c", KILLED, foxglove_peer.uri, str(path)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            eventually(lambda: foxglove_peer.subscribed() == ["/a"])
            for number in range(10):
                foxglove_peer.publish("/a", f"message {number}")
            # It tells how much was written after a flush.
            assert any(line == "10\n" for line in process.stdout)
            assert any(line == "10\n" for line in process.stdout)
        finally:
            process.send_signal(signal.SIGKILL)
    with open_recording(path) as recording:
        found = [bytes(one.payload[8:-1]).decode() for one in recording.messages()]
        assert found == [f"message {number}" for number in range(10)]

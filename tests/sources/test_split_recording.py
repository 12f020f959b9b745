"""A recording in several files is a folder of rosbag2, whole up to its last file."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from live_peers import FoxglovePeer, cdr_word, eventually
from parted_recording import PartedRecording
from rosbags.rosbag2 import Reader

from sambot_viz.errors import UsageError
from sambot_viz.options import Options
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.recorder import RecordingPlace, SourceRecorder
from sambot_viz.sources.registry import open_source

Parted = Callable[..., PartedRecording]


def words_of(path: Path) -> list[tuple[str, str]]:
    with open_recording(path) as recording:
        assert not recording.problems
        return [(one.topic, cdr_word(one.payload)) for one in recording.messages()]


def listed(folder: Path) -> str:
    return (folder / "metadata.yaml").read_text("utf-8")


@pytest.fixture
def made(parted: Parted, tmp_path: Path) -> PartedRecording:
    return parted(tmp_path / "run")


def test_each_file_is_whole_once_it_is_listed_and_rosbag2_reads_the_folder(
    made: PartedRecording,
) -> None:
    assert "run_0" not in listed(made.folder)
    made.part("one", "two")
    assert "run_0.mcap" in listed(made.folder)
    assert "run_1.mcap" not in listed(made.folder)
    assert words_of(made.folder / "run_0.mcap") == [
        ("/words", w) for w in ("one", "two")
    ]
    made.part("three")
    made.say("four")
    assert "running" in listed(made.folder)
    made.end()
    assert "running" not in listed(made.folder) and "ended" in listed(made.folder)
    assert made.names() == ["run_0.mcap", "run_1.mcap", "run_2.mcap"]
    with Reader(made.folder) as reader:
        assert reader.message_count == 4
        assert reader.topics["/words"].msgtype == "std_msgs/msg/String"
        # Without the nanosecond after the last message.
        assert reader.duration - 1 == 3 * 10**6
        found = [cdr_word(data) for _, _, data in reader.messages()]
    assert found == ["one", "two", "three", "four"]
    assert [word for _, word in words_of(made.folder)] == found
    assert not [path for path in made.folder.iterdir() if path.name.startswith(".")]


def test_each_file_begins_with_the_latched_messages_that_hold(
    made: PartedRecording,
) -> None:
    made.say("left wheel", "right wheel", topic="/tf_static")
    made.say("old robot", "robot", topic="/robot_description")
    made.part("one")
    made.part("two")
    made.say("new robot", topic="/robot_description")
    made.end()
    held = [("/tf_static", "left wheel"), ("/tf_static", "right wheel")]
    robot = ("/robot_description", "robot")
    second = words_of(made.folder / "run_1.mcap")
    assert second == [*held, robot, ("/words", "two")]
    third = words_of(made.folder / "run_2.mcap")
    assert third == [*held, ("/robot_description", "new robot")]


def test_of_a_recorder_that_was_killed_all_files_are_read(
    made: PartedRecording,
) -> None:
    made.part("one")
    made.say("two")
    made.flush()
    made.kill()
    with open_recording(made.folder) as recording:
        found = [cdr_word(one.payload) for one in recording.messages()]
        codes = {problem.code for problem in recording.problems}
    assert found == ["one", "two"]
    assert codes == {"file-no-index"}


def test_a_time_without_messages_makes_no_file(made: PartedRecording) -> None:
    made.part()
    made.part()
    made.part("one")
    made.end()
    assert made.names() == ["run_0.mcap"]


@pytest.fixture
def peer() -> Iterator[FoxglovePeer]:
    peer = FoxglovePeer()
    peer.advertise("/a")
    yield peer
    peer.stop()


def test_the_button_makes_a_folder_and_takes_it_away_when_nothing_came(
    peer: FoxglovePeer, tmp_path: Path
) -> None:
    source = open_source(peer.uri)
    place = RecordingPlace(tmp_path, 1000.0)
    recorder = SourceRecorder(source, place, lambda: None, lambda why: None, 0.1)
    recorder.start()
    assert len([*tmp_path.iterdir()]) == 1
    recorder.stop()
    assert [*tmp_path.iterdir()] == []
    recorder.start()
    source.open()
    try:
        eventually(lambda: peer.subscribed() == ["/a"])
        peer.publish("/a", "words")
        eventually(lambda: recorder.status and recorder.status.messages == 1)
        recorder.stop()
    finally:
        source.close()
    (folder,) = tmp_path.iterdir()
    assert recorder.status is not None and recorder.status.name == folder.name
    assert recorder.status.size > 100
    assert words_of(folder) == [("/a", "words")]


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ({"max_bag_duration": 5.0}, "--max-bag-duration needs --record-dir DIR"),
        ({"max_bag_duration": 0.1, "record_dir": "."}, "write --max-bag-duration 5s"),
        ({"max_bag_duration": 1e6, "record_dir": "."}, "from 1s to 60min"),
    ],
)
def test_a_length_that_makes_no_sense_is_refused(
    options: dict[str, object], why: str
) -> None:
    with pytest.raises(UsageError, match=why):
        Options(source="foxglove://robot:8765", **options)  # pyright: ignore[reportArgumentType]

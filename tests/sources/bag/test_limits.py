"""What is above the limits of messages and chunks costs its topic, in every format."""

from __future__ import annotations

import json
import shutil
import sqlite3
import struct
import tracemalloc
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
from any_recording import FORMATS, Given, write_any
from mcap_pieces import chunk, mcap_file, message, string

from sambot_viz import limits
from sambot_viz.commands.topics import run
from sambot_viz.errors import SourceError
from sambot_viz.messages import MessageTypes
from sambot_viz.sources.bag import mcap, open_bag, open_recording, ros1
from sambot_viz.sources.playback import RecordingPlayback
from sambot_viz.topics.report import TopicReport
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.survey import Survey

LIMIT = 40_000


def size_of(kind: str, size: int) -> int:
    return size + 4 if kind == "bag" else size


def limit(monkeypatch: pytest.MonkeyPatch, name: str, value: int = LIMIT) -> None:
    changed = replace(getattr(limits, name), value=value)
    monkeypatch.setattr(limits, name, changed)


def reasons(path: Path) -> dict[str, str]:
    """What is said of each topic; "" for nothing."""
    with open_recording(path) as recording:
        survey = Survey(
            SourceRobot(RecordingPlayback(recording, path.name), MessageTypes())
        )
        survey.finish()
        rows = TopicReport(survey).accounts()
        found = {row.name: (row.reason, row.count) for row in rows}
    return {n: f"{c} {r.code} {r.text}" if r else f"{c}" for n, (r, c) in found.items()}


def warned(path: Path) -> list[str]:
    with open_bag(path) as bag:
        list(bag.messages())
        return [problem.message for problem in bag.problems]


@pytest.mark.parametrize("is_small", [True, False])
@pytest.mark.parametrize("kind", FORMATS)
def test_a_message_above_the_limit_costs_its_topic_alone(
    kind: str, is_small: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    limit(monkeypatch, "MESSAGE")
    if not is_small:
        monkeypatch.setattr(mcap, "SMALL", 0)
        monkeypatch.setattr(ros1, "SMALL", 0)
    below, above = string(size_of(kind, LIMIT)), string(size_of(kind, LIMIT + 1))
    given = [
        Given("/most", [below, below]),
        Given("/more", [string(40), above, string(40)]),
        Given("/small", [string(40)] * 3),
    ]
    path = write_any(tmp_path, kind, given, 10**9)
    with open_recording(path) as recording:
        came = [m.topic for m in recording.messages()]
        assert [came.count(t) for t in ("/most", "/more", "/small")] == [2, 2, 3]
        end = recording.end_ns or 0
        last = recording.last("/more", end)
        assert last is not None
        assert len(last.payload) < 100
        first = recording.next("/more", last.log_ns - 1)
        assert first is not None
        assert first.log_ns == last.log_ns
    said = f"{LIMIT + 1:,} bytes; the limit is {LIMIT:,}"
    (one,) = warned(path)
    assert said in one
    assert "/more" in one
    assert "recorder" not in one
    about = reasons(path)
    assert "left-out" not in about["/most"] + about["/small"]
    assert "2 left-out" in about["/more"]
    assert said in about["/more"]


def test_a_blob_above_the_limit_is_never_loaded(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_any(tmp_path, "db3", [Given("/tf", []), Given("/ok", [string(40)])])
    huge = limits.MESSAGE.value + 1
    with closing(sqlite3.connect(path)) as base, base:
        base.execute("insert into messages values (null, 0, 5, zeroblob(?))", (huge,))
    tracemalloc.start()
    try:
        assert run([str(path), "--format", "json"]) == 0
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 2**26
    out, err = capsys.readouterr()
    said = f"{huge:,} bytes; the limit is {limits.MESSAGE.value:,}"
    assert said in err
    rows = {row["name"]: row for row in json.loads(out)["topics"]}
    assert (rows["/tf"]["code"], rows["/tf"]["count"]) == ("left-out", 0)
    assert said in rows["/tf"]["reason"]
    assert rows["/ok"]["code"] != "left-out"


# Chunks.


@pytest.mark.parametrize("compression", ["zstd", "lz4", ""])
def test_a_chunk_above_the_limit_is_left_out_alone(
    compression: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    most = message(1, 10**9) * 300
    limit(monkeypatch, "CHUNK", len(most))
    large = most + message(2, 10**9)
    chunks = [
        chunk(large, len(large), compression),
        chunk(most, len(most), compression),
    ]
    path = mcap_file(tmp_path, chunks)
    with open_bag(path) as bag:
        assert sum(1 for _ in bag.messages()) == 300
    (one,) = warned(path)
    at = path.read_bytes().index(chunks[0])
    assert f"the chunk at byte {at:,} says that it holds {len(large):,} bytes" in one
    assert f"the limit is {len(most):,}" in one
    about = reasons(path)
    assert "left-out" in about["/b"]
    assert "left-out" not in about["/a"]


@pytest.mark.parametrize("compression", ["zstd", "lz4", ""])
@pytest.mark.parametrize("says", [100, 10**6, 2**62])
def test_a_recording_of_chunks_that_lie_says_so(
    compression: str, says: int, tmp_path: Path
) -> None:
    content = message(1, 10**9) * 100
    path = mcap_file(tmp_path, [chunk(content, says, compression)])
    found = " ".join(warned(path))
    at = path.read_bytes().index(struct.pack("<QQQI", 1, 2, says, 0)) - 9
    assert f"the chunk at byte {at:,}" in found
    assert "the recorder was stopped" not in found
    about = reasons(path)
    assert "nothing was published" not in about["/a"] + about["/b"]


def test_a_chunk_of_ros_1_above_the_limit_is_left_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = [Given("/a", [string(40)] * 200), Given("/b", [string(1000)])]
    path = write_any(tmp_path, "bag", given)
    limit(monkeypatch, "CHUNK", 100)
    found = warned(path)
    assert any(
        "the limit is 100" in one and "the chunk at byte" in one for one in found
    )
    assert "the recorder was stopped" not in " ".join(found)
    with open_bag(path) as bag:
        assert bag.problems[0].hint == "record again, with smaller messages or chunks"
    about = reasons(path)
    assert "left-out" in about["/a"]
    assert "left-out" in about["/b"]


# Channels and definitions.


@pytest.mark.parametrize("kind", FORMATS)
def test_a_channel_too_many_is_left_out_alone(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = [Given(f"/t{number}", [string(40)] * 2) for number in range(4)]
    path = write_any(tmp_path, kind, given, 10**9)
    limit(monkeypatch, "CHANNELS", 4)
    assert warned(path) == []
    assert len(reasons(path)) == 4
    limit(monkeypatch, "CHANNELS", 3)
    (one,) = warned(path)
    assert "more than 3 channels" in one
    about = reasons(path)
    (missing,) = {f"/t{number}" for number in range(4)} - set(about)
    assert missing in one
    with open_bag(path) as bag:
        assert sorted(m.topic for m in bag.messages()) == sorted([*about, *about])


@pytest.mark.parametrize("kind", FORMATS)
def test_a_definition_above_the_limit_costs_its_topic_alone(
    kind: str, tmp_path: Path
) -> None:
    most = limits.DEFINITION.value
    texts = ["string data\n".ljust(size, "#") for size in (most, most + 1)]
    given = [
        Given(f"/t{number}", [string(40)], f"a/msg/A{number}", text)
        for number, text in enumerate(texts)
    ]
    path = write_any(tmp_path, kind, given, 10**9)
    about = reasons(path)
    said = f"longer than {most:,} characters"
    assert said not in about["/t0"]
    assert said in about["/t1"]


def test_of_a_huge_definition_of_a_db3_no_more_is_read_than_shows_that_it_is(
    tmp_path: Path,
) -> None:
    text = "#" * (40 * limits.DEFINITION.value)
    given = [Given("/t", [string(40)], "a/msg/A", text)]
    path = write_any(tmp_path, "db3", given, 10**9)
    del text, given
    tracemalloc.start()
    try:
        with open_bag(path):
            _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 10 * limits.DEFINITION.value


def test_definitions_of_a_db3_that_are_too_large_together_cost_the_later_topics(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = [
        Given(f"/t{number}", [string(40)], f"a/msg/A{number}", "string data\n" * 9)
        for number in range(3)
    ]
    path = write_any(tmp_path, "db3", given, 10**9)
    texts = [channel_text(path, f"/t{number}") for number in range(3)]
    assert all(texts)
    limit(monkeypatch, "DEFINITIONS", 250)
    assert [channel_text(path, f"/t{n}") for n in range(3)] == [*texts[:2], ""]
    about = reasons(path)
    assert about["/t2"] != about["/t1"] and "a/msg/A2" in about["/t2"]


def channel_text(path: Path, topic: str) -> str | bytes:
    """The definition of the type of a topic."""
    with open_bag(path) as bag:
        (text,) = {one.channel.schema.text for one in bag.messages(topics=[topic])}
    return text


def test_a_folder_with_too_many_files_says_so_and_shows_what_it_has_opened(
    repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    square = repository / "assets" / "square.mcap"
    for name in ("a", "b", "c"):
        shutil.copy(square, tmp_path / f"{name}.mcap")
    with open_recording(tmp_path) as recording:
        assert not recording.problems
    limit(monkeypatch, "RECORDING_FILES", 2)
    with open_recording(tmp_path) as recording:
        (problem,) = recording.problems
    assert (problem.code, problem.severity) == ("folder-too-large", "warning")
    assert "more than 2 files" in problem.message
    for path in tmp_path.iterdir():
        path.rename(path.with_suffix(".txt"))
    # A file that metadata.yaml names may be one of those that are not looked at.
    names = "  relative_file_paths:\n    - d.mcap\n"
    (tmp_path / "metadata.yaml").write_text(names, "utf-8")
    with pytest.raises(SourceError, match="more than 2 files"):
        open_recording(tmp_path)

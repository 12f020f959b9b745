"""Recordings that others made are read as their list expects."""

from __future__ import annotations

import shutil
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
import yaml

from sambot_viz.errors import SourceError
from sambot_viz.sources.bag import open_bag, open_recording


@pytest.fixture(scope="module")
def real(shared: Path) -> Path:
    return shared / "data" / "bags" / "real"


def test_every_topic_has_its_type_count_and_times(real: Path) -> None:
    expected: dict[str, Any] = yaml.safe_load((real / "expected.yaml").read_text())
    for name, want in expected["files"].items():
        with open_bag(real / name) as bag:
            while not bag.is_complete:
                bag.index_more()
            assert bag.problems == (), name
            assert bag.topics.keys() == want["topics"].keys()
            counts = Counter(message.topic for message in bag.messages())
            assert counts.total() == want["messages"]
            for topic_name, topic in want["topics"].items():
                found = bag.topics[topic_name]
                assert (found.count, counts[topic_name]) == (topic["messages"],) * 2
                plain = found.schema.name.replace("/msg/", "/")
                assert plain == topic["type"].replace("/msg/", "/")
                assert found.message_encoding == topic["encoding"]
                assert found.schema.encoding == (topic["definition"] or "")
                first, last = bag.next(topic_name, -1), bag.last(topic_name, 2**64)
                assert (first and first.log_ns) == topic.get("first")
                assert (last and last.log_ns) == topic.get("last")


def test_a_folder_whose_metadata_has_a_folder_before_the_name(real: Path) -> None:
    with open_recording(real / "rosbag2_test") as recording:
        assert recording.problems == ()
        assert [path.name for path in recording.paths] == ["rosbag2_test_0.db3"]


def test_nothing_is_written_beside_a_database(shared: Path, tmp_path: Path) -> None:
    for source in ("real/rosbag2_test", "made/killed_db3", "made/square_jazzy"):
        folder = tmp_path / source
        shutil.copytree(shared / "data" / "bags" / source, folder)
        before = {path.name: path.read_bytes() for path in folder.iterdir()}
        with open_recording(folder) as recording:
            assert sum(1 for _ in recording.messages()) >= 500
            assert {p.name: p.read_bytes() for p in folder.iterdir()} == before
        assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_the_copy_of_a_database_is_removed(
    shared: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with open_recording(shared / "data" / "bags" / "made" / "killed_db3") as recording:
        assert len(list(tmp_path.iterdir())) == 1
        assert recording.last("/tf", 2**62) is not None
    assert list(tmp_path.iterdir()) == []


def test_another_database_is_no_recording(tmp_path: Path) -> None:
    import sqlite3

    path = tmp_path / "other.db3"
    connection = sqlite3.connect(path)
    connection.execute("create table people(name text)")
    connection.commit()
    connection.close()
    with pytest.raises(SourceError, match="not one of rosbag2"):
        open_bag(path)


def test_a_database_may_have_rows_of_any_kind(tmp_path: Path) -> None:
    import sqlite3

    path = tmp_path / "odd.db3"
    connection = sqlite3.connect(path)
    connection.executescript(
        "create table topics(id integer primary key, name, type, serialization_format);"
        "create table messages(id integer primary key, topic_id, timestamp, data);"
        "insert into topics values(1, '/a', 't', 'cdr'), (2, 5, x'ff', null);"
        "insert into messages values(1, 1, 10, x'00'), (2, 1, 'noon', x'01'),"
        "(3, 7, 11, x'02'), (4, 1, -5, x'03'), (5, 1, 12, 'text'), (6, 1, 13, x'04');"
    )
    connection.close()
    with open_bag(path) as bag:
        assert list(bag.topics) == ["/a"]
        assert [bytes(m.payload) for m in bag.messages()] == [b"\x00", b"\x04"]


@pytest.mark.parametrize(
    "name", ["square_fastwrite.mcap", "square_jazzy/square_jazzy_0.db3"]
)
def test_a_file_compressed_as_a_whole_is_read_from_a_copy(
    name: str, shared: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import zstandard

    copies = tmp_path / "copies"
    copies.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(copies))
    data = (shared / "data" / "bags" / "made" / name).read_bytes()
    path = tmp_path / f"{Path(name).name}.zstd"
    path.write_bytes(zstandard.ZstdCompressor().compress(data))
    with open_recording(tmp_path) as recording:
        assert sum(1 for _ in recording.messages()) == 1703
        assert recording.problems == ()
        assert list(recording.paths) == [path]
    assert list(copies.iterdir()) == []
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) * 3 // 4])
    with open_bag(path) as bag:
        assert 0 < sum(1 for _ in bag.messages()) < 1703
        assert bag.problems
    path.write_bytes(zstandard.ZstdCompressor().compress(b"no recording"))
    with pytest.raises(SourceError, match="it is a text file"):
        open_bag(path)
    path.write_bytes(b"\x28\xb5\x2f\xfd noise")
    with pytest.raises(SourceError, match="cannot be decompressed"):
        open_bag(path)
    assert list(copies.iterdir()) == []

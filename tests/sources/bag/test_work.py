"""Opening and jumping read little of a large file, counted in bytes."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from mcap.writer import CompressionType, Writer

from sambot_viz.sources.bag import mcap, open_bag, open_recording
from sambot_viz.sources.bag.file_bytes import FileBytes

CHUNK = 256 * 1024
MESSAGES = 3000


class Meter:
    """Counts what is read of files."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.bytes = self.reads = self.largest = 0
        read_at = FileBytes.read_at

        def counted(file: FileBytes, at: int, count: int) -> bytes:
            data = read_at(file, at, count)
            self.bytes += len(data)
            self.reads += 1
            self.largest = max(self.largest, len(data))
            return data

        monkeypatch.setattr(FileBytes, "read_at", counted)

    def clear(self) -> None:
        self.bytes = self.reads = self.largest = 0


@pytest.fixture
def meter(monkeypatch: pytest.MonkeyPatch) -> Meter:
    return Meter(monkeypatch)


@pytest.fixture
def write(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Write a bag of 3,000 messages that counts as a large one."""
    monkeypatch.setattr(mcap, "SMALL", 0)

    def make(*, chunks: bool = True, is_killed: bool = False) -> Path:
        path, rng = tmp_path / "large.mcap", random.Random(3)
        with path.open("wb") as stream:
            writer = Writer(
                stream,
                CHUNK,
                CompressionType.NONE,
                use_chunking=chunks,
            )
            writer.start("ros2", "test")
            schema = writer.register_schema("a/msg/A", "ros2msg", b"uint8[] a")
            channels = {
                topic: writer.register_channel(topic, "cdr", schema)
                for topic in ("/tf_static", "/tf", "/scan")
            }
            for number in range(MESSAGES):
                topic = ("/tf_static", "/tf", "/scan")[number % 2 + (number > 0)]
                data = rng.randbytes(10_000 if topic == "/scan" else 200)
                writer.add_message(
                    channels[topic], number * 10**7, data, number * 10**7
                )
            writer.finish()
        if is_killed:
            data = path.read_bytes()
            path.write_bytes(data[: len(data) * 9 // 10])
        return path

    return make


def test_an_indexed_file_is_opened_by_its_end(write, meter: Meter) -> None:
    path = write()
    with open_bag(path) as bag:
        assert bag.is_complete
        # The chunk with /tf_static, and the index.
        assert meter.bytes < 1.2 * CHUNK + 40_000
        assert bag.topics["/scan"].count == sum(1 for n in range(1, 3000) if n % 2)
        meter.clear()
        at = 20 * 10**9
        assert bag.last("/tf", at) is not None
        assert bag.last("/scan", at) is not None
        assert meter.bytes < 2.2 * CHUNK
        meter.clear()
        window = list(bag.messages(at, at + 10**8))
        assert len(window) == 11
        assert meter.bytes < 2.2 * CHUNK


def test_a_file_without_its_end_is_opened_by_its_headers(
    write,
    meter: Meter,
) -> None:
    path = write(is_killed=True)
    with open_bag(path) as bag:
        assert bag.is_complete
        assert meter.bytes < 4 * CHUNK < path.stat().st_size / 8
        meter.clear()
        assert bag.last("/scan", 15 * 10**9) is not None
        assert meter.bytes < 2.2 * CHUNK


def test_messages_outside_of_chunks_are_stepped_over(write, meter: Meter) -> None:
    path = write(chunks=False)
    with open_bag(path) as bag:
        assert meter.bytes < path.stat().st_size * 0.75
        meter.clear()
        assert bag.last("/scan", 15 * 10**9) is not None
        assert bag.last("/tf", 15 * 10**9) is not None
        assert meter.bytes < 40_000


def test_a_pass_holds_one_chunk_at_a_time(write, meter: Meter) -> None:
    path = write()
    with open_bag(path) as bag:
        meter.clear()
        assert sum(1 for _ in bag.messages()) == MESSAGES
        assert meter.bytes < path.stat().st_size * 1.05
        assert meter.largest < 1.2 * CHUNK


@pytest.mark.parametrize("chunks", [True, False])
def test_a_huge_file_grows_while_what_is_found_can_be_read(
    chunks: bool,
    write,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    path = write(chunks=chunks, is_killed=True)
    whole = open_bag(path)
    monkeypatch.setattr("sambot_viz.sources.bag.mcap._LOOSE", 256)
    monkeypatch.setattr("sambot_viz.sources.bag.opening.OPENING", 300)
    monkeypatch.setattr("sambot_viz.sources.bag.block_bag.STEP", 100)
    with whole, open_recording(path) as recording:
        assert not recording.is_complete
        assert recording.topics["/scan"].count is None
        ends = [recording.end_ns or 0]
        while not recording.index_more():
            ends.append(recording.end_ns or 0)
            assert recording.last("/scan", 10**8) is not None
        assert ends == sorted(ends)
        assert len(set(ends)) > 1
        assert recording.topics["/scan"].count == whole.topics["/scan"].count
        found = [(m.topic, m.log_ns, m.payload) for m in recording.messages()]
        assert found == [(m.topic, m.log_ns, m.payload) for m in whole.messages()]
        assert [m.topic for m in recording.latched()] == ["/tf_static"]

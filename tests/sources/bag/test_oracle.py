"""Files that the `mcap` package writes are read as that package reads them."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from mcap.reader import NonSeekingReader
from mcap.writer import CompressionType, IndexType, Writer

from sambot_viz.sources.bag import mcap, open_bag

NO_INDEX = IndexType.NONE
Sample = tuple[str, int, int, bytes]


def write(path: Path, rng: random.Random, index: IndexType) -> None:
    """Write some hundred messages in an order that is not that of their times."""
    with path.open("wb") as stream:
        writer = Writer(
            stream,
            chunk_size=rng.choice([200, 3000, 10**6]),
            compression=rng.choice(list(CompressionType)),
            index_types=index,
            use_chunking=rng.random() < 0.8,
            use_statistics=rng.random() < 0.8,
            repeat_channels=rng.random() < 0.8,
            repeat_schemas=rng.random() < 0.8,
            enable_crcs=rng.random() < 0.5,
        )
        writer.start(profile=rng.choice(["", "ros2"]), library="test")
        channels: list[int] = []
        spread = rng.choice([1, 50, 10**10])
        for number in range(rng.randrange(1, 400)):
            if not channels or rng.random() < 0.03:
                schema = writer.register_schema(f"T{number}", "ros2msg", b"int32 a")
                topic = f"/topic_{rng.randrange(5)}"
                channel = writer.register_channel(topic, "cdr", schema)
                channels.append(channel)
            if rng.random() < 0.01:
                writer.add_metadata("about", {"a": "b"})
            if rng.random() < 0.01:
                writer.add_attachment(1, 1, "name", "text/plain", b"x" * 300)
            time = max(0, number * 10 + rng.randrange(-spread, spread + 1))
            data = rng.randbytes(rng.choice([0, 4, 40, 2000]))
            writer.add_message(rng.choice(channels), time, data, time + 5)
        writer.finish()


def by_oracle(path: Path) -> list[Sample]:
    with path.open("rb") as stream:
        found = [
            (channel.topic, message.log_time, message.publish_time, message.data)
            for _, channel, message in NonSeekingReader(stream).iter_messages(
                log_time_order=False
            )
        ]
    return sorted(found, key=lambda sample: sample[1])


@pytest.mark.parametrize("small", [mcap.SMALL, 0])
@pytest.mark.parametrize("seed", range(24))
def test_what_is_written_is_read(
    seed: int, small: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mcap, "SMALL", small)
    rng = random.Random(seed)
    path = tmp_path / "bag.mcap"
    write(path, rng, rng.choice([IndexType.ALL, IndexType.CHUNK, NO_INDEX]))
    expected = by_oracle(path)
    with open_bag(path) as bag:
        while not bag.is_complete:
            bag.index_more()
        found = [
            (m.topic, m.log_ns, m.publish_ns, bytes(m.payload)) for m in bag.messages()
        ]
        assert found == expected
        for name, topic in bag.topics.items():
            times = [time for each, time, *_ in expected if each == name]
            assert topic.count == len(times)
            for _ in range(20):
                at = rng.choice(expected)[1] + rng.randrange(-1, 2)
                last, following = bag.last(name, at), bag.next(name, at)
                before = [sample for sample in expected if sample[0] == name]
                not_after = [sample for sample in before if sample[1] <= at]
                later = [sample for sample in before if sample[1] > at]
                assert (last and bytes(last.payload)) == (
                    not_after[-1][3] if not_after else None
                )
                assert (following and bytes(following.payload)) == (
                    later[0][3] if later else None
                )
        low, high = sorted(rng.choice(expected)[1] for _ in range(2))
        some = [(m.log_ns, m.topic) for m in bag.messages(low, high, ["/topic_1"])]
        assert some == [
            (time, topic)
            for topic, time, *_ in expected
            if topic == "/topic_1" and low <= time <= high
        ]
        assert {p.code for p in bag.problems} <= {"log-back"}


@pytest.mark.parametrize("seed", range(12))
def test_what_was_written_before_a_cut_is_read(seed: int, tmp_path: Path) -> None:
    rng = random.Random(1000 + seed)
    path = tmp_path / "bag.mcap"
    write(path, rng, IndexType.ALL)
    expected = by_oracle(path)
    data = path.read_bytes()
    path.write_bytes(data[: rng.randrange(8, len(data))])
    with open_bag(path) as bag:
        found = [
            (m.topic, m.log_ns, m.publish_ns, bytes(m.payload)) for m in bag.messages()
        ]
        assert set(found) <= set(expected)
        assert bag.problems

"""rosbags and the mcap package read what is written here, byte by byte."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from mcap.exceptions import McapError
from mcap.reader import make_reader
from rosbags.interfaces import Qos as RosbagsQos
from rosbags.rosbag2 import Reader

from sambot_viz.messages import Schema
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.cut_recording import finish_cut
from sambot_viz.sources.mcap_file import McapFile
from sambot_viz.sources.message import Recorded, TopicChannel
from sambot_viz.sources.qos import Qos, parse_qos, profile_text

QOS = [
    Qos(reliability, durability, history, depth, durability == "transient_local")
    for reliability in ("reliable", "best_effort")
    for durability in ("transient_local", "volatile")
    for history, depth in (("keep_last", 7), ("keep_all", 0))
]
NUMBERS = {
    **{"keep_last": "1", "keep_all": "2", "reliable": "1", "best_effort": "2"},
    **{"transient_local": "1", "volatile": "2"},
}
Sample = tuple[str, str, int, bytes]


def some_messages(seed: int, count: int = 200) -> list[Recorded]:
    """Messages of channels with all QoS, whose times go up."""
    rng = random.Random(seed)
    channels = [
        TopicChannel(
            f"/topic{number}",
            Schema(f"lab/msg/T{number % 3}", "ros2msg", "uint8[] a\n"),
            "cdr",
            qos,
        )
        for number, qos in enumerate([*QOS, None])
    ]
    return [
        Recorded(
            channel.topic,
            channel,
            number * 1000 + rng.randrange(1000),
            rng.choice([None, number]),
            rng.randbytes(rng.choice([0, 4, 300, 5000])),
        )
        for number in range(count)
        for channel in [rng.choice(channels)]
    ]


def written(path: Path, messages: list[Recorded], flush_every: int) -> McapFile:
    with path.open("xb") as stream:
        file = McapFile(stream)
        for number, message in enumerate(messages):
            assert file.write(message, message.log_ns)
            if number % flush_every == 0:
                file.flush()
        file.finish()
    return file


def samples(messages: list[Recorded]) -> list[Sample]:
    return [
        (one.topic, one.channel.schema.name, one.log_ns, bytes(one.payload))
        for one in messages
    ]


@pytest.mark.parametrize("seed", range(5))
def test_other_readers_find_the_same_bytes_times_types_and_qos(
    tmp_path: Path, seed: int
) -> None:
    path, messages = tmp_path / "a.mcap", some_messages(seed)
    written(path, messages, flush_every=random.Random(seed).choice([1, 7, 1000]))
    with Reader(path) as reader:
        assert samples(messages) == [
            (connection.topic, connection.msgtype, time, bytes(payload))
            for connection, time, payload in reader.messages()
        ]
        for connection in reader.connections:
            assert connection.msgdef.data == "uint8[] a\n"
            offered = (
                QOS[int(connection.topic[6:])] if _has_qos(connection.topic) else None
            )
            found = connection.ext.offered_qos_profiles
            assert [_words(one) for one in found] == (
                [] if offered is None else [offered]
            )
    with path.open("rb") as stream:
        theirs = [
            (channel.topic, schema.name if schema else "", one.log_time, one.data)
            for schema, channel, one in make_reader(
                stream, validate_crcs=True
            ).iter_messages()
        ]
    assert theirs == samples(messages)


def _has_qos(topic: str) -> bool:
    return int(topic[6:]) < len(QOS)


def _words(found: RosbagsQos) -> Qos:
    durability = found.durability.name.lower()
    return Qos(
        found.reliability.name.lower(),
        durability,
        found.history.name.lower(),
        found.depth,
        durability == "transient_local",
    )


@pytest.mark.parametrize("qos", QOS)
def test_qos_is_read_as_humble_writes_it_and_as_later_distributions_do(
    qos: Qos,
) -> None:
    text = profile_text(qos)
    assert parse_qos(text) == qos
    for word, number in NUMBERS.items():
        text = text.replace(f": {word}\n", f": {number}\n")
    assert "reliab" in text and qos.reliability not in text
    assert parse_qos(text) == qos


def test_a_file_that_is_cut_anywhere_gets_its_whole_chunks_and_an_index(
    tmp_path: Path,
) -> None:
    path, cut = tmp_path / "a.mcap", tmp_path / "cut.mcap"
    messages = some_messages(1, 40)
    definitions = written(path, messages, flush_every=4).definitions
    data, rng, counts = path.read_bytes(), random.Random(3), set[int]()
    for _ in range(150):
        cut.write_bytes(data[: rng.randrange(len(data))])
        count = finish_cut(cut, 0, definitions)
        counts.add(count)
        if not count:
            continue
        with open_recording(cut) as recording:
            assert samples(list(recording.messages())) == samples(messages[:count])
            assert not recording.problems
        with cut.open("rb") as stream:
            found = list(make_reader(stream, validate_crcs=True).iter_messages())
        assert len(found) == count
        with Reader(cut) as reader:
            assert reader.message_count == count
    assert len(counts) > 8


def test_a_file_that_ends_with_a_whole_chunk_keeps_it(tmp_path: Path) -> None:
    path, messages = tmp_path / "a.mcap", some_messages(2, 9)
    with path.open("xb") as stream:
        file = McapFile(stream)
        for message in messages:
            file.write(message, message.log_ns)
        file.flush()
    with path.open("rb") as stream, pytest.raises(McapError):
        list(make_reader(stream).iter_messages())
    assert finish_cut(path, file.flushed, file.definitions) == 9
    with path.open("rb") as stream:
        assert len(list(make_reader(stream).iter_messages())) == 9

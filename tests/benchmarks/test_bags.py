"""A recording of 1.1 GB is opened and jumped in without being read.

    python -m pytest tests/benchmarks/test_bags.py -s

The same is done with the `mcap` package in the same run, and with rosbags for a db3 of
that size; the file is in the cache of the system for both.
"""

from __future__ import annotations

import random
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from large_recording import TOPICS, messages, write
from mcap.reader import make_reader
from rosbags.rosbag2 import Reader

from sambot_viz.sources.bag import Bag, open_bag

SIZE = 1_100_000_000
OPENING = 1.0
JUMP = 0.05
MEMORY = 100.0
TABLES = """
create table schema(schema_version integer primary key, ros_distro text not null);
create table metadata(id integer primary key, metadata_version integer not null,
    metadata text not null);
create table topics(id integer primary key, name text not null, type text not null,
    serialization_format text not null, offered_qos_profiles text not null);
create table messages(id integer primary key, topic_id integer not null,
    timestamp integer not null, data blob not null);
create index timestamp_idx on messages (timestamp asc);
insert into schema values (3, 'humble');
"""
"""Those of Humble, the last one that records db3 by default."""


def write_db3(path: Path) -> None:
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("pragma synchronous = off")
        connection.executescript(TABLES)
        connection.executemany(
            "insert into topics values (?, ?, 'std_msgs/msg/String', 'cdr', '')",
            [(number + 1, name) for number, name in enumerate(TOPICS)],
        )
        connection.executemany(
            "insert into messages(topic_id, timestamp, data) values (?, ?, ?)",
            ((kind + 1, at, data) for kind, at, data in messages(SIZE)),
        )
        connection.commit()


@pytest.fixture(scope="module", params=[True, False], ids=["chunks", "fastwrite"])
def large(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Path]:
    path = tmp_path_factory.mktemp("bags") / "large.mcap"
    write(path, SIZE, chunks=request.param)
    yield path
    path.unlink()


@pytest.fixture(scope="module")
def large_db3(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    path = tmp_path_factory.mktemp("bags") / "large.db3"
    write_db3(path)
    yield path
    path.unlink()


def jump(bag: Bag, at: int) -> None:
    """Get what the displays of six topics show."""
    for topic in TOPICS:
        assert bag.last(topic, at) is not None


def test_it_opens_and_jumps_faster_than_the_package(
    large: Path, compare: Callable[..., Any]
) -> None:
    def ours() -> None:
        open_bag(large).close()

    def theirs() -> None:
        with large.open("rb") as stream:
            make_reader(stream).get_summary()

    opening = compare("opening", ours, theirs, rounds=5)
    assert min(opening.ours) < OPENING
    rng = random.Random(2)
    with open_bag(large) as bag, large.open("rb") as stream:
        reader = make_reader(stream)
        first, last = bag.start_ns or 0, bag.end_ns or 0
        times: list[float] = []
        for _ in range(100):
            at = rng.randrange(first + 10**9, last)
            begin = time.perf_counter()
            jump(bag, at)
            times.append(time.perf_counter() - begin)
        times.sort()
        print(f"\njump p50 {times[50] * 1e3:.1f} ms, worst {times[-1] * 1e3:.1f} ms")
        assert times[50] < JUMP

        def our_step() -> None:
            at = rng.randrange(first + 10**9, last)
            next(bag.messages(at, at + 10**9))

        def their_step() -> None:
            at = rng.randrange(first + 10**9, last)
            next(iter(reader.iter_messages(starting_at=at, ending_before=at + 10**9)))

        rounds = 5 if times[50] else 0
        result = compare(
            f"message at a time, {large.name}", our_step, their_step, rounds
        )
        assert result.ratio < 1


def test_a_db3_opens_within_a_second_and_jumps_at_once(
    large_db3: Path, compare: Callable[..., Any]
) -> None:
    def ours() -> None:
        with open_bag(large_db3) as bag:
            # All rows are found, as before a page is shown.
            while not bag.index_more():
                pass

    def theirs() -> None:
        with Reader(large_db3) as reader:
            assert reader.message_count

    opening = compare("opening a db3", ours, theirs, rounds=5)
    assert min(opening.ours) < OPENING
    rng = random.Random(2)
    with open_bag(large_db3) as bag, Reader(large_db3) as reader:
        while not bag.index_more():
            pass
        first, last = bag.start_ns or 0, bag.end_ns or 0

        def our_jump() -> None:
            jump(bag, rng.randrange(first + 10**9, last))

        def their_jump() -> None:
            # The first message of each topic from there on: it has no way back.
            at = rng.randrange(first + 10**9, last - 10**9)
            for one in reader.connections:
                if one.topic != "/tf_static":
                    next(reader.messages([one], start=at))

        result = compare("jump in a db3", our_jump, their_jump, rounds=20)
        assert min(result.ours) < JUMP


def test_a_db3_takes_little_memory(large_db3: Path) -> None:
    assert own_memory(large_db3) < MEMORY


def test_it_takes_little_memory(large: Path) -> None:
    assert own_memory(large) < MEMORY


def own_memory(path: Path) -> float:
    """Return what opening a bag, reading on and jumping take at most [MB]."""
    script = (
        "import sys, numpy, zstandard, lz4.frame\n"
        "from sambot_viz.sources.bag import open_bag\n"
        "def peak():\n"
        "    lines = open('/proc/self/status').read().splitlines()\n"
        "    (line,) = [line for line in lines if line.startswith('VmHWM')]\n"
        "    return int(line.split()[1]) / 1024\n"
        "before = peak()\n"
        "with open_bag(sys.argv[1]) as bag:\n"
        "    for n, m in enumerate(bag.messages()):\n"
        "        if n > 20000: break\n"
        "    for at in range(bag.start_ns, bag.end_ns, 10**10):\n"
        "        [bag.last(topic, at) for topic in bag.topics]\n"
        "print(peak() - before)\n"
    )
    command = [sys.executable, "-c", script, str(path)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    print(f"\nown memory {float(done.stdout):.0f} MB")
    return float(done.stdout)

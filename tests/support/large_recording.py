"""A large recording: what a robot with a lidar records, as long as is asked for."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

from mcap.writer import CompressionType, Writer

MOVING = ("/tf", "/joint_states", "/odom", "/scan", "/points")
"""Topics that have messages from the beginning to the end."""
TOPICS = (*MOVING, "/tf_static")
START = 1_700_000_000 * 10**9
STEP = 4_000_000
"""Between two messages [ns]."""


def messages(size: int) -> Iterator[tuple[int, int, bytes]]:
    """Yield the number of the topic, the time [ns] and the bytes of each message.

    Args:
        size: of all of them [bytes].
    """
    rng = random.Random(1)
    small = [rng.randbytes(length) for length in (120, 300, 1500, 3000)]
    cloud = rng.randbytes(400_000)
    yield 5, START, small[1]
    number = total = 0
    while total < size:
        number += 1
        kind = 4 if number % 27 == 0 else number % 4
        data = cloud if kind == 4 else small[kind]
        yield kind, START + number * STEP, data
        total += len(data)


def write(path: Path, size: int, *, chunks: bool = True) -> None:
    """Write an MCAP file by rosbag2's default in chunks, or as `fastwrite` does."""
    with path.open("wb") as stream:
        writer = Writer(
            stream,
            768 * 1024,
            CompressionType.NONE,
            use_chunking=chunks,
            enable_crcs=False,
        )
        writer.start("ros2", "benchmark")
        schema = writer.register_schema("a/msg/A", "ros2msg", b"uint8[] a")
        channels = [writer.register_channel(name, "cdr", schema) for name in TOPICS]
        for kind, at, data in messages(size):
            writer.add_message(channels[kind], at, data, at)
        writer.finish()

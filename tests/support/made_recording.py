"""Recordings of robots that tests make: descriptions, frames, and empty topics."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

START = 1_750_000_000
"""The time of the first message [s]."""
Told = Sequence[tuple[str, float, Mapping[str, str]]]
"""Topic, stamp and log time [s from the start], and the parent of each child."""


def described(*links: str, radius: float = 0.2) -> str:
    """Return the URDF of a chain of links, each a ball 1 m above the one before."""
    shape = f'<visual><geometry><sphere radius="{radius}"/></geometry></visual>'
    parts = [f'<link name="{link}">{shape}</link>' for link in links]
    parts += [
        f'<joint name="{parent}_{child}" type="continuous"><parent link="{parent}"/>'
        f'<child link="{child}"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/></joint>'
        for parent, child in itertools.pairwise(links)
    ]
    return f'<robot name="{links[0]}">{"".join(parts)}</robot>'


OF_NAV2 = {
    "nav2_msgs/msg/Particle": "geometry_msgs/Pose pose\nfloat64 weight\n",
    "nav2_msgs/msg/ParticleCloud": "std_msgs/Header header\n"
    "nav2_msgs/Particle[] particles\n",
}
"""Definitions of types that are not ROS's own, by their names."""
Message = tuple[str, str, int, object]
"""Topic, type, log time [ns], and what rosbags writes of it, or its bytes."""


def store_of_all() -> Any:
    """Return rosbags' types of ROS 2, with those of others that displays draw."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    for name, text in OF_NAV2.items():
        store.register(get_types_from_msg(text, name))
    return store


def write_messages(
    path: Path, messages: Iterable[Message], empty: Mapping[str, str] | None = None
) -> Path:
    """Write an mcap file of messages of ROS 2.

    Args:
        path: of the file.
        messages: in the order of their times.
        empty: topic without a message → its type.

    Returns:
        The path.
    """
    from mcap.writer import Writer

    store = store_of_all()
    channels: dict[str, int] = {}
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()

        def channel(topic: str, name: str) -> int:
            if topic not in channels:
                text = store.generate_msgdef(name)[0].encode()
                schema = writer.register_schema(name, "ros2msg", text)
                channels[topic] = writer.register_channel(topic, "cdr", schema)
            return channels[topic]

        for topic, name, time, message in messages:
            is_data = isinstance(message, bytes)
            data = message if is_data else bytes(store.serialize_cdr(message, name))
            writer.add_message(channel(topic, name), time, data, time)
        for topic, name in (empty or {}).items():
            channel(topic, name)
        writer.finish()
    return path


def write_recording(
    path: Path,
    texts: Mapping[str, str],
    told: Told = (),
    empty: Mapping[str, str] | None = None,
    scans: Sequence[tuple[float, float]] = (),
) -> Path:
    """Write an mcap file.

    Args:
        path: of the file.
        texts: topic → a text that it sends at the start.
        told: transforms; each is as many metres along x as its stamp says.
        empty: topic without a message → its type.
        scans: stamp and log time of messages of /scan in the frame base [s from the
            start].

    Returns:
        The path.
    """
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)

    def at(topic: str, name: str, seconds: float, message: object) -> Message:
        return topic, name, START * 1_000_000_000 + round(seconds * 1e9), message

    text, moved = "std_msgs/msg/String", "tf2_msgs/msg/TFMessage"
    said = store.types[text]
    messages = [at(topic, text, 0.0, said(one)) for topic, one in texts.items()]
    for topic, seconds, frames in told:
        sent = transforms_message(store, seconds, frames)
        messages.append(at(topic, moved, seconds, sent))
    for stamp, seconds in scans:
        sent = scan_message(store, stamp)
        messages.append(at("/scan", "sensor_msgs/msg/LaserScan", seconds, sent))
    return write_messages(path, messages, empty)


def transforms_message(store: Any, seconds: float, frames: Mapping[str, str]) -> object:
    """Return a TFMessage with the transforms of some frames, child → parent."""
    types = store.types
    return types["tf2_msgs/msg/TFMessage"](
        [
            types["geometry_msgs/msg/TransformStamped"](
                header(store, seconds, parent),
                child,
                types["geometry_msgs/msg/Transform"](
                    types["geometry_msgs/msg/Vector3"](seconds, 0.0, 0.0),
                    types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
                ),
            )
            for child, parent in frames.items()
        ]
    )


def scan_message(store: Any, seconds: float) -> object:
    """Return a LaserScan of one ray."""
    types = store.types
    base = header(store, seconds, "base")
    ranges = np.array([1.0], dtype=np.float32)
    numbers = (0.0, 0.0, 0.1, 0.0, 0.0, 0.1, 10.0)
    return types["sensor_msgs/msg/LaserScan"](base, *numbers, ranges, ranges)


def header(store: Any, seconds: float, frame: str) -> Any:
    """Return the header of a message in a frame, with its stamp [s from the start]."""
    whole = int(seconds // 1)
    nanoseconds = round((seconds - whole) * 1e9)
    stamp = store.types["builtin_interfaces/msg/Time"](START + whole, nanoseconds)
    return store.types["std_msgs/msg/Header"](stamp, frame)

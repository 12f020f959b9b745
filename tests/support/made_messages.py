"""Recordings of messages that tests make from the types of ROS 2."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

START = 1_700_000_000
"""The time of the first message [s]; each other one is a tenth of a second later."""
Make = Callable[[Any], tuple[str, str, object]]
"""Returns topic, type and message, made of the types by their names."""


def write_messages(
    path: Path, *made: Make, definitions: Mapping[str, str] | None = None
) -> Path:
    """Write an mcap file.

    Args:
        path: of the file.
        made: return the messages.
        definitions: of types that ROS itself does not have, by their names.

    Returns:
        The path.
    """
    from mcap.writer import Writer
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    for name, text in (definitions or {}).items():
        store.register(get_types_from_msg(text, name))
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        channels: dict[str, int] = {}
        for number, make in enumerate(made):
            topic, name, message = make(store.types)
            if topic not in channels:
                text = store.generate_msgdef(name)[0].encode()
                schema = writer.register_schema(name, "ros2msg", text)
                channels[topic] = writer.register_channel(topic, "cdr", schema)
            data = bytes(store.serialize_cdr(message, name))
            time = START * 10**9 + number * 10**8
            writer.add_message(channels[topic], time, data, time)
        writer.finish()
    return path

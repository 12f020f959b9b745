"""Recordings that tests write."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pytest

Told = Sequence[tuple[float, Mapping[str, str]]]
"""Log time [s], and the child of each parent."""


@pytest.fixture
def write_recording(tmp_path: Path) -> Callable[..., Path]:
    """Write an mcap file of /tf, and of /robot_description: its path."""

    def write(told: Told, description: str | None = None) -> Path:
        from mcap.writer import Writer
        from rosbags.typesys import Stores, get_typestore

        store = get_typestore(Stores.ROS2_JAZZY)
        types = store.types
        path = tmp_path / "written.mcap"
        with path.open("wb") as stream:
            writer = Writer(stream)
            writer.start()
            channels: dict[str, int] = {}
            for topic, name in (
                ("/tf", "tf2_msgs/msg/TFMessage"),
                ("/robot_description", "std_msgs/msg/String"),
            ):
                text = store.generate_msgdef(name)[0].encode()
                schema = writer.register_schema(name, "ros2msg", text)
                channels[topic] = writer.register_channel(topic, "cdr", schema)

            def add(topic: str, name: str, seconds: float, message: object) -> None:
                data = bytes(store.serialize_cdr(message, name))
                time = round(seconds * 1e9) + 1_750_000_000_000_000_000
                writer.add_message(channels[topic], time, data, time)

            if description is not None:
                text_message = types["std_msgs/msg/String"](description)
                add("/robot_description", "std_msgs/msg/String", 0.0, text_message)
            for seconds, frames in told:
                time = types["builtin_interfaces/msg/Time"](
                    1_750_000_000 + int(seconds), round(seconds % 1 * 1e9)
                )
                transforms = [
                    types["geometry_msgs/msg/TransformStamped"](
                        types["std_msgs/msg/Header"](time, parent),
                        child,
                        types["geometry_msgs/msg/Transform"](
                            types["geometry_msgs/msg/Vector3"](seconds, 0.0, 0.0),
                            types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
                        ),
                    )
                    for parent, child in frames.items()
                ]
                add(
                    "/tf",
                    "tf2_msgs/msg/TFMessage",
                    seconds,
                    types["tf2_msgs/msg/TFMessage"](transforms),
                )
            writer.finish()
        return path

    return write

"""The definition of a message, as a file or a peer gives it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Schema:
    """The definition of the messages of a channel.

    Attributes:
        name: name of the type, as given: "sensor_msgs/msg/LaserScan", or without
            "/msg/", or of another system.
        encoding: format of the text: "ros2msg", "ros2idl", "ros1msg", "jsonschema",
            "protobuf", …; "" without a text.
        text: the definition; bytes for binary formats.
    """

    name: str
    encoding: str = ""
    text: str | bytes = ""

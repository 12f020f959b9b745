"""The definition of a message, as a file or a peer gives it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Schema:
    """The definition of the messages of a channel.

    Attributes:
        name: of the type, as it was given: "sensor_msgs/msg/LaserScan", or without
            "/msg/", or of another system.
        encoding: how the text is written: "ros2msg", "ros2idl", "ros1msg",
            "jsonschema", "protobuf", …; "" when there is no text.
        text: the definition itself; bytes where it is not text.
    """

    name: str
    encoding: str = ""
    text: str | bytes = ""

"""A row of a table of schemas."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from sambot_viz.meanings.meaning import Meaning

Fields = Mapping[str, Any]
"""The fields of a message in any encoding: numbers, texts, bytes, arrays of numbers,
lists, and nested fields. A missing field has its zero."""

SENSOR_POSE = "sensor_pose"
"""A field that looks may have beside ROS's: where the sensor is in the message's frame,
as the fields of a geometry_msgs/Pose."""


@dataclass(frozen=True, slots=True)
class SchemaRow:
    """What the messages of one schema mean.

    Attributes:
        meaning: of each of them.
        look: makes of its fields those of the meaning's look, which are then checked;
            None where they have these names already.
    """

    meaning: Meaning
    look: Callable[[Fields], Fields] | None = None

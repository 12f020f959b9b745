"""The meaning of a schema, by its name: the tables of all families of schemas."""

from __future__ import annotations

import re
from functools import cache

from sambot_viz.meanings.meaning import Meaning
from sambot_viz.meanings.schema_row import SchemaRow
from sambot_viz.messages.definition_text import canonical_name

_FOXGLOVE_IN_ROS = re.compile(r"foxglove_msgs/(?:msg/)?(\w+)", re.ASCII)

_ROS = {
    **{one.value: SchemaRow(one) for one in Meaning},
    "tf/msg/tfMessage": SchemaRow(Meaning.TRANSFORMS),
    "rosgraph_msgs/msg/Log": SchemaRow(Meaning.LOG),
}
"""ROS's own types have the look already."""


@cache
def row_of(type_name: str) -> SchemaRow | None:
    """Return the row of a schema; None for one without a meaning here.

    Args:
        type_name: as a decoder has it, such as "sensor_msgs/msg/LaserScan" or
            "foxglove.LaserScan".
    """
    if match := _FOXGLOVE_IN_ROS.fullmatch(type_name):
        type_name = f"foxglove.{match[1]}"
    if type_name.startswith("foxglove."):
        from sambot_viz.meanings.foxglove import FOXGLOVE

        return FOXGLOVE.get(type_name)
    return _ROS.get(type_name)


def meaning_of(type_name: str) -> Meaning | None:
    """Return the meaning of a schema; None if it is unknown."""
    row = row_of(type_name)
    return None if row is None else row.meaning


@cache
def has_ros_look(schema_name: str) -> bool:
    """Return whether messages of a schema look as its meaning, if ROS has written them.

    Args:
        schema_name: as a file or a peer gives it.
    """
    row = row_of(canonical_name(schema_name))
    return row is None or row.look is None

"""The types of properties RViz has (spec/rviz-core.md §1.3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from sambot_viz.rviz.properties.base import Property
from sambot_viz.rviz.properties.numbers import (
    BoolProperty,
    FloatProperty,
    IntProperty,
    read_bool,
)
from sambot_viz.rviz.properties.texts import (
    FILTER_SIZE,
    FIXED_FRAME,
    QOS_PROPERTIES,
    EditableEnumProperty,
    EnumProperty,
    FileProperty,
    RegexProperty,
    StringProperty,
    TfFrameProperty,
    TopicProperty,
    checked_text,
)
from sambot_viz.rviz.properties.vectors import (
    ColorProperty,
    QuaternionProperty,
    VectorProperty,
)

__all__ = [
    "FILTER_SIZE",
    "FIXED_FRAME",
    "QOS_PROPERTIES",
    "BoolProperty",
    "ColorProperty",
    "EditableEnumProperty",
    "EnumProperty",
    "FileProperty",
    "FloatProperty",
    "GroupProperty",
    "IntProperty",
    "QuaternionProperty",
    "RegexProperty",
    "StringProperty",
    "TfFrameProperty",
    "TopicProperty",
    "VectorProperty",
    "checked_text",
    "read_bool",
]


@dataclass(frozen=True)
class GroupProperty(Property):
    """A container: it has children and no value."""

    @property
    def has_value(self) -> bool:
        """It has none."""
        return False

    def write(self, value: Any) -> str:
        """There is nothing to write."""
        del value
        return ""

"""The types of properties that RViz has, under one name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from sambot_viz.rviz.properties.color import ColorProperty
from sambot_viz.rviz.properties.numbers import (
    BoolProperty,
    FloatProperty,
    IntProperty,
    read_bool,
)
from sambot_viz.rviz.properties.property import Property, Support
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
from sambot_viz.rviz.properties.vectors import VectorProperty

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
    "KeptProperty",
    "RegexProperty",
    "StringProperty",
    "TfFrameProperty",
    "TopicProperty",
    "VectorProperty",
    "checked_text",
    "read_bool",
]


@dataclass(frozen=True)
class KeptProperty(Property):
    """A key that RViz writes, or wrote, and that has no effect here.

    It is never set, and a new item does not get it; `note` says what RViz does with it.
    """

    read_only: bool = True
    open_keys: bool = True
    support: Support = "kept"

    @property
    def has_value(self) -> bool:
        """Return whether its value is used: it is not."""
        return False


@dataclass(frozen=True)
class GroupProperty(Property):
    """A container: it has children and no value."""

    @property
    def has_value(self) -> bool:
        """Return whether it has a value: a container has none."""
        return False

    def write(self, value: Any) -> str:
        """Return the empty text: a container has no value."""
        del value
        return ""

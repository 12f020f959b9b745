"""The .rviz document: reading, typed properties, lossless writing.

`RvizConfig` is a file; `ConfigItem` (a display, a view, a tool, Global Options) gives
typed values by path; the classes of `properties` declare what values there are::

    config = RvizConfig.load("urdf_config.rviz", Declarations(displays={...}))
    grid = config.displays[0]
    grid.get("Line Style/Line Width")     # 0.03
    grid.set("Alpha", 7)                  # 1.0: clamped, and in the document
    config.modified, config.problems      # True, ()
    config.save("urdf_config.rviz")       # one line of the file differs
"""

from __future__ import annotations

from sambot_viz.rviz.class_items import (
    DisplayConfig,
    GlobalOptions,
    ToolConfig,
    ViewConfig,
)
from sambot_viz.rviz.declarations import (
    GLOBAL_OPTIONS,
    Declarations,
    Declared,
    UnknownPropertyError,
)
from sambot_viz.rviz.item import ConfigItem, EntryItem
from sambot_viz.rviz.properties.kinds import (
    FILTER_SIZE,
    FIXED_FRAME,
    QOS_PROPERTIES,
    BoolProperty,
    ColorProperty,
    EditableEnumProperty,
    EnumProperty,
    FileProperty,
    FloatProperty,
    GroupProperty,
    IntProperty,
    KeptProperty,
    RegexProperty,
    StringProperty,
    TfFrameProperty,
    TopicProperty,
    VectorProperty,
)
from sambot_viz.rviz.properties.property import Property, PropertyError
from sambot_viz.rviz.rviz_config import RvizConfig

__all__ = [
    "FILTER_SIZE",
    "FIXED_FRAME",
    "GLOBAL_OPTIONS",
    "QOS_PROPERTIES",
    "BoolProperty",
    "ColorProperty",
    "ConfigItem",
    "Declarations",
    "Declared",
    "DisplayConfig",
    "EditableEnumProperty",
    "EntryItem",
    "EnumProperty",
    "FileProperty",
    "FloatProperty",
    "GlobalOptions",
    "GroupProperty",
    "IntProperty",
    "KeptProperty",
    "Property",
    "PropertyError",
    "RegexProperty",
    "RvizConfig",
    "StringProperty",
    "TfFrameProperty",
    "ToolConfig",
    "TopicProperty",
    "UnknownPropertyError",
    "VectorProperty",
    "ViewConfig",
]

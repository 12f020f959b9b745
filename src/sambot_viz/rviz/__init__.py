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

from sambot_viz.rviz.class_items import DisplayConfig as DisplayConfig
from sambot_viz.rviz.class_items import GlobalOptions as GlobalOptions
from sambot_viz.rviz.class_items import ToolConfig as ToolConfig
from sambot_viz.rviz.class_items import ViewConfig as ViewConfig
from sambot_viz.rviz.declarations import GLOBAL_OPTIONS as GLOBAL_OPTIONS
from sambot_viz.rviz.declarations import Declarations as Declarations
from sambot_viz.rviz.declarations import Declared as Declared
from sambot_viz.rviz.declarations import UnknownPropertyError as UnknownPropertyError
from sambot_viz.rviz.item import ConfigItem as ConfigItem
from sambot_viz.rviz.item import EntryItem as EntryItem
from sambot_viz.rviz.properties.color import ColorProperty as ColorProperty
from sambot_viz.rviz.properties.numbers import BoolProperty as BoolProperty
from sambot_viz.rviz.properties.numbers import FloatProperty as FloatProperty
from sambot_viz.rviz.properties.numbers import IntProperty as IntProperty
from sambot_viz.rviz.properties.numbers import VectorProperty as VectorProperty
from sambot_viz.rviz.properties.property import GroupProperty as GroupProperty
from sambot_viz.rviz.properties.property import KeptProperty as KeptProperty
from sambot_viz.rviz.properties.property import Property as Property
from sambot_viz.rviz.properties.property import PropertyError as PropertyError
from sambot_viz.rviz.properties.texts import FILTER_SIZE as FILTER_SIZE
from sambot_viz.rviz.properties.texts import FIXED_FRAME as FIXED_FRAME
from sambot_viz.rviz.properties.texts import QOS_PROPERTIES as QOS_PROPERTIES
from sambot_viz.rviz.properties.texts import (
    EditableEnumProperty as EditableEnumProperty,
)
from sambot_viz.rviz.properties.texts import EnumProperty as EnumProperty
from sambot_viz.rviz.properties.texts import FileProperty as FileProperty
from sambot_viz.rviz.properties.texts import RegexProperty as RegexProperty
from sambot_viz.rviz.properties.texts import StringProperty as StringProperty
from sambot_viz.rviz.properties.texts import TfFrameProperty as TfFrameProperty
from sambot_viz.rviz.properties.texts import TopicProperty as TopicProperty
from sambot_viz.rviz.rviz_config import RvizConfig as RvizConfig

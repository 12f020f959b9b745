"""The classes of displays, views and tools that a caller can show, with properties."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from sambot_viz.rviz.class_name import GROUP
from sambot_viz.rviz.properties.kinds import (
    BoolProperty,
    ColorProperty,
    IntProperty,
    TfFrameProperty,
)
from sambot_viz.rviz.properties.property import Property

GLOBAL_OPTIONS: tuple[Property, ...] = (
    TfFrameProperty(
        "Fixed Frame",
        default="base_link",
        ros1_default="map",
        help="The frame everything is drawn in; its origin is the origin of the scene.",
    ),
    ColorProperty(
        "Background Color",
        default=(48, 48, 48),
        help="The colour behind the scene.",
    ),
    IntProperty(
        "Frame Rate",
        default=30,
        minimum=1,
        unit="Hz",
        help="How often what moves by itself is drawn, at most 60 times a second.",
        acts_up_to=60,
    ),
    BoolProperty(
        "Default Light",
        default=True,
        ros1_only=True,
        help="The light at the camera; RViz for ROS 2 always has it.",
    ),
)

Classes: TypeAlias = Mapping[str, Sequence[Property]]
"""ROS 2 class id, such as "rviz_default_plugins/Grid", → its properties."""


def _none() -> Classes:
    return {}


@dataclass(frozen=True)
class Declarations:
    """The classes and options that the program can show.

    Attributes:
        displays: the display classes; groups are always known.
        views: the view classes, each with the keys common to all.
        tools: the tool classes.
        global_options: the properties of Global Options.
    """

    displays: Classes = field(default_factory=_none)
    views: Classes = field(default_factory=_none)
    tools: Classes = field(default_factory=_none)
    global_options: Sequence[Property] = GLOBAL_OPTIONS

    def display(self, kind: str) -> Sequence[Property] | None:
        """Return the properties of a display class; None when it is not known."""
        return () if kind == GROUP else self.displays.get(kind)

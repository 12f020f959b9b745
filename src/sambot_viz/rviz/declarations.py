"""The classes of displays, views and tools that a caller can show, with properties."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from sambot_viz.rviz.class_name import GROUP
from sambot_viz.rviz.global_options import GLOBAL_OPTIONS
from sambot_viz.rviz.properties.property import Property

Classes: TypeAlias = Mapping[str, Sequence[Property]]
"""ROS 2 class id, such as "rviz_default_plugins/Grid", → its properties."""


def _none() -> Classes:
    return {}


@dataclass(frozen=True)
class Declarations:
    """What the program can show.

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
        """The properties of a display class; None when it is not known."""
        return () if kind == GROUP else self.displays.get(kind)

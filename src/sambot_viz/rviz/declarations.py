"""The classes of displays, views and tools, and the properties that they declare.

Files of ROS 1 say ``rviz/Grid``, files of ROS 2 ``rviz_default_plugins/Grid``.
Here every class goes by its ROS 2 id, its kind; what was written is written back.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, TypeAlias

from sambot_viz.errors import UsageError, did_you_mean
from sambot_viz.rviz.properties.color import ColorProperty
from sambot_viz.rviz.properties.numbers import BoolProperty, IntProperty, VectorProperty
from sambot_viz.rviz.properties.property import Property
from sambot_viz.rviz.properties.texts import StringProperty, TfFrameProperty
from sambot_viz.rviz.yaml.yaml_nodes import Map

GROUP = "rviz_common/Group"
NO_CLASS = "(no class name found)"
"""What RViz calls a display without a class."""

_ROS1 = "rviz/"
_ROS2 = "rviz_default_plugins/"
_RENAMED = {"rviz/Group": GROUP, "rviz/WrenchStamped": f"{_ROS2}Wrench"}
_RENAMED_BACK = {new: old for old, new in _RENAMED.items()}


def is_ros1(class_id: str) -> bool:
    """Return whether a class id is one of ROS 1's own."""
    return class_id.startswith(_ROS1)


def kind_of(class_id: str) -> str:
    """Return the ROS 2 id of a class; foreign ids stay as they are."""
    if class_id in _RENAMED:
        return _RENAMED[class_id]
    return _ROS2 + class_id[len(_ROS1) :] if is_ros1(class_id) else class_id


def written_in_ros1(kind: str) -> str:
    """Return the ROS 1 id of a class; foreign ids stay as they are."""
    if kind in _RENAMED_BACK:
        return _RENAMED_BACK[kind]
    return _ROS1 + kind[len(_ROS2) :] if kind.startswith(_ROS2) else kind


def short_name(kind: str) -> str:
    """Return the part after the slash, such as "Grid"."""
    return kind.rpartition("/")[2]


def row_text(kind: str) -> str:
    """Return RViz's label of a view type, such as "Orbit (rviz_default_plugins)"."""
    package, _, name = kind.rpartition("/")
    return f"{name} ({package})" if package else name


Keys = tuple[str, ...]


class UnknownPropertyError(UsageError):
    """A property that is not declared.

    Attributes:
        path: what was asked for.
    """

    def __init__(self, owner: str, path: str, known: Sequence[str]):
        self.path = path
        super().__init__(f"{owner} has no '{path}'; {did_you_mean(path, known)}")


class Declared(NamedTuple):
    """A property with its place in the file.

    Attributes:
        path: keys from the item on, joined by "/".
        keys: the same keys.
        property: the declaration.
        above: the one whose child it is.
    """

    path: str
    keys: tuple[str, ...]
    property: Property
    above: Declared | None = None


def unknown_keys(
    node: Map, known: Mapping[Keys, Declared], own: Collection[str]
) -> Iterator[str]:
    """Yield the undeclared keys of a map as paths joined by "/", in its order.

    Args:
        node: the map of an item.
        known: the declared properties by their keys.
        own: keys of the first level that have a meaning but are not properties.
    """
    return _below(node, (), None, known, own)


def _below(
    node: Map,
    above: Keys,
    owner: Declared | None,
    known: Mapping[Keys, Declared],
    own: Collection[str],
) -> Iterator[str]:
    for key in node.keys():
        keys = (*above, key)
        declared, value = known.get(keys), node.get(key)
        if declared is not None:
            if isinstance(value, Map):
                yield from _below(value, keys, declared, known, own)
        elif not (key in own if owner is None else _belongs_to(key, owner)):
            yield "/".join(keys)


def _belongs_to(key: str, owner: Declared) -> bool:
    """Return whether a property has a key without declaring it."""
    prop = owner.property
    if isinstance(prop, VectorProperty):
        return key in prop.keys
    return prop.open_keys or (key == "Value" and prop.has_value)


GLOBAL_OPTIONS: tuple[Property, ...] = (
    TfFrameProperty(
        "Fixed Frame",
        default="base_link",
        ros1_default="map",
        help="The frame everything is drawn in; its origin is the origin of the scene.",
    ),
    ColorProperty(
        "Background Color", default=(48, 48, 48), help="The colour behind the scene."
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

TIME: tuple[Property, ...] = (
    BoolProperty(
        "Experimental",
        default=False,
        help="Whether RViz shows its controls of synchronization, and they act.",
    ),
    IntProperty(
        "SyncMode",
        default=0,
        minimum=0,
        maximum=2,
        help="When frames are drawn: now with 0, at the stamp of the source's last "
        "message with 1, as long ago as its messages take to come with 2.",
    ),
    StringProperty(
        "SyncSource",
        help="The name of the display by whose messages frames are drawn.",
    ),
)
"""Of RViz's Time panel."""

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

"""Read the settings of the displays, tools and views in configs of RViz."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import yaml

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.parameters import (
    YamlFile,
    each_mapping,
    pairs,
    place_of,
)
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.robot.slips.vocabulary import is_one_slip

OWN_PACKAGES = ("rviz_default_plugins", "rviz_common")
"""The packages whose displays, tools and views come with RViz."""
_OPEN = frozenset(
    """
    Displays Frames Links Namespaces Saved Tools Transformation Tree Views Visibility
    """.split()
) | {"Global Options"}
"""Keys above names of a robot or topic, or above other displays, tools and views."""
_GLOBAL = {
    name: f"rviz_common/{name}" for name in ("Visualization Manager", "Global Options")
}
"""Maps without a class that RViz itself reads."""


class Settings(NamedTuple):
    """A map in a config of RViz.

    Attributes:
        owner: the class of the display, tool or view that it belongs to.
        values: its keys and values; only values that are texts.
        keys: the keys, with their places.
        above: the key above this display, tool or view; empty for a map in it.
        key: the key above this map.
    """

    owner: str
    values: Mapping[str, Fact]
    keys: Mapping[str, Fact]
    above: str
    key: str


def settings(around: Surroundings) -> Iterator[Settings]:
    """Yield the settings of all displays, tools and views in configs of RViz."""
    for package in around.packages:
        for file in package.configs.values():
            yield from _in_config(file)


def _in_config(file: YamlFile) -> Iterator[Settings]:
    for above, node in each_mapping(file.root):
        values = _values(node, file.shown)
        kind = values.get("Class") or _misspelt_class(values)
        owner = (kind.value if kind is not None else "") or _GLOBAL.get(above, "")
        for key, inner in each_mapping(node, left_out=_OPEN) if owner else ():
            both = ((key.value, place_of(key, file.shown)) for key, _ in pairs(inner))
            keys = {name: Fact(name, place) for name, place in both}
            keys |= _beside_names(inner, file.shown)
            texts, is_whole = _values(inner, file.shown), inner is node
            yield Settings(owner, texts, keys, above * is_whole, key)


def _beside_names(node: yaml.Node, shown: str) -> dict[str, Fact]:
    """Return the settings among the frames and the links, each of which is a map."""
    inside = (value for key, value in pairs(node) if key.value in ("Frames", "Links"))
    return {
        key.value: Fact(key.value, place_of(key, shown))
        for each in inside
        for key, value in pairs(each)
        if isinstance(value, yaml.ScalarNode)
    }


def _values(node: yaml.Node, shown: str) -> dict[str, Fact]:
    """Return the keys of a mapping with their values that are texts."""
    return {
        key.value: Fact(value.value, place_of(value, shown))
        for key, value in pairs(node)
        if isinstance(value, yaml.ScalarNode)
    }


def _misspelt_class(values: Mapping[str, Fact]) -> Fact | None:
    """Return the class that follows a misspelt key."""
    kinds = (v for k, v in values.items() if is_one_slip(k, "Class"))
    return next((kind for kind in kinds if "/" in kind.value), None)

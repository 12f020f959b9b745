"""Names in configs of RViz that it does not know, and robots that it cannot show."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import yaml

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.parameters import pairs, place_of
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.words import meant_word
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write
from sambot_viz.errors import Problem, nearest

_OWN = ("rviz_default_plugins", "rviz_common")
_OPEN = frozenset(
    {"Frames", "Links", "Namespaces", "Transformation", "Tree", "Visibility"}
)
"""What names in a robot or a topic are below."""
_LIKE_PROPERTY, _LIKE_CLASS = 0.8, 0.87


class _Settings(NamedTuple):
    """A map in a config of RViz.

    Attributes:
        owner: the class of the display, tool or view that it belongs to.
        values: its keys and values, those that are texts.
        keys: the keys, with their places.
        is_whole: it is that display, tool or view itself.
    """

    owner: str
    values: Mapping[str, Fact]
    keys: Mapping[str, Fact]
    is_whole: bool


def _settings(around: Surroundings) -> Iterator[_Settings]:
    """Give the settings of all displays, tools and views in configs of RViz."""
    for package in around.packages:
        for path in package.ending(".rviz"):
            shown = package.shown(path)
            file = package.yaml(path)
            waiting = [(file.root, "")] if file is not None else []
            while waiting:
                node, owner = waiting.pop()
                if isinstance(node, yaml.SequenceNode):
                    waiting += [(each, "") for each in reversed(node.value)]
                    continue
                both = list(pairs(node))
                keys = {
                    key.value: Fact(key.value, place_of(key, shown)) for key, _ in both
                }
                values = {
                    key.value: Fact(value.value, place_of(value, shown))
                    for key, value in both
                    if isinstance(value, yaml.ScalarNode)
                }
                kind = values.get("Class")
                owner = kind.value if kind is not None else owner
                if owner:
                    yield _Settings(owner, values, keys, kind is not None)
                waiting += [(v, owner) for k, v in both[::-1] if k.value not in _OPEN]


def unknown_settings(around: Surroundings) -> Iterator[Problem]:
    """Report classes and properties that are almost those of RViz."""
    table = vocabulary("rviz_classes")
    classes = [
        f"{package}/{name.replace('_', ' ')}"
        for package in _OWN
        for name in table[package]
    ]
    for one in _settings(around):
        package, _, name = one.owner.rpartition("/")
        kind = one.values.get("Class")
        near = nearest(one.owner, classes, _LIKE_CLASS) if kind else None
        if near is not None and kind is not None and one.owner not in classes:
            what = "display " if "Enabled" in one.keys else ""
            yield Problem.at(
                kind.place,
                "warning",
                "config-class",
                f"RViz has no {what}{one.owner}: it shows an error in its place",
                write(kind.place, one.owner, near),
            )
        for key in one.keys.values() if package in _OWN else ():
            word = key.value.replace(" ", "_")
            right = meant_word(table["properties"], word, _LIKE_PROPERTY)
            right = (right or "").replace("_", " ")
            if right and right not in one.keys:
                yield Problem.at(
                    key.place,
                    "warning",
                    "config-property",
                    f"{name} has no property {key.value}, but {right}, whose default "
                    "is used",
                    write(key.place, key.value, right),
                )


def robots_without_source(around: Surroundings) -> Iterator[Problem]:
    """Report displays of a robot that name no file, or a prefix that no frame has."""
    for one in _settings(around):
        if not one.is_whole or one.owner.rpartition("/")[2] != "RobotModel":
            continue
        source, file = (one.values.get(f"Description {n}") for n in ("Source", "File"))
        if source is not None and source.value == "File" and not (file and file.value):
            yield Problem.at(
                source.place,
                "warning",
                "setup-description-topic",
                "the display RobotModel reads the robot from a file, and names none: "
                "it shows nothing",
                write(source.place, "File", "Topic"),
            )
        prefix = one.values.get("TF Prefix")
        name = prefix.value.strip("/") if prefix is not None else ""
        if prefix is None or not name or around.namespaced or not around.links:
            continue
        used = any(link.startswith(f"{name}/") for link in around.links)
        if not used and not around.said_elsewhere(name):
            yield Problem.at(
                prefix.place,
                "warning",
                "frame-unknown",
                f"the display RobotModel looks for frames that begin with {name}/, and "
                "no launch file gives them this prefix: each link has an error",
                write(prefix.place, prefix.value, '""', hint='write TF Prefix: ""'),
            )

"""Read the topics of the displays and tools in an RViz config."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

import yaml

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import (
    each_mapping,
    flag,
    pairs,
    place_of,
)
from sambot_viz.checks.around.running.includes import installed_as
from sambot_viz.checks.around.running.known import known_nodes
from sambot_viz.checks.around.running.system import RunningNode
from sambot_viz.checks.around.workspace import Package

_TOPICS = ("Topic", "Description Topic", "Depth Map Topic", "Image Topic")


class DisplayTopic(NamedTuple):
    """A topic of an enabled display or a tool.

    Attributes:
        name: the name of the display.
        kind: its class.
        message: the type of the topic.
        topic: the topic.
        policies: the settings of its quality of service, by their names.
        is_tool: it publishes the topic.
    """

    name: str
    kind: Fact
    message: str
    topic: Fact
    policies: Mapping[str, Fact]
    is_tool: bool


def displays_of(
    node: RunningNode, find: Callable[[str], Package | None]
) -> Iterator[DisplayTopic]:
    """Yield the topics of the displays and tools in the config of an RViz.

    Args:
        node: the RViz.
        find: returns an available package by its name.
    """
    named = dict(pairwise(node.arguments))
    path = named.get("-d") or named.get("--display-config") or ""
    name, _, below = path.removeprefix(SHARE).partition("/")
    package = find(name) if path.startswith(SHARE) else None
    own = installed_as(package, below) if package is not None else None
    file = package.yaml(own) if package is not None and own is not None else None
    if file is not None:
        for _, inner in each_mapping(file.root):
            values = {key.value: value for key, value in pairs(inner)}
            yield from _topics(values, file.shown)


def _topics(values: dict[str, yaml.Node], file: str) -> Iterator[DisplayTopic]:
    said = _facts(values, file)
    displays, tools = known_nodes().displays, known_nodes().tools
    kind = said.get("Class")
    message = displays.get(kind.value) or tools.get(kind.value) if kind else None
    enabled = said.get("Enabled")
    off = enabled is not None and flag(enabled.value) is False
    for key in _TOPICS if kind is not None and message is not None and not off else ():
        inner = {k.value: each for k, each in pairs(values.get(key, _NOTHING))}
        policies = _facts(inner, file)
        topic = policies.get("Value", said.get(key))
        if topic is not None and topic.value and kind is not None and message:
            name = said.get("Name", kind).value
            is_tool = kind.value in tools
            yield DisplayTopic(name, kind, message, topic, policies, is_tool)


_NOTHING = yaml.ScalarNode("", "")


def _facts(values: Mapping[str, yaml.Node], file: str) -> dict[str, Fact]:
    return {
        key: Fact(value.value, place_of(value, file))
        for key, value in values.items()
        if isinstance(value, yaml.ScalarNode)
    }

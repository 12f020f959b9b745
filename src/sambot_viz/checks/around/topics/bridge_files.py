"""The YAML file of a bridge: its keys and its form; parameter files without content."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import yaml

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.parameters import pairs, place_of
from sambot_viz.checks.around.running.bridge_entries import DIRECTIONS, TYPES, meant_key
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.topics.bridge_types import counterpart
from sambot_viz.checks.around.unreadable import parameter_files
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem, nearest

_YAML: Any = yaml
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def misspelt_entries(around: Surroundings) -> Iterator[Problem]:
    """Report keys and directions that a bridge does not know."""
    for file in around.yaml_files:
        for entry in file.entries():
            if not any(key.endswith("type_name") for key in entry):
                continue
            yield from _misspelt_keys(entry)
            yield from _named_twice(entry)
            way = entry.get("direction")
            if way is not None and way.value not in DIRECTIONS:
                near = _direction(way.value)
                yield Problem.at(
                    way.place,
                    "error",
                    "bridge-entry",
                    f"the bridge does not know the direction {way.value}: it leaves "
                    "this topic out",
                    write(way.place, way.value, near, hint=f"write direction: {near}")
                    if near
                    else f"write {DIRECTIONS[0]}, {DIRECTIONS[1]} or {DIRECTIONS[2]}",
                )


def _direction(written: str) -> str | None:
    """Return the intended direction, by its letters or by which side comes first."""
    said = written.upper().replace("IGN", "GZ")
    near = nearest(said, DIRECTIONS, 0.7)
    both = said.find("GZ"), said.find("ROS")
    if -1 in both:
        return near
    return DIRECTIONS[0] if both[0] < both[1] else DIRECTIONS[1]


def entries_without_type(around: Surroundings) -> Iterator[Problem]:
    """Report entries of a bridge without one of the two types."""
    for file in around.yaml_files:
        for entry in file.entries():
            topic = entry.get("ros_topic_name", entry.get("gz_topic_name"))
            names = [key.replace("ign_", "gz_", 1) for key in entry]
            lacking = [key for key in TYPES if key not in names]
            if topic is None or not lacking or any(_misspelt_keys(entry)):
                continue
            said = entry.get(next((k for k in TYPES if k not in lacking), ""))
            better = counterpart(said.value) if said is not None else None
            yield Problem.at(
                topic.place,
                "error",
                "bridge-entry",
                f"this entry of the bridge has no {' and no '.join(lacking)}: it "
                "leaves this topic out",
                f"add {lacking[0]}: {better}"
                if better
                else f"add {' and '.join(lacking)} to the entry",
            )


def _misspelt_keys(entry: dict[str, Fact]) -> Iterator[Problem]:
    for key, fact in entry.items():
        near = meant_key(key, entry)
        if near is not None:
            follows = (
                "it leaves this topic out"
                if near in TYPES
                else "it does not read this line"
            )
            yield Problem.at(
                fact.place,
                "error" if near in TYPES else "warning",
                "bridge-entry",
                f"the bridge does not know the key {key}: {follows}",
                write(fact.place, key, near),
            )


def _named_twice(entry: dict[str, Fact]) -> Iterator[Problem]:
    """Report topic_name, which sets both names, beside one of the two."""
    both = entry.get("topic_name")
    given = [key for key in ("ros_topic_name", "gz_topic_name") if key in entry]
    if both is None or not given:
        return
    lacking = "gz_topic_name" if given == ["ros_topic_name"] else "ros_topic_name"
    yield Problem.at(
        both.place,
        "error",
        "bridge-entry",
        f"topic_name is the name in ROS and in Gazebo, and {given[0]} is given too: "
        "the bridge leaves this topic out",
        write(both.place, "topic_name", lacking)
        if len(given) == 1
        else "delete this line",
    )


def entries_outside_lists(around: Surroundings) -> Iterator[Problem]:
    """Report files that give the topics of a bridge without a list."""
    for file in around.yaml_files:
        if any(key.value.startswith("ros__") for key, _ in _two_levels(file.root)):
            continue
        for key, value in _two_levels(file.root):
            inner = value.value[0] if _is_filled_list(value) else value
            if _is_entry(file.root):
                cause, hint = _form(key, None)
            elif _is_entry(inner):
                cause, hint = _form(key, value)
            else:
                continue
            yield Problem.at(
                place_of(key, file.shown),
                "error",
                "bridge-entry",
                f"{cause}: the bridge needs a list, and carries nothing",
                hint,
            )
            break


def _two_levels(root: yaml.Node) -> Iterator[tuple[yaml.ScalarNode, yaml.Node]]:
    for key, value in pairs(root):
        yield key, value
        yield from pairs(value)


def _is_filled_list(node: yaml.Node) -> bool:
    return isinstance(node, yaml.SequenceNode) and bool(node.value)


def _is_entry(node: yaml.Node) -> bool:
    keys = {key.value for key, _ in pairs(node)}
    return not keys.isdisjoint(("ros_topic_name", "gz_topic_name", *TYPES))


def _form(key: yaml.ScalarNode, below: yaml.Node | None) -> tuple[str, str]:
    """Return the cause and the hint for an entry outside a list."""
    if below is None:
        cause = 'no "- " is before the first key of the entry'
        return cause, f"write - {key.value}, and two blanks more before the others"
    cause = f"the topics are below the key {key.value}"
    if _is_filled_list(below):
        return cause, f"delete the line {key.value}:"
    ((first, _), *_) = pairs(below)
    return cause, f"delete the line {key.value}:, and write - {first.value} below it"


def second_documents(around: Surroundings) -> Iterator[Problem]:
    """Report a second YAML document, which the bridge does not read.

    Only lists for a bridge: ROS reads all documents of a parameter file.
    """
    for package, path, _user in parameter_files(around):
        line = _second_document(package.text(path) or "")
        if line is not None:
            yield Problem.at(
                Place(package.shown(path), line),
                "error",
                "parameters-yaml",
                "this --- begins a second document: what is below it is not read",
                "delete this line",
            )


def _second_document(text: str) -> int | None:
    """Return the line of the --- after a list; None for a file with one document."""
    if "---" not in text:
        return None
    starts, is_list = 0, False
    try:
        for event in _YAML.parse(text, _LOADER):
            starts += isinstance(event, yaml.DocumentStartEvent)
            if starts == 2:
                return int(event.start_mark.line) + 1
            is_list |= isinstance(event, yaml.SequenceStartEvent)
            if isinstance(event, yaml.MappingStartEvent) and not is_list:
                return None
    except (yaml.YAMLError, RecursionError):
        return None
    return None


def empty_parameters(around: Surroundings) -> Iterator[Problem]:
    """Report empty files that a launch file gives to a node."""
    for launch in around.launches:
        for node in launch.nodes:
            for fact in node.files:
                text, shown = around.text(fact.value), around.shown(fact.value)
                if shown is None or text is None or not _is_empty(text):
                    continue
                name = node.name or node.executable
                yield Problem.at(
                    Place(shown, 1),
                    "warning",
                    "parameters-empty",
                    f"this file is empty, but {launch.shown.rpartition('/')[2]} line "
                    f"{fact.place.line} gives it to {name}: it has no parameters",
                    f"write {name}: and ros__parameters: into it, and the parameters "
                    "below them",
                )


def _is_empty(text: str) -> bool:
    lines = (line.partition("#")[0].strip() for line in text.splitlines())
    return not any(line not in ("", "---", "...") for line in lines)

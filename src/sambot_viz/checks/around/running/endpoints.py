"""Find the topics and transforms of a node, from the table of known nodes."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import flag
from sambot_viz.checks.around.running.bridge_entries import (
    IMAGE_BRIDGE,
    BridgeEntry,
    bare,
    entries_in,
    entries_of_file,
    entries_of_images,
)
from sambot_viz.checks.around.running.displays import displays_of
from sambot_viz.checks.around.running.known import KnownNode, NodeRow, known_nodes
from sambot_viz.checks.around.running.system import (
    Endpoint,
    GivenParameter,
    NeededFrame,
    PublishedTransform,
    RunningNode,
)
from sambot_viz.checks.around.workspace import Package
from sambot_viz.errors import Place

_WILD = {"#": r"(\d+)", "*": r"([\w.]+)"}
_WORD = re.compile(r"([^$]*)\$([\w.#*]+)(?:=(.*)|(/.*))?")
_ENDS = {
    "publishes": (True, False),
    "subscribes": (False, False),
    "sends": (True, True),
    "takes": (False, True),
}
"""Verb of a row → whether it is a publisher, and whether its topic is in Gazebo."""


class _Said(NamedTuple):
    """A text from a parameter or from the table."""

    text: str
    parameter: GivenParameter | None
    star: str


def whole_name(node: RunningNode, name: str) -> str:
    """Return the topic for a name in a node, with namespace and remappings.

    It has no leading slash where the namespace is unknown.
    """
    whole = _expanded(node, name)
    for old, new in node.remappings:
        if _expanded(node, old) == whole:
            return _expanded(node, new)
    return whole


def _expanded(node: RunningNode, name: str) -> str:
    if name.startswith("/"):
        return name
    if name.startswith("~"):
        return f"{node.path}/{name[1:].strip('/')}"
    return f"{node.namespace.rstrip('/')}/{name}" if node.namespace else name


def with_endpoints(
    node: RunningNode, find: Callable[[str], Package | None], *, displays: bool
) -> RunningNode:
    """Return a node with its known topics and transforms.

    Args:
        node: the node.
        find: returns a package that is here by its name.
        displays: read the config of RViz for the topics of its displays.
    """
    known = known_nodes().nodes.get((node.package, node.executable))
    if known is None:
        # The other programs of these packages have no topics of a robot.
        ours = node.package in known_nodes().packages
        return replace(node, endpoints_known=ours)
    endpoints = list(_of_rows(node, known))
    if known.does("bridge"):
        for entry in entries_of(replace(node, remappings=()), find):
            endpoints += entry.endpoints(whole_name(node, entry.ros.value))
    if known.does("displays") and displays:
        endpoints += _of_displays(node, find)
    return replace(
        node,
        endpoints=tuple(dict.fromkeys(endpoints)),
        transforms=tuple(_transforms(node, known)),
        needs=tuple(_needs(node, known)),
        endpoints_known=True,
        is_simulator=known.does("simulator"),
    )


def switched_off(node: RunningNode) -> Iterator[Endpoint]:
    """Yield the topics that a node would have with another value of a parameter."""
    known = known_nodes().nodes.get((node.package, node.executable))
    if known is not None:
        yield from _of_rows(node, known, off=True)


def _of_rows(
    node: RunningNode, known: KnownNode, *, off: bool = False
) -> Iterator[Endpoint]:
    for row in known.rows:
        if row.verb not in _ENDS or _is_off(node, row) is not off:
            continue
        publishes, in_gazebo = _ENDS[row.verb]
        every = list(_said(node, row.words[0]))
        if in_gazebo and not every:
            yield _unnamed(node, row)
        for said in every:
            kind = next(iter(_said(node, row.words[1].replace("*", said.star))), None)
            name = said.text
            yield Endpoint(
                f"/{bare(name)}" if in_gazebo else whole_name(node, name),
                kind.text if kind is not None else "",
                publishes,
                said.parameter.place if said.parameter else node.place,
                name,
                said.parameter.name if said.parameter else "",
                in_gazebo,
                row.is_seldom,
                row.latched,
                _typed_at(node, row),
                row.switch,
            )


def _typed_at(node: RunningNode, row: NodeRow) -> Place | None:
    """Return the line that decides on a row; None for a default that varies."""
    name, _ = row.switch
    given = node.parameter(name) if name else None
    if given is not None:
        return given.place if flag(given.value or "") is not None else None
    is_sure = not name or (row.everywhere and node.parameters_known)
    return node.place if is_sure else None


def _unnamed(node: RunningNode, row: NodeRow) -> Endpoint:
    """Return an end whose topic Gazebo generates: its parameter is missing."""
    found = _WORD.fullmatch(row.words[0])
    name, after = (found[2], found[4] or "") if found else ("", "")
    publishes, _ = _ENDS[row.verb]
    place, kind = node.place, row.words[1]
    return Endpoint("", kind, publishes, place, after, name, True, row.is_seldom)


def _is_off(node: RunningNode, row: NodeRow) -> bool:
    return _is(node, row.unless) or (row.when[0] != "" and not _is(node, row.when))


def _is(node: RunningNode, condition: tuple[str, str]) -> bool:
    """Return whether a node gets a parameter with a value."""
    name, value = condition
    given = node.parameter(name) if name else None
    return given is not None and flag(given.value or "") is flag(value)


def _said(node: RunningNode, words: str) -> Iterator[_Said]:
    """Yield the texts that a word of the table means."""
    found = _WORD.fullmatch(words)
    if found is None:
        yield _Said(words, None, "")
        return
    before, name, default, after = found.groups(default="")
    wild = next((sign for sign in _WILD if sign in name), None)
    if wild is not None:
        pattern = re.compile(re.escape(name).replace(re.escape(wild), _WILD[wild]))
        for parameter in node.parameters:
            match = pattern.fullmatch(parameter.name)
            if match is not None and parameter.value:
                yield _Said(before + parameter.value + after, parameter, match[1])
        return
    given = _argument(node, int(name)) if name.isdigit() else node.parameter(name)
    if given is not None:
        if given.value:
            yield _Said(before + given.value + after, given, "")
    elif default:
        yield from (
            _Said(before + s.text, s.parameter, "") for s in _said(node, default)
        )


def _argument(node: RunningNode, number: int) -> GivenParameter | None:
    """Return an argument of a program as a parameter, counted from 1."""
    every = list(node.placed_arguments)
    words = [word for word, _ in every]
    end = words.index("--ros-args") if "--ros-args" in words else len(words)
    text, place = every[number - 1] if number <= end else (None, node.place)
    return None if text is None else GivenParameter(str(number), (text,), place)


def _transforms(node: RunningNode, known: KnownNode) -> Iterator[PublishedTransform]:
    for row in known.rows:
        if row.verb == "transform" and not _is_off(node, row):
            for parent, child in zip(
                *(_said(node, w) for w in row.words[:2]), strict=False
            ):
                said = child.parameter or parent.parameter
                place = said.place if said else node.place
                frames = [each.text.strip().lstrip("/") for each in (parent, child)]
                yield _in_the_map(
                    node, row, PublishedTransform(frames[0], frames[1], place)
                )
    if known.name == "static_transform_publisher":
        yield from _static(node)


def _in_the_map(
    node: RunningNode, row: NodeRow, one: PublishedTransform
) -> PublishedTransform:
    """Return the transform of a filter, which from the map leads to odometry."""
    ends = [next(_said(node, word)).text.strip().lstrip("/") for word in row.words[2:]]
    return replace(one, child=ends[1]) if ends[:1] == [one.parent] else one


def _needs(node: RunningNode, known: KnownNode) -> Iterator[NeededFrame]:
    for row in known.rows:
        for said in _said(node, row.words[0]) if row.verb == "needs" else ():
            place = said.parameter.place if said.parameter else node.place
            yield NeededFrame(said.text.strip().lstrip("/"), place)


def _static(node: RunningNode) -> Iterator[PublishedTransform]:
    """Yield the transform in the arguments of a static_transform_publisher."""
    words = [word or "" for word in node.arguments]
    words = words[: words.index("--ros-args")] if "--ros-args" in words else words
    named = dict(pairwise(words))
    ends = named.get("--frame-id"), named.get("--child-frame-id")
    if None in ends and len(words) in (8, 9) and not words[-1].startswith("-"):
        ends = words[-2], words[-1]
    parent, child = ends
    if parent and child:
        yield PublishedTransform(parent.lstrip("/"), child.lstrip("/"), node.place)


def entries_of(
    node: RunningNode, find: Callable[[str], Package | None]
) -> Iterator[BridgeEntry]:
    """Yield the topics of a bridge from its arguments, its remappings and its file.

    Args:
        node: the bridge.
        find: returns a package that is here by its name.
    """
    if node.executable == IMAGE_BRIDGE:
        yield from entries_of_images(node.placed_arguments, node.remappings)
    yield from entries_in(node.placed_arguments, node.remappings)
    given = node.parameter("config_file")
    path = given.value if given is not None else None
    name, _, below = (path or "").removeprefix(SHARE).partition("/")
    package = find(name)
    for file in package.yaml_files if package is not None else ():
        yield from entries_of_file(file) if file.path == below else ()


def _of_displays(
    node: RunningNode, find: Callable[[str], Package | None]
) -> Iterator[Endpoint]:
    """Yield the topics of the displays and tools in an RViz config."""
    for each in displays_of(node, find):
        whole = whole_name(node, each.topic.value)
        place, written = each.topic.place, each.topic.value
        yield Endpoint(whole, each.message, each.is_tool, place, written)

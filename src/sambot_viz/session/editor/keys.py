"""Keys and values that an editor offers in parameter files: those `check` knows."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from sambot_viz.checks.around.parameters.known import (
    LISTS,
    KnownParameter,
    ParameterBlock,
    known_parameters,
)
from sambot_viz.checks.around.running.bridge_entries import DIRECTIONS
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.robot.model import Robot

Keys = Mapping[str, tuple[str, ...]]
"""Parameter → the values that the editor offers for it."""

_TOP = re.compile(r"^ *[\"']?/?(?:[\w*]+/)*([\w*]+)[\"']?:\s*$", re.MULTILINE)
_ITEM = re.compile(r"^- +\w+:", re.MULTILINE)
_FRAMES_BESIDE = ("map", "odom")
"""Frames that most robots have, but no model."""


def offered_keys(robot: Robot | None, text: str) -> dict[str, Keys]:
    """Return the keys that a parameter file may have.

    Args:
        robot: robot whose links become offered frames.
        text: text of the file.

    Returns:
        Node in the file → its parameters. "-" holds the keys of a bridge's list, which
        names no nodes; "" holds the names of all nodes.
    """
    if _ITEM.search(text):
        return {"-": _bridge()}
    frames = (*(() if robot is None else robot.links), *_FRAMES_BESIDE)
    nodes = known_parameters().nodes
    named = dict.fromkeys(_TOP.findall(text))
    made = {name: _keys(nodes[name], frames) for name in named if name in nodes}
    return {"": dict.fromkeys(sorted(nodes), ()), **made}


def _bridge() -> Keys:
    types = vocabulary("ros_gz_bridge")
    of_gazebo = (f"gz.msgs.{name}" for names in types.values() for name in names)
    return {
        "ros_topic_name": (),
        "gz_topic_name": (),
        "topic_name": (),
        "ros_type_name": tuple(types),
        "gz_type_name": tuple(sorted(set(of_gazebo))),
        "direction": DIRECTIONS,
    }


def _keys(block: ParameterBlock, frames: tuple[str, ...]) -> Keys:
    listed = (known.base for known in block.parameters.values() if known.kind in LISTS)
    plugins = tuple(name for base in dict.fromkeys(listed) for name in _classes(base))
    own = {"ros__parameters": (), **({"plugin": plugins} if plugins else {})}
    return {**dict(_parameters((block, block.parts), frames)), **own}


def _parameters(
    blocks: Iterable[ParameterBlock], frames: tuple[str, ...]
) -> Iterator[tuple[str, tuple[str, ...]]]:
    for block in blocks:
        for name, known in block.parameters.items():
            values = _values(known, frames)
            # odomN becomes odom0; each part of a dotted name is a key.
            parts = re.sub(r"N(?=\d|$|\.|_)", "0", name).split(".")
            yield from ((part, ()) for part in parts[:-1] if part != "*")
            if parts[-1] != "*":
                yield parts[-1], values


def _values(known: KnownParameter, frames: tuple[str, ...]) -> tuple[str, ...]:
    if known.kind == "boolean":
        return "true", "false"
    if known.kind == "frame" or known.name.endswith(("_frame", "frame_id")):
        return frames
    return known.words if known.kind in LISTS else known.words or _classes(known.base)


def _classes(base: str) -> tuple[str, ...]:
    classes = known_parameters().classes.values()
    return tuple(each.name for each in classes if base and each.base == base)

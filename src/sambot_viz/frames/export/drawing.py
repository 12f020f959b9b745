"""The tree of frames as DOT and as JSON, and what is written at its edges.

The form of the graph is view_frames' as of ROS 2, with what that leaves
out: joint name and type, xyz and rpy.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TypedDict

from sambot_viz.frames.frame_tree import FrameTree, Hop
from sambot_viz.frames.robot_frames import joint_between
from sambot_viz.robot.model import Robot
from sambot_viz.text import text

NO_DATA = "No tf data received"
"""The drawing of view_frames without frames."""


class EdgeJson(TypedDict):
    """One transform of the JSON drawing; metres and radians."""

    parent: str
    child: str
    joint: str | None
    type: str | None
    static: bool
    xyz: list[float]
    rpy: list[float]
    rotation_xyzw: list[float]


class TreeJson(TypedDict):
    """The JSON drawing: all frames in the order learnt, the roots, the transforms."""

    frames: list[str]
    roots: list[str]
    transforms: list[EdgeJson]


def tree_json(tree: FrameTree, robot: Robot | None = None) -> TreeJson:
    """Return the tree as plain data, all numbers exact.

    Args:
        tree: the frames.
        robot: gives the names and types of the joints.
    """
    return {
        "frames": list(tree.frames),
        "roots": list(tree.roots),
        "transforms": [_edge_json(hop, robot) for hop in _hops(tree)],
    }


def _edge_json(hop: Hop, robot: Robot | None) -> EdgeJson:
    joint = joint_between(robot, hop.parent, hop.child)
    return {
        "parent": hop.parent,
        "child": hop.child,
        "joint": joint.name if joint else None,
        "type": joint.type if joint else None,
        "static": hop.static,
        "xyz": hop.transform.translation.tolist(),
        "rpy": list(hop.transform.rpy),
        "rotation_xyzw": hop.transform.rotation_xyzw.tolist(),
    }


def tree_dot(tree: FrameTree, robot: Robot | None = None) -> str:
    """Return the tree in Graphviz' language; ``dot -Tpdf`` draws it.

    Args:
        tree: the frames.
        robot: gives the names and types of the joints.
    """
    lines = ["digraph frames {", "  rankdir=TB;", "  node [shape=ellipse];"]
    if not len(tree):
        lines.append(f"  {_quoted(NO_DATA)};")
    lines += [f"  {_quoted(frame)};" for frame in tree.frames]
    for hop in _hops(tree):
        label = _quoted("\n".join((*edge_lines(hop, robot), *_broadcast(hop))))
        style = "" if hop.static else ", color=blue"
        edge = f"{_quoted(hop.parent)} -> {_quoted(hop.child)}"
        lines.append(f"  {edge} [label={label}{style}];")
    return "\n".join([*lines, "}", ""])


def edge_lines(hop: Hop, robot: Robot | None) -> tuple[str, ...]:
    """Return the text at an edge: joint, type, xyz [m], rpy [rad]."""
    joint = joint_between(robot, hop.parent, hop.child)
    if joint is not None:
        head = (joint.name, joint.type)
    else:
        head = ("static transform" if hop.static else "transform",)
    return (
        *head,
        f"xyz {_numbers(hop.transform.translation.tolist())}",
        f"rpy {_numbers(hop.transform.rpy)}",
    )


def _broadcast(hop: Hop) -> tuple[str, ...]:
    """view_frames' label lines, as far as they are known here."""
    if hop.static:
        # view_frames divides by at least 100 µs, hence its rate of 10000.
        return (
            "Broadcaster: default_authority",
            "Average rate: 10000.0",
            "Buffer length: 0.0",
            "Most recent transform: 0.0",
            "Oldest transform: 0.0",
        )
    return ("Broadcaster: default_authority", f"Most recent transform: {hop.stamp}")


def _hops(tree: FrameTree) -> Iterator[Hop]:
    for frame in tree.frames:
        if tree.parent(frame) is not None:
            yield tree.hop(frame)


def _numbers(values: list[float] | tuple[float, ...]) -> str:
    # Rounding first and adding 0 prints what is nearly zero as 0, never as -0.
    return " ".join(f"{round(value, 4) + 0.0:g}" for value in values)


def _quoted(value: str) -> str:
    lines = [text(line) for line in value.split("\n")]
    escaped = (line.replace("\\", "\\\\").replace('"', '\\"') for line in lines)
    return '"' + "\\n".join(escaped) + '"'


def tree_json_text(tree: FrameTree, robot: Robot | None = None) -> str:
    """`tree_json` as text, readable, with a line break at the end."""
    return json.dumps(tree_json(tree, robot), indent=2, ensure_ascii=False) + "\n"

"""The tree of frames as DOT and as JSON, with the labels of its edges.

The form of the graph is view_frames' as of ROS 2, with what that leaves
out: joint name and type, xyz and rpy.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypedDict

from sambot_viz.frames.frame_tree import FrameTree, Hop
from sambot_viz.frames.robot_frames import joint_between
from sambot_viz.robot.model import Robot
from sambot_viz.text import json_text, text

NO_DATA = "No tf data received"
"""The drawing of view_frames without frames."""


class EdgeJson(TypedDict):
    """One transform of the JSON drawing; metres, radians and Hz.

    The rate is that of the messages; None if static, or with fewer than two.
    """

    parent: str
    child: str
    joint: str | None
    type: str | None
    static: bool
    rate: float | None
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
        "transforms": [_edge_json(tree, hop, robot) for hop in _hops(tree)],
    }


def _edge_json(tree: FrameTree, hop: Hop, robot: Robot | None) -> EdgeJson:
    span = _stamp_span(tree, hop)
    joint = joint_between(robot, hop.parent, hop.child)
    return {
        "parent": hop.parent,
        "child": hop.child,
        "joint": joint.name if joint else None,
        "type": joint.type if joint else None,
        "static": hop.static,
        "rate": None if span is None else round(span.rate, 3),
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
        label = _quoted("\n".join((*_pose_lines(hop, robot), *_broadcast(tree, hop))))
        style = "" if hop.static else ", color=blue"
        edge = f"{_quoted(hop.parent)} -> {_quoted(hop.child)}"
        lines.append(f"  {edge} [label={label}{style}];")
    return "\n".join([*lines, "}", ""])


def edge_lines(tree: FrameTree, frame: str, robot: Robot | None) -> tuple[str, ...]:
    """Return the text at the edge above a frame.

    Joint, type, xyz [m] and rpy [rad], and where messages move it their rate [Hz].
    """
    hop = tree.hop(frame)
    span = _stamp_span(tree, hop)
    rate = () if span is None else (f"{span.rate:.1f} Hz",)
    return (*_pose_lines(hop, robot), *rate)


def _pose_lines(hop: Hop, robot: Robot | None) -> tuple[str, ...]:
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


@dataclass(frozen=True, slots=True)
class _StampSpan:
    """The samples that are kept of a moving frame, at least two.

    Attributes:
        count: number of the samples.
        oldest: stamp of the first one [s].
        newest: stamp of the last one [s].
        length: the time between these [s].
    """

    count: int
    oldest: float
    newest: float
    length: float

    @property
    def rate(self) -> float:
        """The average rate [Hz]; view_frames counts one sample more."""
        return (self.count - 1) / self.length


def _stamp_span(tree: FrameTree, hop: Hop) -> _StampSpan | None:
    stamps = () if tree.history is None else tree.history.stamps(hop.child)
    if hop.static or not stamps or stamps[0] == stamps[-1]:
        return None
    oldest, newest = stamps[0], stamps[-1]
    return _StampSpan(
        len(stamps), oldest * 1e-9, newest * 1e-9, (newest - oldest) * 1e-9
    )


def _broadcast(tree: FrameTree, hop: Hop) -> tuple[str, ...]:
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
    if (span := _stamp_span(tree, hop)) is None:
        return ("Broadcaster: default_authority", f"Most recent transform: {hop.stamp}")
    return (
        "Broadcaster: default_authority",
        f"Average rate: {span.rate:.3f}",
        f"Buffer length: {span.length:.3f}",
        f"Most recent transform: {span.newest:.6f}",
        f"Oldest transform: {span.oldest:.6f}",
    )


def _hops(tree: FrameTree) -> Iterator[Hop]:
    for frame in tree.frames:
        if tree.parent(frame) is not None:
            yield tree.hop(frame)


def _numbers(values: list[float] | tuple[float, ...]) -> str:
    # Rounding first and adding 0 prints values near zero as 0, never as -0.
    return " ".join(f"{round(value, 4) + 0.0:g}" for value in values)


def _quoted(value: str) -> str:
    lines = [text(line) for line in value.split("\n")]
    escaped = (line.replace("\\", "\\\\").replace('"', '\\"') for line in lines)
    return '"' + "\\n".join(escaped) + '"'


def tree_json_text(tree: FrameTree, robot: Robot | None = None) -> str:
    """`tree_json` as text, readable, with a line break at the end."""
    return json_text(tree_json(tree, robot), ascii_only=False) + "\n"

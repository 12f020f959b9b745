"""The texts, tooltips and styles of the parts of a graph."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from sambot_viz.errors import hint_sentence
from sambot_viz.graph.node_graph import (
    GraphEdge,
    GraphNode,
    GraphTopic,
    NodeGraph,
    Presence,
)
from sambot_viz.text import text

_LONGEST = 60
_SAID: Mapping[Presence, str] = {
    "expected": "expected, but not running",
    "running": "running, but not expected",
    "both": "expected and running",
}


def is_said(one: GraphNode | GraphTopic | GraphEdge, graph: NodeGraph) -> bool:
    """Return whether it is known that a part runs, or does not."""
    return graph.is_compared and (graph.is_whole or isinstance(one, GraphTopic))


def look_of(
    one: GraphNode | GraphTopic, graph: NodeGraph, unwritten: Collection[str]
) -> Iterator[str]:
    """Yield classes of the style of a part."""
    yield "node" if isinstance(one, GraphNode) else "topic"
    if is_said(one, graph):
        yield one.presence
    if one.problem is not None:
        yield one.problem.severity
    if isinstance(one, GraphNode):
        if not one.is_certain:
            yield "uncertain"
    elif one.name in unwritten:
        yield "unwritten" if graph.is_whole else "uncertain"


def lines_of(one: GraphNode | GraphTopic, details: bool) -> Iterator[str]:
    """Yield the name, and the lines in small letters below it."""
    yield text(one.name, _LONGEST)
    if not details:
        pass
    elif isinstance(one, GraphNode):
        if started := _started(one):
            yield text(started, _LONGEST)
    else:
        for kind in one.types:
            yield text(kind.replace("/msg/", "/"), _LONGEST)
    if one.problem is not None:
        yield f"{one.problem.severity}: {text(one.problem.code, _LONGEST)}"


def _started(node: GraphNode) -> str:
    """Return the package, and the executable where the name does not say it."""
    if node.executable == node.name.rpartition("/")[2]:
        return node.package
    return "/".join(filter(None, (node.package, node.executable)))


def said_of(
    one: GraphNode | GraphTopic, graph: NodeGraph, unwritten: Collection[str]
) -> Iterator[str]:
    """Yield the lines of the tooltip of a part."""
    yield text(one.name)
    yield from (
        _said_of_node(one) if isinstance(one, GraphNode) else map(text, one.types)
    )
    if isinstance(one, GraphTopic) and one.name in unwritten:
        known = "" if graph.is_whole else " that is known"
        yield f"it is read, and no node{known} publishes it"
    if is_said(one, graph):
        yield _SAID[one.presence]
    if one.problem is not None:
        yield text(f"{one.problem.severity}: {one.problem.message}")
        if one.problem.hint:
            yield text(hint_sentence(one.problem.hint))


def _said_of_node(node: GraphNode) -> Iterator[str]:
    for name, value in (("package", node.package), ("executable", node.executable)):
        if value:
            yield text(f"{name} {value}")
    if node.file:
        yield place_of(node.file, node.line)
    if not node.is_certain:
        yield "it may start: that depends on what is not known"


def said_of_edge(edge: GraphEdge, graph: NodeGraph) -> str:
    """Return what an arrow says."""
    does = "publishes" if edge.direction == "publishes" else "subscribes to"
    said = f"{text(edge.node)} {does} {text(edge.topic)}"
    if edge.remapped_from:
        said += f", which it calls {text(edge.remapped_from)}"
    return f"{said}; {_SAID[edge.presence]}" if is_said(edge, graph) else said


def place_of(file: str, line: int | None) -> str:
    """Return a place as every message has it: file, and line where it is known."""
    return text(file) if line is None else f"{text(file)}:{line}"

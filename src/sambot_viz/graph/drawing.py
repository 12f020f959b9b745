"""The graph for programs: Graphviz' language, and JSON."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.errors import Problem
from sambot_viz.graph.labels import is_said
from sambot_viz.graph.node_graph import GraphEdge, GraphNode, GraphTopic, NodeGraph
from sambot_viz.text import json_text, text

_COLOURS = {"expected": "gray60", "running": "orange", "both": "black"}


def graph_json_text(graph: NodeGraph) -> str:
    """Return the graph as JSON, with a line break at the end."""
    unwritten = graph.unwritten()
    value = {
        "nodes": [
            {
                "name": node.name,
                "package": node.package or None,
                "executable": node.executable or None,
                "file": node.file or None,
                "line": node.line,
                "certain": node.is_certain,
                "state": node.presence,
                "problem": _problem_json(node.problem),
            }
            for node in graph.nodes.values()
        ],
        "topics": [
            {
                "name": topic.name,
                "types": list(topic.types),
                "unwritten": topic.name in unwritten,
                "state": topic.presence,
                "problem": _problem_json(topic.problem),
            }
            for topic in graph.topics.values()
        ],
        "edges": [
            {
                "node": edge.node,
                "topic": edge.topic,
                "direction": edge.direction,
                "remapped_from": edge.remapped_from or None,
                "state": edge.presence,
            }
            for edge in graph.edges
        ],
        "whole": graph.is_whole,
        "notes": list(graph.notes),
    }
    return json_text(value, ascii_only=False) + "\n"


def graph_dot(graph: NodeGraph) -> str:
    """Return the graph in Graphviz' language; ``dot -Tpdf`` draws it."""
    lines = ["digraph graph_of_nodes {", "  rankdir=LR;", "  compound=true;"]
    spaces: dict[str, list[GraphNode | GraphTopic]] = {}
    for one in (*graph.nodes.values(), *graph.topics.values()):
        spaces.setdefault(one.name.rpartition("/")[0], []).append(one)
    with_nodes = {name.rpartition("/")[0] for name in graph.nodes}
    for number, (space, parts) in enumerate(sorted(spaces.items())):
        inner = [_vertex(graph, one) for one in parts]
        if space and space in with_nodes:
            lines.append(f"  subgraph cluster_{number} {{")
            lines += [f"    label={_quoted(space)};", *(f"  {one}" for one in inner)]
            lines.append("  }")
        else:
            lines += inner
    lines += [_arrow(graph, edge) for edge in graph.edges]
    lines += [f"  // {text(note)}" for note in graph.notes]
    return "\n".join([*lines, "}", ""])


def _vertex(graph: NodeGraph, one: GraphNode | GraphTopic) -> str:
    is_node = isinstance(one, GraphNode)
    small = (one.package,) if is_node else one.types
    label = _quoted("\n".join(filter(None, (one.name, *small))))
    said = [f"label={label}", f"shape={'ellipse' if is_node else 'box'}"]
    if one.problem is not None:
        said += ["color=red", f"tooltip={_quoted(one.problem.message)}"]
    elif is_said(one, graph):
        said.append(f"color={_COLOURS[one.presence]}")
    if is_said(one, graph) and one.presence == "expected":
        said.append("style=dashed")
    return f"  {_id(one.name, is_node=is_node)} [{', '.join(said)}];"


def _arrow(graph: NodeGraph, edge: GraphEdge) -> str:
    node, topic = _id(edge.node, is_node=True), _id(edge.topic, is_node=False)
    ends = (node, topic) if edge.direction == "publishes" else (topic, node)
    said = list(_arrow_style(graph, edge))
    style = f" [{', '.join(said)}]" if said else ""
    return f"  {' -> '.join(ends)}{style};"


def _arrow_style(graph: NodeGraph, edge: GraphEdge) -> Iterator[str]:
    if edge.remapped_from:
        yield f"label={_quoted(edge.remapped_from)}"
    if is_said(edge, graph):
        yield f"color={_COLOURS[edge.presence]}"


def _problem_json(problem: Problem | None) -> dict[str, object] | None:
    if problem is None:
        return None
    return {
        "severity": problem.severity,
        "code": problem.code,
        "message": problem.message,
        "hint": problem.hint,
    }


def _id(name: str, *, is_node: bool) -> str:
    """Return a key that distinguishes a node from a topic with the same name."""
    return _quoted(f"{'node' if is_node else 'topic'} {name}")


def _quoted(value: str) -> str:
    """Return a text of Graphviz, with its lines."""
    clean = (
        text(line).replace("\\", "\\\\").replace('"', '\\"')
        for line in value.split("\n")
    )
    return '"' + "\\n".join(clean) + '"'

"""The graph of what launch files would start, with what check found in it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from sambot_viz.checks.around.running import Endpoint, RunningNode, RunningSystem
from sambot_viz.errors import Place, Problem
from sambot_viz.graph.labels import place_of
from sambot_viz.graph.node_graph import (
    GraphEdge,
    GraphNode,
    GraphTopic,
    NodeGraph,
    node_graph,
)

_NOTES = 3


def expected_graph(
    system: RunningSystem, problems: Iterable[Problem] = ()
) -> NodeGraph:
    """Return the nodes that start, or may, and their topics.

    Args:
        system: what launch files start.
        problems: findings of check; each is at the topic that it names, at the line
            of one of its ends, or at the node that its line starts.
    """
    ends = [
        (node, end)
        for node in system.started
        for end in node.endpoints
        if not end.in_gazebo
    ]
    of_topics = _by_topic(ends, problems := tuple(problems))
    claimed = {id(found) for found in of_topics.values()}
    others = [found for found in problems if id(found) not in claimed]
    at_nodes = _by_node(system.started, others)
    kinds: dict[str, dict[str, None]] = {}
    for _, end in ends:
        kinds.setdefault(end.topic, {}).update({end.kind: None} if end.kind else {})
    known = all(node.endpoints_known for node in system.started)
    return node_graph(
        # Of those with one name that is drawn which surely starts.
        [
            _node(node, at_nodes)
            for node in sorted(system.started, key=lambda one: one.starts == "yes")
        ],
        [
            GraphTopic(name, types=tuple(types), problem=of_topics.get(name))
            for name, types in kinds.items()
        ],
        [_edge(node, end) for node, end in ends],
        _notes(system),
        is_whole=system.is_whole and known,
    )


def _node(node: RunningNode, problems: Mapping[Place, Problem]) -> GraphNode:
    place = node.place
    return GraphNode(
        node.path,
        package=node.package,
        executable=node.executable,
        file=place.file,
        line=place.line,
        is_certain=node.starts == "yes",
        problem=problems.get(place),
    )


def _by_node(
    nodes: Iterable[RunningNode], problems: Iterable[Problem]
) -> dict[Place, Problem]:
    """Return the first finding of each node, by where it starts.

    It is at that line, or below it, before the next node, and names the node.
    """
    nodes = list(nodes)
    found: dict[Place, Problem] = {}
    for problem in problems:
        above = [
            (node.place.line, node)
            for node in nodes
            if node.place.file == problem.file
            and (node.place.line or 0) <= (problem.line or 0)
        ]
        last = max((line or 0 for line, _ in above), default=0)
        for line, node in above:
            names = (node.executable, node.name, node.package)
            is_named = any(_names(problem.message, name) for name in names if name)
            if line == last and (line == problem.line or is_named):
                found.setdefault(node.place, problem)
    return found


def _edge(node: RunningNode, end: Endpoint) -> GraphEdge:
    called = {name.strip("~/") for name, _ in node.remappings}
    is_remapped = end.written.strip("~/") in called
    return GraphEdge(
        node.path,
        end.topic,
        "publishes" if end.publishes else "subscribes",
        remapped_from=end.written if is_remapped else "",
    )


def _by_topic(
    ends: Iterable[tuple[RunningNode, Endpoint]], problems: Iterable[Problem]
) -> dict[str, Problem]:
    """Return the first finding of each topic, by the lines and names of its ends."""
    ends = list(ends)
    found: dict[str, Problem] = {}
    for problem in problems:
        at = [
            end
            for node, end in ends
            if (end.place.file, end.place.line) == (problem.file, problem.line)
            and end.place != node.place
        ]
        said = problem.message
        both = {e.topic for e in at if _names(said, e.topic) or _names(said, e.written)}
        named = {end.topic for _, end in ends if _names(said, end.topic)}
        for topic in both or named or {end.topic for end in at}:
            found.setdefault(topic, problem)
    return found


def _names(sentence: str, name: str) -> bool:
    """Return whether a sentence has a name in it, as a whole."""
    return re.search(rf"(?<![\w/]){re.escape(name)}(?![\w/])", sentence) is not None


def _notes(system: RunningSystem) -> Iterator[str]:
    for unknown in system.unknown[:_NOTES]:
        where = place_of(unknown.place.file or "", unknown.place.line)
        yield f"more may start: {unknown.what} ({where})"
    if more := len(system.unknown) - _NOTES:
        if more > 0:
            yield f"and at {more} other places"
    by_name: dict[str, int] = {}
    for node in system.started:
        # Gazebo, which is not a node, may be started in several steps.
        if node.starts == "yes" and node.endpoints:
            by_name[node.path] = by_name.get(node.path, 0) + 1
    for name, count in by_name.items():
        if count > 1:
            yield f"{name} is started {count} times, and drawn once"

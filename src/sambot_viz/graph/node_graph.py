"""Nodes, topics, and who publishes and reads what."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from sambot_viz.errors import Problem

Presence = Literal["expected", "running", "both"]
"""Where a part is known from: the launch files, the robot, or both."""
Direction = Literal["publishes", "subscribes"]
_HIDDEN_TOPICS = ("/rosout", "/rosout_agg", "/parameter_events", "/statistics")
_HIDDEN_NODES = ("_", "transform_listener_impl_", "launch_ros_")
"""Begins of the last part of names that every program of ROS has beside its own."""
_NO_NODES = ("create", "spawn", "gz", "gazebo")
"""Begins of executables that put something somewhere and end, or are Gazebo itself."""


@dataclass(frozen=True, slots=True)
class GraphNode:
    """A node.

    Attributes:
        name: name with its namespace, such as /front/scanner.
        presence: whether it is expected, running, or both.
        package: the package of its executable; "" if unknown.
        executable: the executable that starts it, or its plugin; "" if unknown.
        file: the launch file that starts it; "" if unknown.
        line: the line in that file, from 1.
        is_certain: whether it certainly starts; False if a condition is unknown.
        problem: the finding of check about it.
    """

    name: str
    presence: Presence = "expected"
    package: str = ""
    executable: str = ""
    file: str = ""
    line: int | None = None
    is_certain: bool = True
    problem: Problem | None = None


@dataclass(frozen=True, slots=True)
class GraphTopic:
    """A topic.

    Attributes:
        name: name with its namespace.
        presence: whether it is expected, running, or both.
        types: types of its messages; several if its ends differ.
        problem: the finding of check about it.
    """

    name: str
    presence: Presence = "expected"
    types: tuple[str, ...] = ()
    problem: Problem | None = None


@dataclass(frozen=True, slots=True)
class GraphEdge:
    """An end of a topic at a node.

    Attributes:
        node: name of the node.
        topic: name of the topic.
        direction: whether the node publishes it or subscribes to it.
        presence: whether it is expected, running, or both.
        remapped_from: what the node itself calls the topic, where that differs.
    """

    node: str
    topic: str
    direction: Direction
    presence: Presence = "expected"
    remapped_from: str = ""

    @property
    def key(self) -> tuple[str, str, Direction]:
        """Return what two edges have in common that mean the same."""
        return self.node, self.topic, self.direction


@dataclass(frozen=True, slots=True)
class NodeGraph:
    """Nodes and topics by name, and the edges between them.

    Attributes:
        nodes: name → node.
        topics: name → topic.
        edges: the edges in the order in which they were found, each once.
        is_compared: whether it contains both expected and running nodes.
        is_whole: whether it is complete.
        notes: what is left out or unknown; sentences without a full stop.
    """

    nodes: Mapping[str, GraphNode] = field(default_factory=dict[str, GraphNode])
    topics: Mapping[str, GraphTopic] = field(default_factory=dict[str, GraphTopic])
    edges: tuple[GraphEdge, ...] = ()
    is_compared: bool = False
    is_whole: bool = True
    notes: tuple[str, ...] = ()

    def unwritten(self) -> frozenset[str]:
        """Return the topics that nodes read and none publishes."""
        ends = {
            way: {edge.topic for edge in self.edges if edge.direction == way}
            for way in ("publishes", "subscribes")
        }
        return frozenset(ends["subscribes"] - ends["publishes"])

    def without_hidden(self) -> NodeGraph:
        """Leave out what every program has, as rqt_graph does: logs and parameters."""
        nodes = {n: node for n, node in self.nodes.items() if not _is_hidden_node(n)}
        topics = {t: one for t, one in self.topics.items() if not _is_hidden_topic(t)}
        edges = [e for e in self.edges if e.node in nodes and e.topic in topics]
        return replace(self, nodes=nodes, topics=topics, edges=tuple(edges))

    def without_leaves(self) -> NodeGraph:
        """Leave out topics with one node, as rqt_graph does, if nothing is amiss.

        What has a finding, is read without a publisher, or is not there as its node
        is, stays.
        """
        ends: dict[str, list[GraphEdge]] = {}
        for edge in self.edges:
            ends.setdefault(edge.topic, []).append(edge)
        said = self.unwritten() if self.is_whole else frozenset[str]()
        leaves = {
            name
            for name, of in ends.items()
            if len(of) == 1
            and name not in said
            and self.topics[name].problem is None
            and self.topics[name].presence == self.nodes[of[0].node].presence
        }
        topics = {t: one for t, one in self.topics.items() if t not in leaves}
        edges = tuple(edge for edge in self.edges if edge.topic in topics)
        return replace(self, topics=topics, edges=edges)


def compared(expected: NodeGraph, running: NodeGraph) -> NodeGraph:
    """Join what launch files would start with what runs, by the names of both.

    What does not run is left out where it need not: its start is not certain, or it is
    no node that goes on. Without a word about nodes, only topics are compared.
    """
    absent: list[str] = []
    if running.is_whole:
        absent, expected = _without_absent(expected, running)
    nodes = {n: replace(one, presence="running") for n, one in running.nodes.items()}
    for name, node in expected.nodes.items():
        nodes[name] = replace(node, presence=_presence(name in running.nodes))
    topics = {t: replace(one, presence="running") for t, one in running.topics.items()}
    for name, topic in expected.topics.items():
        runs = running.topics.get(name)
        types = topic.types if runs is None else runs.types or topic.types
        presence = _presence(runs is not None)
        topics[name] = replace(topic, presence=presence, types=types)
    there = {edge.key for edge in running.edges}
    edges = {edge.key: replace(edge, presence="running") for edge in running.edges}
    for edge in expected.edges:
        edges[edge.key] = replace(edge, presence=_presence(edge.key in there))
    notes = [*expected.notes, *running.notes]
    if absent:
        notes.append(f"may run, and does not: {', '.join(absent)}")
    return NodeGraph(
        nodes, topics, tuple(edges.values()), True, running.is_whole, tuple(notes)
    )


def _without_absent(
    expected: NodeGraph, running: NodeGraph
) -> tuple[list[str], NodeGraph]:
    """Return the nodes that do not run and need not, and the graph without them."""
    absent = [
        name
        for name, node in expected.nodes.items()
        if name not in running.nodes
        and (not node.is_certain or node.executable.startswith(_NO_NODES))
    ]
    nodes = {n: one for n, one in expected.nodes.items() if n not in absent}
    edges = tuple(edge for edge in expected.edges if edge.node in nodes)
    used = {edge.topic for edge in edges}
    topics = {t: one for t, one in expected.topics.items() if t in used}
    return absent, replace(expected, nodes=nodes, topics=topics, edges=edges)


def _presence(runs: bool) -> Presence:
    return "both" if runs else "expected"


def node_graph(
    nodes: Iterable[GraphNode],
    topics: Iterable[GraphTopic],
    edges: Iterable[GraphEdge],
    notes: Iterable[str] = (),
    *,
    is_whole: bool = True,
) -> NodeGraph:
    """Return a graph in which everything has a name once, in the order of names.

    Nodes and topics that only edges name are added.
    """
    kept = {edge.key: edge for edge in edges}
    ends = list(kept.values())
    all_nodes = {e.node: GraphNode(e.node, e.presence) for e in ends}
    all_topics = {e.topic: GraphTopic(e.topic, e.presence) for e in ends}
    all_nodes.update((node.name, node) for node in nodes)
    all_topics.update((topic.name, topic) for topic in topics)
    return NodeGraph(
        dict(sorted(all_nodes.items())),
        dict(sorted(all_topics.items())),
        tuple(kept[key] for key in sorted(kept)),
        is_whole=is_whole,
        notes=tuple(notes),
    )


def _is_hidden_topic(name: str) -> bool:
    # As `ros2 topic list` hides them: those of actions are among these.
    return name in _HIDDEN_TOPICS or "/_" in name


def _is_hidden_node(name: str) -> bool:
    return name.rpartition("/")[2].startswith(_HIDDEN_NODES)

"""A graph with the place of each box and arrow, for pictures and for the page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice, pairwise
from typing import Literal

from sambot_viz import limits
from sambot_viz.errors import Problem
from sambot_viz.graph.labels import is_said, lines_of, look_of, said_of, said_of_edge
from sambot_viz.graph.layered import Arc, LaidOut, Point, Vertex, layered
from sambot_viz.graph.node_graph import (
    GraphEdge,
    GraphNode,
    GraphTopic,
    NodeGraph,
)
from sambot_viz.graph.shelves import shelves
from sambot_viz.text import columns, text

MARGIN = 36.0
LINE, SMALL_LINE = 16.0, 13.0
_CHARACTER, _SMALL_CHARACTER = 7.4, 6.5
_SPACE = 14.0
_SINGLE_GAP, _SINGLE_WIDTH = 48.0, 600.0
"""Above parts that nothing leads to, and the least width of their rows [px]."""
Kind = Literal["node", "topic"]


@dataclass(frozen=True, slots=True)
class PlacedPart:
    """A node or a topic in the picture.

    Attributes:
        kind: node or topic.
        name: name of the node or the topic.
        x: x of the centre [px].
        y: y of the centre [px].
        width: width of the ellipse or the box [px].
        height: height of it [px].
        lines: the name, and further lines in small letters.
        look: classes of its style.
        said: its tooltip.
        file: the file that starts it; "" without one.
        line: the line in that file, from 1.
        problem: the finding about it.
    """

    kind: Kind
    name: str
    x: float
    y: float
    width: float
    height: float
    lines: tuple[str, ...]
    look: tuple[str, ...]
    said: str
    file: str = ""
    line: int | None = None
    problem: Problem | None = None


@dataclass(frozen=True, slots=True)
class PlacedEdge:
    """An arrow: its path as SVG writes it, classes of its style, and what it says."""

    path: str
    look: tuple[str, ...]
    said: str


@dataclass(frozen=True, slots=True)
class PlacedSpace:
    """The box around a namespace: its name, corner and size [px]."""

    name: str
    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True, slots=True)
class PlacedGraph:
    """A picture of a graph.

    Attributes:
        parts: nodes and topics.
        edges: from publishers to topics, and from these to who reads them.
        spaces: the namespaces that have nodes.
        width: of the picture [px].
        height: of the picture, without notes [px].
        notes: lines to be written below it.
    """

    parts: tuple[PlacedPart, ...]
    edges: tuple[PlacedEdge, ...]
    spaces: tuple[PlacedSpace, ...]
    width: float
    height: float
    notes: tuple[str, ...]


def place_graph(graph: NodeGraph, details: bool = True) -> PlacedGraph:
    """Lay a graph out from left to right, with a box around each namespace.

    Args:
        graph: nodes and topics.
        details: draw types and packages, and topics that one node has alone.
    """
    shown = graph if details else graph.without_leaves()
    return _PlacesOfGraph(shown, details).placed()


class _PlacesOfGraph:
    def __init__(self, graph: NodeGraph, details: bool) -> None:
        most = limits.GRAPH_PARTS.value
        every = [*graph.nodes.values(), *graph.topics.values()]
        self._graph = graph
        self._unwritten = graph.unwritten()
        used = {n for e in graph.edges for n in (("node", e.node), ("topic", e.topic))}
        drawn: list[GraphNode | GraphTopic] = every[:most]
        # Those of a namespace are in its box.
        inner = [one for one in drawn if _space(one.name) or _key(one) in used]
        self._drawn = [*inner, *(one for one in drawn if one not in inner)]
        self._single = len(inner)
        self._numbers = {_key(one): i for i, one in enumerate(self._drawn)}
        ends = (
            edge
            for edge in graph.edges
            if ("node", edge.node) in self._numbers
            and ("topic", edge.topic) in self._numbers
        )
        self._edges = list(islice(ends, limits.GRAPH_EDGES.value))
        # What runs is drawn over what does not, where both are on one way.
        self._edges.sort(key=lambda edge: edge.presence != "expected")
        self._lines = [tuple(lines_of(one, details)) for one in self._drawn]
        self._lanes = _lanes(self._drawn)
        self._left_out = (
            len(every) - len(self._drawn),
            len(graph.edges) - len(self._edges),
        )

    def placed(self) -> PlacedGraph:
        vertices = [
            Vertex(*_size(one, lines), self._lanes.get(_space(one.name), 0))
            for one, lines in zip(self._drawn, self._lines, strict=True)
        ]
        layout = layered(vertices[: self._single], [*map(self._arc, self._edges)])
        centres = [*layout.centres, *self._shelved(vertices, layout)]
        parts = tuple(
            self._part(one, lines, vertex, centre)
            for one, lines, vertex, centre in zip(
                self._drawn, self._lines, vertices, centres, strict=True
            )
        )
        edges = tuple(
            self._placed_edge(edge, path)
            for edge, path in zip(self._edges, layout.paths, strict=True)
        )
        spaces = tuple(self._spaces(parts))
        right = max((part.x + part.width / 2 for part in parts), default=MARGIN)
        bottom = max((part.y + part.height / 2 for part in parts), default=MARGIN)
        return PlacedGraph(
            parts, edges, spaces, right + MARGIN, bottom + MARGIN, self._notes()
        )

    def _shelved(self, vertices: Sequence[Vertex], layout: LaidOut) -> Iterator[Point]:
        """Yield the centres of what nothing leads to: in rows below the rest."""
        top = layout.height + _SINGLE_GAP if self._single else 0.0
        width = max(layout.width, _SINGLE_WIDTH)
        for x, y in shelves(vertices[self._single :], width):
            yield x, top + y

    def _arc(self, edge: GraphEdge) -> Arc:
        node = self._numbers["node", edge.node]
        topic = self._numbers["topic", edge.topic]
        ends = (node, topic) if edge.direction == "publishes" else (topic, node)
        # All that publish a topic meet on the way, and so do all that read it.
        return Arc(*ends, (topic, edge.direction))

    def _part(
        self,
        one: GraphNode | GraphTopic,
        lines: tuple[str, ...],
        vertex: Vertex,
        centre: Point,
    ) -> PlacedPart:
        is_node = isinstance(one, GraphNode)
        return PlacedPart(
            "node" if is_node else "topic",
            one.name,
            MARGIN + centre[0],
            MARGIN + centre[1],
            vertex.width,
            vertex.height,
            lines,
            tuple(look_of(one, self._graph, self._unwritten)),
            "\n".join(said_of(one, self._graph, self._unwritten)),
            one.file if is_node else "",
            one.line if is_node else None,
            one.problem,
        )

    def _placed_edge(self, edge: GraphEdge, path: Sequence[Point]) -> PlacedEdge:
        look = (edge.direction,)
        if is_said(edge, self._graph):
            look = (edge.direction, edge.presence)
        said = said_of_edge(edge, self._graph)
        return PlacedEdge(_curve(path), look, said)

    def _spaces(self, parts: Sequence[PlacedPart]) -> Iterator[PlacedSpace]:
        for name in self._lanes:
            of = [part for part in parts if _space(part.name) == name]
            left = min(part.x - part.width / 2 for part in of) - _SPACE
            right = max(part.x + part.width / 2 for part in of) + _SPACE
            top = min(part.y - part.height / 2 for part in of) - _SPACE - LINE
            bottom = max(part.y + part.height / 2 for part in of) + _SPACE
            yield PlacedSpace(f"/{name}", left, top, right - left, bottom - top)

    def _notes(self) -> tuple[str, ...]:
        parts, edges = self._left_out
        said = list(self._graph.notes)
        most, arrows = limits.GRAPH_PARTS.value, limits.GRAPH_EDGES.value
        if parts:
            said.append(
                f"{parts:,} more nodes and topics; the first {most:,} are drawn"
            )
        if edges:
            said.append(f"{edges:,} arrows are not drawn; the limit is {arrows:,}")
        return tuple(text(note) for note in said)


def _key(one: GraphNode | GraphTopic) -> tuple[Kind, str]:
    return ("node" if isinstance(one, GraphNode) else "topic"), one.name


def _space(name: str) -> str:
    """Return the first part of the namespace of a name; "" at the top."""
    first, slash, _ = name.removeprefix("/").partition("/")
    return first if slash else ""


def _lanes(drawn: Sequence[GraphNode | GraphTopic]) -> dict[str, int]:
    """Return a lane for each namespace that has a node, from 1."""
    spaces = {_space(one.name) for one in drawn if isinstance(one, GraphNode)}
    return {name: i for i, name in enumerate(sorted(spaces - {""}), start=1)}


def _size(one: GraphNode | GraphTopic, lines: Sequence[str]) -> tuple[float, float]:
    width = max(
        columns(line) * (_SMALL_CHARACTER if i else _CHARACTER)
        for i, line in enumerate(lines)
    )
    height = LINE + SMALL_LINE * (len(lines) - 1)
    # The corners of the text are within an ellipse that is so much larger.
    if isinstance(one, GraphNode):
        return width * 1.2 + 22, height * 1.45 + 12
    return width + 18, height + 12


def _curve(path: Sequence[Point]) -> str:
    """Return the path of an arrow: straight across columns, bent between them."""
    points = [(x + MARGIN, y + MARGIN) for x, y in path]
    said = f"M{_pair(points[0])}"
    for i, (one, other) in enumerate(pairwise(points)):
        if i % 2:
            middle = (one[0] + other[0]) / 2
            bends = f"{_pair((middle, one[1]))} {_pair((middle, other[1]))}"
            said += f"C{bends} {_pair(other)}"
        elif abs(one[0] - other[0]) > 0.05:
            said += f"L{_pair(other)}"
    return said


def _pair(point: Point) -> str:
    return f"{point[0]:.1f} {point[1]:.1f}"

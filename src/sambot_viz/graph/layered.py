"""A layered layout from left to right: columns, few crossings, no overlaps.

The steps are Sugiyama's: rings are opened by reversing few edges (Eades, Lin and
Smyth), each vertex is in a column after its predecessors, long edges cross columns at
extra points, columns are sorted by the means of their neighbours, and heights are the
nearest ones to these means that keep order and distance.
"""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from itertools import pairwise

Point = tuple[float, float]
_ROW_GAP = 14.0
_LANE_GAP = 64.0
_COLUMN_GAP = 56.0
_SWEEPS = 12


@dataclass(frozen=True, slots=True)
class Vertex:
    """A vertex to place.

    Attributes:
        width: width of its box.
        height: height of its box.
        lane: vertices of one lane are in a stripe without others; 0 is the first.
    """

    width: float
    height: float
    lane: int = 0


@dataclass(frozen=True, slots=True)
class Arc:
    """An edge, by the numbers of its vertices.

    Attributes:
        source: where it begins.
        target: where it ends.
        bus: arcs of one bus pass columns at the same points.
    """

    source: int
    target: int
    bus: Hashable


@dataclass(frozen=True, slots=True)
class LaidOut:
    """Where everything is.

    Attributes:
        centres: of the boxes, by the number of the vertex.
        paths: of each arc, from its source to its target.
        width: of all.
        height: of all.
    """

    centres: Sequence[Point]
    paths: Sequence[Sequence[Point]]
    width: float
    height: float


def layered(vertices: Sequence[Vertex], arcs: Sequence[Arc]) -> LaidOut:
    """Place boxes in columns, with arcs from left to right where no ring forbids it."""
    columns = _Columns(vertices, arcs)
    columns.sort()
    return columns.place()


class _Columns:
    def __init__(self, vertices: Sequence[Vertex], arcs: Sequence[Arc]) -> None:
        self._vertices = list(vertices)
        self._arcs = arcs
        self._count = len(vertices)
        rank = _open_rings(self._count, arcs)
        self._turned = [rank[a.source] > rank[a.target] for a in arcs]
        self._column = _depths(self._count, rank, self._forward())
        self._chains = self._chained()
        size = len(self._vertices)
        self._before = [list[int]() for _ in range(size)]
        self._after = [list[int]() for _ in range(size)]
        for a, b in {p for c in self._chains for p in pairwise(c)}:
            self._after[a].append(b)
            self._before[b].append(a)
        self._layers = [list[int]() for _ in range(max(self._column, default=-1) + 1)]
        for vertex, column in enumerate(self._column):
            self._layers[column].append(vertex)

    def _forward(self) -> list[tuple[int, int]]:
        return [
            (a.target, a.source) if turned else (a.source, a.target)
            for a, turned in zip(self._arcs, self._turned, strict=True)
        ]

    def _chained(self) -> list[list[int]]:
        """Return each arc as vertices of neighbouring columns, with points between."""
        known: dict[Hashable, int] = {}
        chains: list[list[int]] = []
        forward = self._forward()
        for arc, turned, (first, last) in zip(
            self._arcs, self._turned, forward, strict=True
        ):
            ends = self._vertices[first], self._vertices[last]
            lane = ends[0].lane if ends[0].lane == ends[1].lane else 0
            chain = [first]
            for column in range(self._column[first] + 1, self._column[last]):
                key = (arc.bus, turned, column)
                if key not in known:
                    known[key] = len(self._vertices)
                    self._vertices.append(Vertex(0.0, 2.0, lane))
                    self._column.append(column)
                chain.append(known[key])
            chains.append([*chain, last])
        return chains

    def sort(self) -> None:
        """Sort the columns so that few arcs cross."""
        place = [0] * len(self._vertices)
        for layer in self._layers:
            layer.sort(key=lambda v: self._vertices[v].lane)
            _note_places(layer, place)
        best, fewest = [list(layer) for layer in self._layers], self._crossings()
        for sweep in range(_SWEEPS):
            is_down = sweep % 2 == 0
            near = self._before if is_down else self._after
            for layer in self._layers if is_down else reversed(self._layers):
                self._sort_layer(layer, near, place)
            count = self._crossings()
            if count < fewest:
                best, fewest = [list(layer) for layer in self._layers], count
        self._layers = best

    def _sort_layer(
        self, layer: list[int], near: Sequence[Sequence[int]], place: list[int]
    ) -> None:
        mean = {v: _mean([place[n] for n in near[v]], place[v]) for v in layer}
        layer.sort(key=lambda v: (self._vertices[v].lane, mean[v]))
        _note_places(layer, place)

    def _crossings(self) -> int:
        count = 0
        for left, right in pairwise(self._layers):
            place = {v: i for i, v in enumerate(right)}
            passed: list[int] = []
            for vertex in left:
                ends = sorted(place[n] for n in self._after[vertex])
                count += sum(len(passed) - bisect_left(passed, e + 1) for e in ends)
                for end in ends:
                    insort(passed, end)
        return count

    def place(self) -> LaidOut:
        """Give everything its place, lane below lane."""
        heights = [0.0] * len(self._vertices)
        top = 0.0
        for lane in sorted({v.lane for v in self._vertices}):
            top = self._place_lane(lane, top, heights) + _LANE_GAP
        lefts, widths, x = list[float](), list[float](), 0.0
        for layer in self._layers:
            widths.append(max(self._vertices[v].width for v in layer))
            lefts.append(x)
            # Many arcs need room to bend.
            arcs = sum(len(self._after[v]) for v in layer)
            x += widths[-1] + _COLUMN_GAP + min(2.5 * arcs, 80.0)
        width = lefts[-1] + widths[-1] if lefts else 0.0
        middle = [x + w / 2 for x, w in zip(lefts, widths, strict=True)]
        centres = [(middle[self._column[v]], heights[v]) for v in range(self._count)]
        spans = [(x, x + w) for x, w in zip(lefts, widths, strict=True)]
        paths = [
            self._path(chain, heights, centres, spans, turned)
            for chain, turned in zip(self._chains, self._turned, strict=True)
        ]
        return LaidOut(centres, paths, width, max(top - _LANE_GAP, 0.0))

    def _place_lane(self, lane: int, top: float, heights: list[float]) -> float:
        """Give the vertices of a lane their heights, and return its lower end."""
        of = self._vertices
        layers = [[v for v in one if of[v].lane == lane] for one in self._layers]
        for layer in layers:
            y = 0.0
            for v in layer:
                heights[v] = y + of[v].height / 2
                y += of[v].height + _ROW_GAP
        for sweep in range(_SWEEPS):
            for layer in layers if sweep % 2 == 0 else reversed(layers):
                self._near_means(layer, heights)
        placed = [v for layer in layers for v in layer]
        first = min(heights[v] - of[v].height / 2 for v in placed)
        for v in placed:
            heights[v] += top - first
        return max(heights[v] + of[v].height / 2 for v in placed)

    def _near_means(self, layer: Sequence[int], heights: list[float]) -> None:
        """Put a column as near to its neighbours as order and distances allow."""
        offsets, y = list[float](), 0.0
        for v in layer:
            offsets.append(y + self._vertices[v].height / 2)
            y += self._vertices[v].height + _ROW_GAP
        lane = self._vertices[layer[0]].lane if layer else 0
        free: list[float] = []
        for v, offset in zip(layer, offsets, strict=True):
            near = [
                heights[n]
                for n in (*self._before[v], *self._after[v])
                if self._vertices[n].lane == lane
            ]
            # What has no neighbour stays at the one above it.
            alone = free[-1] if free else heights[v] - offset
            free.append(_mean(near, alone + offset) - offset)
        for v, base, offset in zip(layer, _rising(free), offsets, strict=True):
            heights[v] = base + offset

    def _path(
        self,
        chain: Sequence[int],
        heights: Sequence[float],
        centres: Sequence[Point],
        spans: Sequence[Point],
        turned: bool,
    ) -> list[Point]:
        first, last = chain[0], chain[-1]
        path = [(centres[first][0] + self._vertices[first].width / 2, heights[first])]
        path.append((spans[self._column[first]][1], heights[first]))
        for v in chain[1:-1]:
            path += [(x, heights[v]) for x in spans[self._column[v]]]
        path.append((spans[self._column[last]][0], heights[last]))
        path.append((centres[last][0] - self._vertices[last].width / 2, heights[last]))
        return path[::-1] if turned else path


def _note_places(layer: Sequence[int], place: list[int]) -> None:
    for i, v in enumerate(layer):
        place[v] = i


def _mean(values: Sequence[float], otherwise: float) -> float:
    return sum(values) / len(values) if values else otherwise


def _open_rings(count: int, arcs: Sequence[Arc]) -> list[int]:
    """Return a rank for each vertex such that few arcs lead to a lower one."""
    after = [{a.target for a in arcs if a.source == v} for v in range(count)]
    before = [{a.source for a in arcs if a.target == v} for v in range(count)]
    left, right, waiting = list[int](), list[int](), set(range(count))
    while waiting:
        sink = next((v for v in sorted(waiting) if not after[v] & waiting), None)
        source = next((v for v in sorted(waiting) if not before[v] & waiting), None)
        if sink is not None:
            right.append(sink)
            waiting.remove(sink)
        elif source is not None:
            left.append(source)
            waiting.remove(source)
        else:
            chosen = max(
                sorted(waiting),
                key=lambda v: len(after[v] & waiting) - len(before[v] & waiting),
            )
            left.append(chosen)
            waiting.remove(chosen)
    rank = [0] * count
    for place, v in enumerate([*left, *reversed(right)]):
        rank[v] = place
    return rank


def _depths(
    count: int, rank: Sequence[int], forward: Sequence[tuple[int, int]]
) -> list[int]:
    """Return the column of each vertex: after its predecessors, near its successors."""
    depth, order = [0] * count, sorted(range(count), key=rank.__getitem__)
    before, after = [list[int]() for _ in rank], [list[int]() for _ in rank]
    for first, last in forward:
        after[first].append(last)
        before[last].append(first)
    for v in order:
        depth[v] = max((depth[p] + 1 for p in before[v]), default=0)
    for v in reversed(order):
        # What gets less than it gives goes to those that take it.
        if after[v] and len(before[v]) < len(after[v]):
            depth[v] = min(depth[n] for n in after[v]) - 1
    return depth


def _rising(values: Sequence[float]) -> list[float]:
    """Return the rising numbers that are nearest to others, by least squares."""
    blocks: list[tuple[float, int]] = []
    for value in values:
        blocks.append((value, 1))
        while len(blocks) > 1 and blocks[-2][0] > blocks[-1][0]:
            (b, m), (a, n) = blocks.pop(), blocks.pop()
            blocks.append(((a * n + b * m) / (n + m), n + m))
    return [mean for mean, length in blocks for _ in range(length)]

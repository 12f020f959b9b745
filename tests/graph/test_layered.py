"""Boxes in columns: nothing overlaps, arcs go right, and it is the same each time."""

from __future__ import annotations

import random
from itertools import combinations, pairwise

import pytest

from sambot_viz.graph.layered import Arc, LaidOut, Vertex, layered


def arcs_of(pairs: list[tuple[int, int]]) -> list[Arc]:
    return [Arc(one, other, (one, other)) for one, other in pairs]


def random_graph(seed: int) -> tuple[list[Vertex], list[Arc]]:
    chance = random.Random(seed)
    count = chance.randint(1, 40)
    vertices = [
        Vertex(chance.uniform(20, 200), chance.uniform(20, 60), chance.randint(0, 2))
        for _ in range(count)
    ]
    ends = [
        (chance.randrange(count), chance.randrange(count)) for _ in range(count * 2)
    ]
    return vertices, arcs_of([(a, b) for a, b in ends if a != b])


def overlaps(layout: LaidOut, vertices: list[Vertex]) -> list[tuple[int, int]]:
    boxes = list(zip(layout.centres, vertices, strict=True))
    return [
        (i, j)
        for (i, ((x, y), one)), (j, ((u, v), other)) in combinations(
            enumerate(boxes), 2
        )
        if abs(x - u) < (one.width + other.width) / 2
        and abs(y - v) < (one.height + other.height) / 2
    ]


@pytest.mark.parametrize("seed", range(20))
def test_boxes_of_any_graph_do_not_overlap_and_are_in_the_picture(seed: int) -> None:
    vertices, arcs = random_graph(seed)
    layout = layered(vertices, arcs)
    assert overlaps(layout, vertices) == []
    for (x, y), one in zip(layout.centres, vertices, strict=True):
        assert -0.1 <= x - one.width / 2 <= x + one.width / 2 <= layout.width + 0.1
        assert -0.1 <= y - one.height / 2 <= y + one.height / 2 <= layout.height + 0.1
    assert layered(vertices, arcs) == layout


@pytest.mark.parametrize("seed", range(20))
def test_lanes_of_any_graph_are_stripes(seed: int) -> None:
    vertices, arcs = random_graph(seed)
    layout = layered(vertices, arcs)
    spans: dict[int, list[float]] = {}
    for (_, y), one in zip(layout.centres, vertices, strict=True):
        ends = [y - one.height / 2, y + one.height / 2]
        spans.setdefault(one.lane, []).extend(ends)
    for upper, lower in pairwise(sorted(spans)):
        assert max(spans[upper]) < min(spans[lower])


def test_arcs_lead_to_the_right_and_begin_and_end_at_their_boxes() -> None:
    vertices = [Vertex(40, 20)] * 4
    layout = layered(vertices, arcs_of([(0, 1), (1, 2), (0, 2), (3, 2)]))
    for (source, target), path in zip(
        [(0, 1), (1, 2), (0, 2), (3, 2)], layout.paths, strict=True
    ):
        (x, y), (u, v) = layout.centres[source], layout.centres[target]
        assert (path[0], path[-1]) == ((x + 20, y), (u - 20, v))
        assert all(one[0] <= other[0] for one, other in pairwise(path))
    # What only gives is beside what takes it, not at the far left.
    assert layout.centres[3][0] == layout.centres[1][0]


def test_of_a_ring_one_arc_leads_back() -> None:
    pairs = [(0, 1), (1, 2), (2, 3), (3, 0)]
    layout = layered([Vertex(40, 20)] * 4, arcs_of(pairs))
    back = [path for path in layout.paths if path[0][0] > path[-1][0]]
    assert len(back) == 1


def test_columns_are_sorted_so_that_arcs_need_not_cross() -> None:
    # Straight lines, given in the wrong order.
    pairs = [(0, 7), (1, 6), (2, 5), (3, 4)]
    layout = layered([Vertex(40, 20)] * 8, arcs_of(pairs))
    assert all(path[0][1] == path[-1][1] for path in layout.paths)


def test_arcs_of_one_bus_pass_columns_together() -> None:
    pairs = [(0, 1), (1, 2), (0, 3), (2, 3), (0, 4), (2, 4)]
    arcs = [Arc(a, b, a) for a, b in pairs]
    layout = layered([Vertex(40, 20)] * 5, arcs)
    to_3, to_4 = layout.paths[2], layout.paths[4]
    assert len(to_3) > 4
    assert to_3[:-2] == to_4[:-2]


def test_nothing_has_no_size() -> None:
    assert layered([], []) == LaidOut([], [], 0.0, 0.0)

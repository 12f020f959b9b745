"""The positions of boxes in a drawing of a tree: a tidy tree from top to bottom.

Children are side by side under the middle of their parent, as near to each other as
the widths of whole subtrees allow; no two boxes of one depth overlap.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class BoxPlace:
    """The position of a node: the middle of its box, and its depth from 0."""

    x: float
    depth: int


@dataclass
class _Subtree:
    """A placed subtree, relative to its root at 0.

    Attributes:
        left: for each depth the leftmost edge.
        right: for each depth the rightmost edge.
        shifts: where the roots of the children are.
    """

    left: list[float]
    right: list[float]
    shifts: list[float]


def tidy_tree(
    roots: Sequence[str],
    children: Callable[[str], Sequence[str]],
    width: Callable[[str], float],
    gap: float,
) -> dict[str, BoxPlace]:
    """Place every node of some trees, the trees side by side.

    Args:
        roots: the roots, from left to right.
        children: the children of a node, from left to right.
        width: the width of a node's box.
        gap: the least distance of two boxes.

    Returns:
        Node → its place; the leftmost edge of all boxes is at 0.
    """
    subtrees: dict[str, _Subtree] = {}
    for node in reversed(_top_down(roots, children)):
        below = [subtrees[child] for child in children(node)]
        subtrees[node] = _under(width(node), below, gap)
    forest = _under(0.0, [subtrees[root] for root in roots], gap)
    leftmost = min(forest.left[1:], default=0.0)
    starts = [shift - leftmost for shift in forest.shifts]
    waiting = [(r, BoxPlace(x, 0)) for r, x in zip(roots, starts, strict=True)]
    places: dict[str, BoxPlace] = {}
    while waiting:
        node, place = waiting.pop()
        places[node] = place
        for child, shift in zip(children(node), subtrees[node].shifts, strict=True):
            waiting.append((child, BoxPlace(place.x + shift, place.depth + 1)))
    return places


def _top_down(
    roots: Sequence[str], children: Callable[[str], Sequence[str]]
) -> list[str]:
    """Return all nodes, parents before children; without recursion, for long chains."""
    order: list[str] = []
    waiting = list(roots)
    while waiting:
        node = waiting.pop()
        order.append(node)
        waiting.extend(children(node))
    return order


def _under(width: float, children: list[_Subtree], gap: float) -> _Subtree:
    left: list[float] = []
    right: list[float] = []
    shifts: list[float] = []
    for child in children:
        facing = zip(right, child.left, strict=False)
        shift = max((end - start + gap for end, start in facing), default=0.0)
        shifts.append(shift)
        # Where the new subtree is deeper it makes the outline, else only at the right.
        left += [edge + shift for edge in child.left[len(left) :]]
        right = [edge + shift for edge in child.right] + right[len(child.right) :]
    middle = (shifts[0] + shifts[-1]) / 2 if shifts else 0.0
    return _Subtree(
        [-width / 2, *(edge - middle for edge in left)],
        [width / 2, *(edge - middle for edge in right)],
        [shift - middle for shift in shifts],
    )

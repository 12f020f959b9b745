"""The tree of frames as a picture: a tidy tree in SVG, without Graphviz.

Children are side by side under the middle of their parent, as near to each other as
the widths of whole subtrees allow; no two boxes of one depth overlap.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from sambot_viz.frames.export.drawing import NO_DATA, edge_lines
from sambot_viz.frames.frame_tree import FrameTree
from sambot_viz.robot.model import Robot
from sambot_viz.text import columns, html_text

_CHARACTER = 6.6
_LINE = 14.0
_BOX = 28.0
_LINK = 46.0
_GAP = 18.0
_MARGIN = 20.0
# Every rule begins with the picture's own class, so that the picture can be part of a
# page without changing it.
_STYLE = """\
.tf-tree text { font: 12px "DejaVu Sans", Verdana, sans-serif; text-anchor: middle }
.tf-tree text { fill: #222 }
.tf-tree .frame rect { fill: #eef4fb; stroke: #2878c5; rx: 8px }
.tf-tree .root rect { stroke-width: 2.5px }
.tf-tree .root text, .tf-tree text.joint { font-weight: bold }
.tf-tree .label text { font-size: 11px; fill: #444 }
.tf-tree .label rect { fill: #fff; fill-opacity: 0.9 }
.tf-tree path { fill: none; stroke: #2878c5; stroke-width: 1.5px }
.tf-tree path.static { stroke: #888; stroke-dasharray: 5 3 }
.tf-tree marker path { fill: #555; stroke: none }
.tf-tree text.legend { font-size: 11px; fill: #666; text-anchor: start }"""

_LEGEND = (
    "from parent to child; solid: moves, dashed: static; xyz in metres, rpy in radians"
)


def tree_svg(tree: FrameTree, robot: Robot | None = None) -> str:
    """Draw the tree from top to bottom.

    Args:
        tree: the frames.
        robot: gives the names and types of the joints.

    Returns:
        A complete SVG document.
    """
    drawing = _Drawing(tree, robot)
    return drawing.document()


class _Drawing:
    def __init__(self, tree: FrameTree, robot: Robot | None) -> None:
        self._tree = tree
        self._lines = {
            frame: edge_lines(tree, frame, robot)
            for frame in tree.frames
            if tree.parent(frame) is not None
        }
        self._places = tidy_tree(tree.roots, tree.children, self._width, _GAP)
        # All labels of the picture get the same height, so that depths align.
        self._label = _LINE * max(map(len, self._lines.values()), default=0)
        self._level = _BOX + _LINK + self._label

    def document(self) -> str:
        right = max(
            (place.x + self._width(f) / 2 for f, place in self._places.items()),
            default=0.0,
        )
        width = max(right, _text_width(_LEGEND)) + 2 * _MARGIN
        depth = max((place.depth for place in self._places.values()), default=0)
        bottom = _MARGIN + depth * self._level + _BOX
        height = bottom + 2 * _MARGIN
        body = [self._link(frame) for frame in self._lines]
        body += [self._frame(frame) for frame in self._places]
        if not body:
            body = [
                f'<text x="{width / 2:.1f}" y="{_MARGIN + 18:.1f}">{NO_DATA}</text>'
            ]
        return "\n".join(
            (
                '<svg xmlns="http://www.w3.org/2000/svg" class="tf-tree" '
                f'viewBox="0 0 {width:.1f} {height:.1f}" '
                f'width="{width:.1f}" height="{height:.1f}">',
                f"<style>\n{_STYLE}\n</style>",
                '<marker id="tf-tree-arrow" viewBox="0 0 8 8" refX="8" refY="4" '
                'markerWidth="8" markerHeight="8" orient="auto">'
                '<path d="M0 0L8 4L0 8z"/></marker>',
                f'<rect width="{width:.1f}" height="{height:.1f}" fill="#fff"/>',
                *body,
                f'<text class="legend" x="{_MARGIN}" y="{height - 12:.1f}">'
                f"{_LEGEND}</text>",
                "</svg>",
                "",
            )
        )

    def _width(self, frame: str) -> float:
        name = _text_width(frame) + 24
        return max([name, *(_text_width(line) for line in self._lines.get(frame, ()))])

    def _top(self, place: BoxPlace) -> float:
        return _MARGIN + place.depth * self._level

    def _frame(self, frame: str) -> str:
        place = self._places[frame]
        x, top = _MARGIN + place.x, self._top(place)
        width = _text_width(frame) + 24
        kind = "frame" if frame in self._lines else "frame root"
        return (
            f'<g class="{kind}"><rect x="{x - width / 2:.1f}" y="{top:.1f}" '
            f'width="{width:.1f}" height="{_BOX}"/>'
            f'<text x="{x:.1f}" y="{top + 18.5:.1f}">{html_text(frame)}</text></g>'
        )

    def _link(self, frame: str) -> str:
        hop = self._tree.hop(frame)
        upper, lower = self._places[hop.parent], self._places[frame]
        x0, y0 = _MARGIN + upper.x, self._top(upper) + _BOX
        x1, y1 = _MARGIN + lower.x, self._top(lower)
        label = y1 - 12 - self._label
        bend = (y0 + label) / 2
        kind = ' class="static"' if hop.static else ""
        lines = self._lines[frame]
        # Short labels are at the lower end of the space for labels.
        first = y1 - 16 - _LINE * (len(lines) - 1)
        width = max(map(_text_width, lines)) - 8
        texts = "".join(
            f'<text{_joint_class(lines, i)} x="{x1:.1f}" y="{first + i * _LINE:.1f}">'
            f"{html_text(line)}</text>"
            for i, line in enumerate(lines)
        )
        return (
            f'<path{kind} marker-end="url(#tf-tree-arrow)" d="M{x0:.1f} {y0:.1f}'
            f"C{x0:.1f} {bend:.1f} {x1:.1f} {bend:.1f} {x1:.1f} {label:.1f}"
            f'L{x1:.1f} {y1:.1f}"/>'
            f'<g class="label"><rect x="{x1 - width / 2:.1f}" y="{first - 11:.1f}" '
            f'width="{width:.1f}" height="{_LINE * len(lines) + 1:.1f}"/>{texts}</g>'
        )


def _joint_class(lines: tuple[str, ...], index: int) -> str:
    return ' class="joint"' if index == 0 and len(lines) == 4 else ""


def _text_width(value: str) -> float:
    """Return the width of a text in the picture."""
    return columns(value) * _CHARACTER + 8


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

"""The graph as a picture that needs no Graphviz, for light and dark windows."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import quote

from sambot_viz.files import relative_path
from sambot_viz.graph.node_graph import NodeGraph
from sambot_viz.graph.placed_graph import (
    MARGIN,
    SMALL_LINE,
    PlacedEdge,
    PlacedGraph,
    PlacedPart,
    PlacedSpace,
    place_graph,
)
from sambot_viz.text import columns, html_text

# Every rule begins with the picture's own class, so that the picture can be part of a
# page without changing it.
_STYLE = """\
.ros-graph { --paper: #fff; --ink: #1c2733; --faint: #5b6875; --node: #eef4fb;
  --node-line: #2878c5; --topic: #f3f3ee; --topic-line: #83837a; --arrow: #6a7683;
  --space: #f5f6f8; --space-line: #b4bcc5; --bad: #c62828; --bad-fill: #fdecea;
  --warn: #b06000; --warn-fill: #fff3e0; --new: #7b1fa2 }
@media (prefers-color-scheme: dark) { .ros-graph { --paper: #16191d; --ink: #e4e9ee;
  --faint: #a3aeb9; --node: #1d3147; --node-line: #63a8e8; --topic: #2a2c2f;
  --topic-line: #8d949c; --arrow: #8e99a5; --space: #1f2328; --space-line: #4d5660;
  --bad: #ff7b72; --bad-fill: #43201f; --warn: #f0a848; --warn-fill: #3d2c12;
  --new: #cf93e8 } }
.ros-graph { background: var(--paper); font: 13px "DejaVu Sans", Verdana, sans-serif }
.ros-graph .paper { fill: var(--paper) }
.ros-graph text { fill: var(--ink); text-anchor: middle }
.ros-graph text.small { fill: var(--faint); font-size: 11px }
.ros-graph .node .shape { fill: var(--node); stroke: var(--node-line) }
.ros-graph .topic .shape { fill: var(--topic); stroke: var(--topic-line); rx: 3px }
.ros-graph .shape { stroke-width: 1.4px }
.ros-graph .unwritten .shape { stroke: var(--warn); stroke-width: 2.2px }
.ros-graph .error .shape { fill: var(--bad-fill); stroke: var(--bad) }
.ros-graph .warning .shape { fill: var(--warn-fill); stroke: var(--warn) }
.ros-graph .error .shape, .ros-graph .warning .shape { stroke-width: 2.2px }
.ros-graph .error text.problem { fill: var(--bad); font-weight: bold }
.ros-graph .warning text.problem { fill: var(--warn); font-weight: bold }
.ros-graph .uncertain .shape { stroke-dasharray: 2 3 }
.ros-graph .expected .shape, .ros-graph path.expected { stroke-dasharray: 7 4 }
.ros-graph .expected .shape { fill: var(--paper); stroke: var(--bad) }
.ros-graph .running .shape, .ros-graph path.running { stroke: var(--new) }
.ros-graph path.expected { stroke: var(--bad) }
.ros-graph .space rect { fill: var(--space); stroke: var(--space-line); rx: 8px }
.ros-graph .space text { fill: var(--faint); text-anchor: start; font-size: 12px }
.ros-graph path { fill: none; stroke: var(--arrow); stroke-width: 1.3px }
.ros-graph marker path { fill: var(--arrow); stroke: none }
.ros-graph .legend { fill: var(--faint); text-anchor: start; font-size: 11px }
.ros-graph a { text-decoration: none }"""
_LEGEND = (
    "ellipse: node; box: topic; arrows from who publishes to who reads; red or orange: "
    "a finding of check; orange border: read, but not published; dotted: not certain"
)
_COMPARED = (
    "ellipse: node; box: topic; arrows from who publishes to who reads; "
    "dashed red: expected, but not running; violet: running, but not expected"
)
_NOTHING = "no node and no topic is known"


def graph_svg(graph: NodeGraph, beside: Path | None = None) -> str:
    """Draw a graph from left to right.

    Args:
        graph: nodes and topics.
        beside: the folder of the picture, from which its links lead to launch files;
            None leaves them out.

    Returns:
        A complete SVG document.
    """
    placed = place_graph(graph)
    legend = _COMPARED if graph.is_compared else _LEGEND
    below = (legend, *placed.notes) if placed.parts else (_NOTHING, *placed.notes)
    width = max(placed.width, max(map(columns, below)) * 6.6 + 2 * MARGIN)
    height = placed.height + SMALL_LINE * 1.3 * len(below)
    return "\n".join(
        (
            '<svg xmlns="http://www.w3.org/2000/svg" class="ros-graph" '
            f'viewBox="0 0 {width:.1f} {height:.1f}" '
            f'width="{width:.1f}" height="{height:.1f}">',
            f"<style>\n{_STYLE}\n</style>",
            '<marker id="ros-graph-arrow" viewBox="0 0 8 8" refX="8" refY="4" '
            'markerWidth="7" markerHeight="7" orient="auto">'
            '<path d="M0 0L8 4L0 8z"/></marker>',
            f'<rect class="paper" width="{width:.1f}" height="{height:.1f}"/>',
            *map(_space, placed.spaces),
            *map(_edge, placed.edges),
            *(_part(part, beside) for part in placed.parts),
            *_below(placed, below),
            "</svg>",
            "",
        )
    )


def _below(placed: PlacedGraph, lines: tuple[str, ...]) -> list[str]:
    return [
        f'<text class="legend" x="{MARGIN:.1f}" '
        f'y="{placed.height + SMALL_LINE * 1.3 * i:.1f}">{html_text(line)}</text>'
        for i, line in enumerate(lines)
    ]


def _space(space: PlacedSpace) -> str:
    return (
        f'<g class="space"><rect x="{space.x:.1f}" y="{space.y:.1f}" '
        f'width="{space.width:.1f}" height="{space.height:.1f}"/>'
        f'<text x="{space.x + 8:.1f}" y="{space.y + 16:.1f}">'
        f"{html_text(space.name)}</text></g>"
    )


def _edge(edge: PlacedEdge) -> str:
    return (
        f'<path class="{" ".join(edge.look)}" marker-end="url(#ros-graph-arrow)" '
        f'd="{edge.path}"><title>{html_text(edge.said)}</title></path>'
    )


def _part(part: PlacedPart, beside: Path | None) -> str:
    x, y, w, h = part.x, part.y, part.width, part.height
    if part.kind == "node":
        shape = f'<ellipse class="shape" cx="{x:.1f}" cy="{y:.1f}" '
        shape += f'rx="{w / 2:.1f}" ry="{h / 2:.1f}"/>'
    else:
        shape = f'<rect class="shape" x="{x - w / 2:.1f}" y="{y - h / 2:.1f}" '
        shape += f'width="{w:.1f}" height="{h:.1f}"/>'
    drawn = (
        f'<g class="{" ".join(part.look)}"><title>{_lines(part.said)}</title>'
        f"{shape}{_texts(part)}</g>"
    )
    if beside is None or not part.file:
        return drawn
    return f'<a href="{html_text(_link(part, beside))}">{drawn}</a>'


def _texts(part: PlacedPart) -> str:
    top = part.y - SMALL_LINE * (len(part.lines) - 1) / 2 + 4.5
    said: list[str] = []
    for i, line in enumerate(part.lines):
        is_problem = part.problem is not None and i == len(part.lines) - 1
        kind = ' class="small"' if i else ""
        kind = ' class="small problem"' if is_problem else kind
        said.append(
            f'<text{kind} x="{part.x:.1f}" y="{top + SMALL_LINE * i:.1f}">'
            f"{html_text(line)}</text>"
        )
    return "".join(said)


def _lines(said: str) -> str:
    return "\n".join(html_text(line) for line in said.split("\n"))


def _link(part: PlacedPart, beside: Path) -> str:
    """Return where a launch file is, seen from the picture."""
    path = Path(relative_path(part.file, beside)).as_posix()
    return quote(path, errors="surrogatepass") + (f"#L{part.line}" if part.line else "")

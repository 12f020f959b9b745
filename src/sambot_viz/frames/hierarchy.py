"""The parent of each frame, and the path between two frames.

The rules are tf2's: one parent per frame, the latest parent
wins, a frame exists as soon as a transform names it. Unlike tf2, a ring is refused
when it would be made.
"""

from __future__ import annotations

from collections.abc import Iterable

from sambot_viz.errors import FrameError
from sambot_viz.frames.frame_errors import (
    FrameCycleError,
    LookupRefused,
    TransformRefused,
)
from sambot_viz.frames.transform import Transform
from sambot_viz.geometry import Matrix


class Edge:
    """The transform of a child in its parent; lives as long as the child does.

    Attributes:
        matrix: (4, 4) float64, read-only; T_parent_child.
    """

    __slots__ = ("_transform", "child", "matrix", "parent", "stamp", "static")

    def __init__(self, parent: str, child: str) -> None:
        self.parent = parent
        self.child = child
        self.transform = Transform.identity()
        self.static = False
        self.stamp = 0.0

    @property
    def transform(self) -> Transform:
        """T_parent_child, made when it is asked for."""
        if self._transform is None:
            self._transform = Transform.trusted(self.matrix)
        return self._transform

    @transform.setter
    def transform(self, transform: Transform) -> None:
        self._transform: Transform | None = transform
        self.matrix = transform.matrix

    def move(self, matrix: Matrix, stamp: float) -> None:
        """Take another matrix, that of a rotation and translation."""
        self.matrix, self.stamp, self._transform = matrix, stamp, None


Path = tuple[tuple[Edge, ...], tuple[Edge, ...]]
"""The edges from the source up to the common ancestor, and from the target up."""


class FrameHierarchy:
    """The frames and their parents, without regard to where they are.

    Attributes:
        version: grows when a frame appears, disappears or gets another parent.
    """

    def __init__(self) -> None:
        self.version = 0
        self._edges: dict[str, Edge] = {}
        self._children: dict[str, dict[str, None]] = {}
        self._declared: set[str] = set()
        self._paths: dict[tuple[str, str], Path] = {}
        self._roots: tuple[str, ...] | None = None

    def declare(self, frame: str) -> None:
        """Make a frame known that no transform names: the root of a lone link.

        Raises:
            TransformRefused: an empty name.
        """
        frame = plain_name(frame)
        if not frame:
            raise TransformRefused("TF_NO_FRAME_ID", "the frame has no name")
        self._declared.add(frame)
        if frame not in self._children:
            self._children[frame] = {}
            self._restructured()

    @property
    def frames(self) -> tuple[str, ...]:
        """All frames in the order in which they became known."""
        return tuple(self._children)

    @property
    def roots(self) -> tuple[str, ...]:
        """The frames without a parent; more than one means unconnected trees."""
        if self._roots is None:
            edges = self._edges
            self._roots = tuple(name for name in self._children if name not in edges)
        return self._roots

    def __contains__(self, frame: object) -> bool:
        return isinstance(frame, str) and plain_name(frame) in self._children

    def __len__(self) -> int:
        return len(self._children)

    def parent(self, frame: str) -> str | None:
        """Return the parent of a frame, or None for a root or an unknown frame."""
        edge = self._edges.get(plain_name(frame))
        return edge.parent if edge else None

    def matrices_of(self, frames: Iterable[str]) -> dict[str, Matrix]:
        """Return frame → (4, 4) latest T_parent_frame, of those that have a parent."""
        known = self._edges
        edges = [(f, known.get(f) or known.get(plain_name(f))) for f in frames]
        return {frame: edge.matrix for frame, edge in edges if edge is not None}

    def children(self, frame: str) -> tuple[str, ...]:
        """Return the children of a frame in the order in which they became known."""
        return tuple(self._children.get(plain_name(frame), ()))

    def _edge_for(self, parent: str, child: str) -> Edge:
        parent, child = plain_name(parent), plain_name(child)
        edge = self._edges.get(child)
        if edge is not None and edge.parent == parent:
            return edge
        self._check_names(parent, child)
        if edge is not None:
            # The former parent stays known, as it does in tf2.
            del self._children[edge.parent][child]
        edge = Edge(parent, child)
        self._edges[child] = edge
        self._children.setdefault(parent, {})[child] = None
        self._children.setdefault(child, {})
        self._restructured()
        return edge

    def _check_names(self, parent: str, child: str) -> None:
        if not parent:
            raise TransformRefused("TF_NO_FRAME_ID", "the parent frame has no name")
        if not child:
            raise TransformRefused(
                "TF_NO_CHILD_FRAME_ID", "the child frame has no name"
            )
        if parent == child:
            raise TransformRefused(
                "TF_SELF_TRANSFORM", f"'{child}' cannot be its own parent"
            )
        if not self._children.get(child):
            # Nothing hangs below it: of a long chain each link is looked at once.
            return
        ring = [parent]
        while (edge := self._edges.get(ring[-1])) is not None:
            ring.append(edge.parent)
            if edge.parent == child:
                raise FrameCycleError((parent, *reversed(ring)))

    def _edge_of(self, child: str) -> Edge:
        child = plain_name(child)
        edge = self._edges.get(child)
        if edge is None:
            self._require(child, child)
            raise FrameError(f"frame '{child}' is a root: it has no parent")
        return edge

    def _detach(self, edge: Edge) -> None:
        del self._edges[edge.child]
        del self._children[edge.parent][edge.child]
        for name in (edge.child, edge.parent):
            needed = self._children[name] or name in self._edges
            if not needed and name not in self._declared:
                del self._children[name]
        self._restructured()

    def _restructured(self) -> None:
        self.version += 1
        self._roots = None
        self._paths.clear()

    def _require(self, target: str, source: str) -> None:
        for name in (target, source):
            if name not in self._children:
                reason = "unknown-frame" if name else "empty-name"
                raise LookupRefused(target, source, reason, self._children, name)

    def _path(self, target: str, source: str) -> Path:
        known = self._paths.get((target, source))
        if known is not None:
            return known
        asked = (target, source)
        target, source = plain_name(target), plain_name(source)
        if target == source and target:
            return ((), ())
        self._require(target, source)
        above, below = self._line(target), self._line(source)
        while above and below and above[-1] is below[-1]:
            above.pop()
            below.pop()
        top_of_target = above[-1].parent if above else target
        top_of_source = below[-1].parent if below else source
        if top_of_target != top_of_source:
            raise LookupRefused(target, source, "not-connected")
        path = (tuple(below), tuple(above))
        self._paths[asked] = path
        return path

    def _line(self, frame: str) -> list[Edge]:
        line: list[Edge] = []
        while (edge := self._edges.get(frame)) is not None:
            line.append(edge)
            frame = edge.parent
        return line


def plain_name(name: str) -> str:
    """Return a frame name without the one leading slash that tf2 strips."""
    return name[1:] if name.startswith("/") else name

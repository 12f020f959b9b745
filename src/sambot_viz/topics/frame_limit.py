"""How many frames messages may bring: each is a node, a row and axes of every page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sambot_viz import limits
from sambot_viz.errors import Problem
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.samples import FramePair, Poses

_MOST_KEPT = 1000
Transforms = Sequence[tuple[int, tuple[FramePair, ...], Poses]]
"""By stamp [ns]: (parent, child) of each row, and the rows (see `FrameHistory.add`)."""


@dataclass(frozen=True, slots=True)
class _Passed:
    """The accepted part of some frames.

    Attributes:
        all_edges: all the frames.
        rows: indices of the accepted ones.
        edges: the accepted frames.
    """

    all_edges: tuple[FramePair, ...]
    rows: list[int]
    edges: tuple[FramePair, ...]


class FrameLimit:
    """Lets the first frames of messages through, and no others.

    Attributes:
        left_out: the first frame that was not let through; empty for none.
    """

    def __init__(self) -> None:
        self.left_out = ""
        self._known: set[str] = set()
        # By the id of all edges, which a decoder gives again for the same frames; those
        # who take the rest expect that, too.
        self._parts: dict[int, _Passed] = {}
        self._edges: dict[tuple[FramePair, ...], tuple[FramePair, ...]] = {}

    def through(self, transforms: Transforms) -> Transforms:
        """Return those transforms whose frames are among the first ones."""
        found: list[tuple[int, tuple[FramePair, ...], Poses]] = []
        for stamp, all_edges, poses in transforms:
            part = self._part(all_edges)
            if part.edges is all_edges:
                found.append((stamp, all_edges, poses))
            elif part.rows:
                found.append((stamp, part.edges, poses[part.rows]))
        return found

    def follow(self, other: FrameLimit) -> None:
        """Let the same frames through as another one until now."""
        self._known |= other._known

    def _part(self, all_edges: tuple[FramePair, ...]) -> _Passed:
        part = self._parts.get(id(all_edges))
        if part is not None:
            return part
        if len(self._parts) >= _MOST_KEPT:
            self._parts.clear()
            self._edges.clear()
        rows = [row for row, edge in enumerate(all_edges) if self._has_room(edge)]
        edges = all_edges
        if len(rows) < len(all_edges):
            edges = tuple(all_edges[row] for row in rows)
            edges = self._edges.setdefault(edges, edges)
        part = self._parts[id(all_edges)] = _Passed(all_edges, rows, edges)
        return part

    def _has_room(self, edge: FramePair) -> bool:
        names = {plain_name(name) for name in edge} - self._known
        if len(names) + len(self._known) > limits.FRAMES.value:
            self.left_out = self.left_out or plain_name(edge[1])
            return False
        self._known |= names
        return True


def too_many_frames(left_out: str, name: str) -> Problem:
    """Say that frames are left out.

    Args:
        left_out: one of them.
        name: of the recording, or of the live robot.
    """
    return Problem(
        "warning",
        "many-frames",
        f"{name} has more than {limits.FRAMES.value:,} frames: the first ones are "
        f"shown, {left_out} and all later ones are left out",
        "find out which program publishes a transform for each thing it sees, and "
        "have it use the same names again",
    )

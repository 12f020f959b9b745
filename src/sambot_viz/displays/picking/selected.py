"""What displays know of data that is selected."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from sambot_viz.displays.picking.box_lines import box_lines
from sambot_viz.displays.picking.rays import Array, Indices

Fact: TypeAlias = tuple[str, str | tuple[int, int, int]]
"""The name of a row of the Selection panel, and its text or its colour (0 to 255)."""


@dataclass(frozen=True, slots=True, eq=False)
class DataFacts:
    """What the Selection panel says of one point, marker or pose.

    Attributes:
        title: of its rows.
        facts: the rows.
        position: in the fixed frame, (3,) [m].
    """

    title: str
    facts: Sequence[Fact]
    position: Array


@dataclass(frozen=True, slots=True, eq=False)
class Cubes:
    """Cubes along the axes of the fixed frame.

    Attributes:
        middles: (N, 3) [m].
        edges: (N,) [m].
    """

    middles: Array
    edges: Array

    @property
    def box(self) -> tuple[Array, Array]:
        """The corners (3,) of the box around all of them [m]; there must be one."""
        half = self.edges[:, None] / 2
        low, high = self.middles - half, self.middles + half
        return low.min(axis=0), high.max(axis=0)

    def lines(self, most: int) -> Array:
        """Return the edges of the first of them, (12·N, 2, 3) [m]."""
        lines = self.edges[:most, None, None, None] * box_lines([-0.5] * 3, [0.5] * 3)
        return np.reshape(self.middles[:most, None, None] + lines, (-1, 2, 3))


class SelectedData:
    """Data of a display that can be selected, at one moment."""

    def facts(self, numbers: Indices | None) -> Sequence[DataFacts]:
        """Return the facts about it.

        Args:
            numbers: numbers of points; None for a marker or a pose.
        """
        raise NotImplementedError

    def cubes(self, numbers: Indices) -> Cubes:
        """Return the boxes around some points; other items override this."""
        del numbers
        return Cubes(np.zeros((0, 3)), np.zeros(0))

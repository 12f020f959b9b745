"""GridCells: cells of a grid, such as obstacles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from sambot_viz.displays.data.display_node import DisplayNode
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import (
    Floats,
    points_of,
    require_finite,
)
from sambot_viz.displays.data.properties import alpha_property
from sambot_viz.displays.data.refused_messages import MessageRefused
from sambot_viz.displays.data.topic_display import TOPIC, topic_property
from sambot_viz.displays.scene.points import PointNode, PointStyle
from sambot_viz.geometry import Vector3
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import ColorProperty
from sambot_viz.topics.contents.grids import cells_fault

Cells = tuple[Floats, Vector3]
"""Middles (N, 3) and edges of cells [m]."""


class GridCellsDisplay(MessageFilterDisplay[Cells]):
    """The cells of nav_msgs/GridCells, as tiles in the plane of their frame."""

    kind = "rviz_default_plugins/GridCells"
    meanings = frozenset({Meaning.CELLS})
    properties = (
        topic_property(),
        ColorProperty("Color", default=(25, 255, 0), help="The colour of the cells."),
        alpha_property(),
    )
    _node = DisplayNode(PointNode, "p")

    def read(self, message: Any) -> Cells:
        """Return the middles of the cells, and their size [m]."""
        width, height = float(message.cell_width), float(message.cell_height)
        require_finite([width, height])
        if fault := cells_fault(message):
            raise MessageRefused(fault, TOPIC)
        return points_of(message.cells), (width, height, 0.0)

    def draw_kept(self, kept: Sequence[Taken[Cells]]) -> None:
        """Draw the cells as they look now."""
        cells, size = kept[-1].read
        alpha, normal = float(self.config.get("Alpha")), (0.0, 0.0, 1.0)
        style = PointStyle("Tiles", size, alpha, normal, is_twice=True)
        color = np.array([self.config.get("Color")], np.uint8)
        self._node.draw(cells, color, style, *kept[-1].pose)

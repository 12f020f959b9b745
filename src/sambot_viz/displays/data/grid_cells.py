"""GridCells: cells of a grid, such as obstacles."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from sambot_viz.displays.data.message_numbers import (
    Floats,
    points_of,
    require_finite,
)
from sambot_viz.displays.data.newest_message import NewestMessageDisplay
from sambot_viz.displays.data.properties import alpha_property
from sambot_viz.displays.data.refusals import MessageRefused
from sambot_viz.displays.data.topic_display import TOPIC, topic_property
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import HERE, Placed
from sambot_viz.displays.scene.points import PointNode, PointStyle
from sambot_viz.geometry import Vector3, Wxyz
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import ColorProperty, DisplayConfig
from sambot_viz.topics.contents.grids import cells_fault

Cells = tuple[Floats, Vector3]
"""Middles (N, 3) and edges of cells [m]."""


class GridCellsDisplay(NewestMessageDisplay[Cells]):
    """The cells of nav_msgs/GridCells, as tiles in the plane of their frame."""

    kind = "rviz_default_plugins/GridCells"
    help = "Cells of a grid, such as obstacles."
    meanings = frozenset({Meaning.CELLS})
    properties = (
        topic_property(),
        ColorProperty("Color", default=(25, 255, 0), help="The colour of the cells."),
        alpha_property(),
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._node = PointNode(context.scene, f"/{key}p")

    def read(self, message: Any) -> Cells:
        """Return the middles of the cells, and their size [m]."""
        width, height = float(message.cell_width), float(message.cell_height)
        require_finite([width, height])
        if fault := cells_fault(message):
            raise MessageRefused(fault, TOPIC)
        return points_of(message.cells), (width, height, 0.0)

    def draw_read(self, read: Cells, wxyz: Wxyz, position: Vector3) -> None:
        """Draw the cells as they look now."""
        cells, size = read
        alpha, normal = float(self.config.get("Alpha")), (0.0, 0.0, 1.0)
        style = PointStyle("Tiles", size, alpha, normal, is_twice=True)
        color = np.array([self.config.get("Color")], np.uint8)
        self._node.draw(cells, color, style, wxyz, position)

    def placed(self) -> Iterator[Placed]:
        """Yield the cells, which cannot be selected, as in RViz."""
        yield from self._node.placed(HERE, None)

    def remove(self) -> None:
        """Take the cells out of the scene."""
        self._node.remove()

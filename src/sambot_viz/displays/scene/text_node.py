"""Text that faces the view, in any colour, with a constant size in the scene."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from sambot_viz import limits
from sambot_viz.displays.picking.placed_points import PlacedPoints, PointOutline
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.scene.glb_node import ONE_PIXEL, GlbNode, drawn_glb
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.geometry import IDENTITY, ORIGIN, Matrix, Vector3
from sambot_viz.text import text as printable

LETTER = 0.5
"""Width of a letter by the height of a line, about: only browsers know the letters."""
SPACE = 0.593
"""Width of a space by the height of a line: that of an A, as RViz meant it."""


class TextNode(GlbNode):
    """A text in one node, with its middle at a position; lines begin at the left."""

    _size: Vector3 = ORIGIN

    def draw(
        self,
        text: str,
        height: float,
        color: Rgb = (255, 255, 255),
        *,
        alpha: float = 1.0,
        space: float | None = None,
        position: Vector3 = ORIGIN,
    ) -> None:
        """Draw the text; one without letters draws nothing.

        Args:
            text: with a newline between its lines.
            height: of a line [m]; capital letters have 0.63 of it.
            color: 0 to 255.
            alpha: 0 to 1.
            space: width of a space [m]; None for that of an A.
            position: of the middle in the frame of the node above [m].
        """
        lines = [
            printable(line) for line in text[: limits.MARKER_TEXT.value].split("\n")
        ]
        if not "".join(lines).strip() or not 0 < height < 1e6 or not alpha > 0:
            self.remove()
            return
        count = max(len(line) for line in lines)
        self._size = (LETTER * height * count, height * len(lines), 0.0)
        wide = SPACE * height if space is None or not math.isfinite(space) else space
        said: dict[str, object] = {
            "lines": lines,
            "height": float(height),
            "space": max(0.0, float(wide)),
            "color": [channel / 255 for channel in color],
            "alpha": min(1.0, float(alpha)),
        }
        self.show((said,), lambda: _glb(said), IDENTITY, position)

    def placed(
        self, T_fixed_above: Matrix, item: Selectable | None
    ) -> Iterator[PlacedPoints]:
        """Yield the text for rays, as a rectangle of about its size.

        Args:
            T_fixed_above: (4, 4), of the node above.
            item: what it is to a selection.
        """
        if self.is_drawn:
            look, here = PointOutline("text", self._size), np.zeros((1, 3), np.float32)
            yield PlacedPoints(item, here, self.place(T_fixed_above), look)


def _glb(said: dict[str, object]) -> bytes:
    """Return a GLB file whose one square the page gives its size and its letters."""
    return drawn_glb(
        "text",
        {
            "POSITION": np.zeros((4, 3), np.float32),
            "TEXCOORD_0": np.array([[0, 0], [1, 0], [0, 1], [1, 1]], np.float32),
        },
        extras=said,
        indices=np.array([0, 2, 1, 1, 2, 3], np.uint32),
        blended=True,
        image=ONE_PIXEL,
    )

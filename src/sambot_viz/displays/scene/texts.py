"""Text that faces the view, in any colour, with a constant size in the scene."""

from __future__ import annotations

import math

import numpy as np

from sambot_viz.displays.scene.glb_node import ONE_PIXEL, GlbNode, drawn_glb
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.geometry import IDENTITY, ORIGIN, Vector3
from sambot_viz.text import text as printable

LONGEST = 2000
"""More characters than this are not drawn."""
SPACE = 0.593
"""Width of a space by the height of a line: that of an A, as RViz meant it."""


class TextNode(GlbNode):
    """A text in one node, with its middle at a position; lines begin at the left."""

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
        lines = [printable(line) for line in text[:LONGEST].split("\n")]
        if not "".join(lines).strip() or not 0 < height < 1e6 or not alpha > 0:
            self.remove()
            return
        wide = SPACE * height if space is None or not math.isfinite(space) else space
        said: dict[str, object] = {
            "lines": lines,
            "height": float(height),
            "space": max(0.0, float(wide)),
            "color": [channel / 255 for channel in color],
            "alpha": min(1.0, float(alpha)),
        }
        self.show((said,), lambda: _glb(said), IDENTITY, position)


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

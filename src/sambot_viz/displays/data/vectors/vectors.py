"""Base of the displays of two vectors: one along which, one about which it goes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import hypot
from typing import Any, ClassVar

import numpy as np

from sambot_viz.displays.data.kept_messages import KeptReadingsDisplay
from sambot_viz.displays.data.message_numbers import vector_of
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import HERE, Placed
from sambot_viz.displays.scene.rings import Ring, RingsNode
from sambot_viz.displays.scene.solid_nodes import Solid, arrow_solids
from sambot_viz.displays.scene.solids import Arrow, Rgb
from sambot_viz.geometry import ORIGIN, Matrix, Vector3, rotation_from_xyzw, wxyz_from_z
from sambot_viz.rviz import (
    BoolProperty,
    ColorProperty,
    DisplayConfig,
    FloatProperty,
    IntProperty,
    Property,
)

MOST_VECTORS = 100
LENGTH = "History Length"
_POINTS = 29
"""Of each circle: from 45° to 360°."""


@dataclass(frozen=True, slots=True)
class VectorLook:
    """How a vector is drawn.

    Attributes:
        color: 0 to 255.
        alpha: 0 to 1.
        scale: length of the shaft for a vector of length 1 [m].
        width: RViz's "Arrow Width"; the shaft is a tenth of it thick [m].
        hides_small: whether a shaft that is not longer than the width is left out.
    """

    color: Rgb
    alpha: float
    scale: float
    width: float
    hides_small: bool

    def length(self, vector: Vector3) -> float:
        """Return the length of the shaft [m]; 0 for a vector that is not drawn."""
        found = hypot(*vector) * self.scale
        return found if found > self.width or not self.hides_small else 0.0


def vector_properties(along: str, about: str) -> tuple[Property, ...]:
    """Return the properties that all displays of two vectors have.

    Args:
        along: RViz's word for the vector along which it goes, such as "Force".
        about: for the one about which it goes, such as "Torque".
    """
    colors = {along: (204, 51, 51), about: (204, 204, 51)}
    return (
        *(
            ColorProperty(
                f"{name} Color",
                default=color,
                help=f"The colour of the {name.lower()} arrows.",
            )
            for name, color in colors.items()
        ),
        FloatProperty("Alpha", default=1.0, help="How opaque the arrows are."),
        *(
            FloatProperty(
                f"{name} Arrow Scale",
                default=2.0,
                unit="m",
                help=f"Length of the shaft of {name.lower()} arrows for a value of 1.",
            )
            for name in colors
        ),
        FloatProperty(
            "Arrow Width",
            default=0.5,
            unit="m",
            help="Ten times the diameter of the shafts.",
        ),
        IntProperty(
            LENGTH,
            default=1,
            minimum=1,
            maximum=100_000,
            acts_up_to=MOST_VECTORS,
            help=f"So many of the newest messages are shown, up to {MOST_VECTORS}.",
        ),
    )


HIDES = BoolProperty(
    "Hide Small Values",
    default=True,
    help="An arrow that is not longer than Arrow Width is left out.",
)


class VectorsDisplay(KeptReadingsDisplay):
    """Draws two vectors of each message; one with a circle, as it turns about it."""

    length = LENGTH
    words: ClassVar[tuple[str, str]]
    """What RViz calls the two: "Force" and "Torque", or "Linear" and "Angular"."""

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._node = RingsNode(context.scene, f"/{key}")

    def vectors(self, message: Any) -> tuple[Any, Any]:
        """Return the two vectors of a message, geometry_msgs/Vector3."""
        raise NotImplementedError

    @property
    def hides_small(self) -> bool:
        """Whether a vector that is too short for its width is left out."""
        return True

    @property
    def nan_is_zero(self) -> bool:
        """Whether a number that is NaN is drawn as 0; else its message is refused."""
        return False

    def measured(self, message: Any) -> tuple[Vector3, Vector3]:
        """Return the vectors of a message."""
        along, about = self.vectors(message)
        zero = self.nan_is_zero
        return vector_of(along, nan_is_zero=zero), vector_of(about, nan_is_zero=zero)

    def draw_kept(self, kept: Sequence[tuple[Any, Matrix]]) -> None:
        """Draw arrows and circles."""
        along, about = (self._look(word) for word in self.words)
        solids: list[Solid] = []
        rings: list[Ring] = []
        for (first, second), T in kept:
            solids += arrow_of(first, along, T)
            solids += arrow_of(second, about, T)
            rings += ring_of(second, about, T)
        self._node.draw(rings, 0.05 * about.width, solids)

    def placed(self) -> Iterator[Placed]:
        """Yield the arrows and circles, which cannot be selected, as in RViz."""
        yield from self._node.placed(HERE)

    def remove(self) -> None:
        """Take all arrows out of the scene."""
        self._node.remove()

    def _look(self, word: str) -> VectorLook:
        get = self.config.get
        return VectorLook(
            get(f"{word} Color"),
            min(max(float(get("Alpha")), 0.0), 1.0),
            float(get(f"{word} Arrow Scale")),
            float(get("Arrow Width")),
            self.hides_small,
        )


def arrow_of(
    vector: Vector3, look: VectorLook, T_fixed_frame: Matrix
) -> Sequence[Solid]:
    """Return the arrow of a vector, in the fixed frame.

    Args:
        vector: in its frame.
        look: how it is drawn.
        T_fixed_frame: (4, 4), where that frame is.
    """
    length = look.length(vector)
    if not length:
        return ()
    shaft, head = (length, 0.1 * look.width), (0.3 * length, 0.2 * look.width)
    arrow = Arrow(ORIGIN, vector, shaft, head)
    solids = arrow_solids(arrow, look.color, look.alpha)
    return [solid.placed(T_fixed_frame) for solid in solids]


def ring_of(vector: Vector3, look: VectorLook, T_fixed_frame: Matrix) -> Sequence[Ring]:
    """Return the circle about the middle of an arrow, in the fixed frame.

    Args:
        vector: as for `arrow_of`.
        look: likewise.
        T_fixed_frame: likewise.
    """
    length = look.length(vector)
    if not length:
        return ()
    w, x, y, z = wxyz_from_z(vector)
    R = T_fixed_frame[:3, :3] @ np.array(rotation_from_xyzw((x, y, z, w)))
    to_head, to_quarter, along = R[:, 0], R[:, 1], R[:, 2]
    return (
        Ring(
            T_fixed_frame[:3, 3] + along * (length / 2),
            to_head * (length / 4),
            to_quarter * (length / 4),
            _POINTS,
            (0.1 * look.width, 0.2 * look.width),
            look.color,
            look.alpha,
        ),
    )

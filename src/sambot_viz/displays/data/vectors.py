"""AccelStamped, TwistStamped and Wrench: a vector along an axis, and one about it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot
from operator import attrgetter
from typing import Any, ClassVar

import numpy as np

from sambot_viz import limits
from sambot_viz.displays.data.display_node import DisplayNode
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import vector_of
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.scene.rings import Ring, RingsNode
from sambot_viz.displays.scene.solid_nodes import Solid, arrow_solids
from sambot_viz.displays.scene.solids import Arrow, Rgb
from sambot_viz.geometry import ORIGIN, Matrix, Vector3, rotation_from_xyzw, wxyz_from_z
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import (
    BoolProperty,
    ColorProperty,
    FloatProperty,
    IntProperty,
    Property,
)

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
            acts_up_to=limits.VECTORS.value,
            help=f"Number of newest messages to show, up to {limits.VECTORS.value:,}.",
        ),
    )


ACCEPTS_NAN = BoolProperty(
    "Accept NaN Values", default=False, help="Numbers that are NaN are drawn as 0."
)
HIDES = BoolProperty(
    "Hide Small Values",
    default=True,
    help="An arrow that is not longer than Arrow Width is left out.",
)


Vectors = tuple[Vector3, Vector3]


class VectorsDisplay(MessageFilterDisplay[Vectors]):
    """Draws two vectors of each message; one with a circle, as it turns about it."""

    length = LENGTH
    words: ClassVar[tuple[str, str]]
    """What RViz calls the two: "Force" and "Torque", or "Linear" and "Angular"."""
    field: ClassVar[str]
    """The field of the message that has two fields of these names."""
    _node = DisplayNode(RingsNode, "")

    def read(self, message: Any) -> Vectors:
        """Return the vectors of a message."""
        along, about = attrgetter(*map(str.lower, self.words))(
            getattr(message, self.field)
        )
        zero = self._is(ACCEPTS_NAN, otherwise=False)
        return vector_of(along, nan_is_zero=zero), vector_of(about, nan_is_zero=zero)

    def draw_kept(self, kept: Sequence[Taken[Vectors]]) -> None:
        """Draw arrows and circles."""
        along, about = (self._look(word) for word in self.words)
        solids: list[Solid] = []
        rings: list[Ring] = []
        for one in kept:
            (first, second), T = one.read, one.T_fixed_frame
            solids += arrow_of(first, along, T)
            solids += arrow_of(second, about, T)
            rings += ring_of(second, about, T)
        self._node.draw(rings, 0.05 * about.width, solids)

    def property_changed(self, path: str) -> None:
        """A property has a new value; what NaN means is decided once a message."""
        if self.shown and path == ACCEPTS_NAN.name:
            self.clear()
        super().property_changed(path)

    def _is(self, switch: BoolProperty, *, otherwise: bool) -> bool:
        """Return the value of a switch; of displays without it another one."""
        has_it = switch in self.properties
        return bool(self.config.get(switch.name)) if has_it else otherwise

    def _look(self, word: str) -> VectorLook:
        get = self.config.get
        return VectorLook(
            get(f"{word} Color"),
            min(max(float(get("Alpha")), 0.0), 1.0),
            float(get(f"{word} Arrow Scale")),
            float(get("Arrow Width")),
            self._is(HIDES, otherwise=True),
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


class AccelStampedDisplay(VectorsDisplay):
    """The linear and the angular part of geometry_msgs/AccelStamped."""

    kind = "rviz_default_plugins/AccelStamped"
    meanings = frozenset({Meaning.ACCELERATION})
    words, field = ("Linear", "Angular"), "accel"
    properties = (topic_property(), *vector_properties(*words), HIDES)


class TwistStampedDisplay(VectorsDisplay):
    """The linear and the angular part of geometry_msgs/TwistStamped."""

    kind = "rviz_default_plugins/TwistStamped"
    meanings = frozenset({Meaning.VELOCITY})
    words, field = ("Linear", "Angular"), "twist"
    properties = (topic_property(), *vector_properties(*words), HIDES)


class WrenchDisplay(VectorsDisplay):
    """The force and the torque of geometry_msgs/WrenchStamped."""

    kind = "rviz_default_plugins/Wrench"
    meanings = frozenset({Meaning.FORCE})
    words, field = ("Force", "Torque"), "wrench"
    properties = (topic_property(), ACCEPTS_NAN, *vector_properties(*words))

"""ParticleCloud of Nav2: the particles of a localisation, longer with their weights."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from sambot_viz.displays.data.message_numbers import (
    Floats,
    poses_of,
    require_few,
    require_finite,
)
from sambot_viz.displays.data.newest_message import NewestMessageDisplay
from sambot_viz.displays.data.poses.pose_shapes import (
    AXES,
    FLAT_ARROW,
    SOLID_ARROW,
    PoseLook,
    PoseShapes,
    color_property,
)
from sambot_viz.displays.data.properties import alpha_property, metres
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.picking.placed import Placed
from sambot_viz.geometry import Vector3, Wxyz
from sambot_viz.rviz import DisplayConfig, EnumProperty

_IF_ARROW = ("Shape", (FLAT_ARROW, SOLID_ARROW))
SHORTEST, LONGEST = "Min Arrow Length", "Max Arrow Length"
SHAFT, HEAD = (1.0, 0.0435), (0.3043, 0.1304)
"""Length and diameter of shaft and head, by the length of the shaft."""
Particles = tuple[Floats, Floats, Floats]
"""Rotations, (N, 4), positions, (N, 3) [m], and weights, (N,)."""


class ParticleCloudDisplay(NewestMessageDisplay[Particles]):
    """The particles of nav2_msgs/ParticleCloud; the newest message alone."""

    kind = "nav2_rviz_plugins/ParticleCloud"
    help = "The particles of Nav2's localisation; those with more weight are longer."
    types = frozenset({"nav2_msgs/msg/ParticleCloud"})
    properties = (
        topic_property(),
        EnumProperty(
            "Shape",
            default=FLAT_ARROW,
            options=(FLAT_ARROW, SOLID_ARROW, AXES),
            help="How each particle is drawn.",
        ),
        color_property(shape=_IF_ARROW),
        alpha_property(hidden_unless=_IF_ARROW),
        metres(SHORTEST, 0.02, "Length of a particle without weight."),
        metres(LONGEST, 0.3, "Length of a particle with the weight 1."),
    )

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._shapes = PoseShapes(context.scene, f"/{key}")

    def read(self, message: Any) -> Particles:
        """Return the rotations, the positions and the weights of the particles."""
        particles = message.particles
        require_few(len(particles))
        weights = [float(particle.weight) for particle in particles]
        require_finite(weights)
        return (*poses_of([one.pose for one in particles]), np.array(weights))

    def draw_read(self, read: Particles, wxyz: Wxyz, position: Vector3) -> None:
        """Draw the particles as they look now."""
        get = self.config.get
        turns, places, weights = read
        shortest, longest = float(get(SHORTEST)), float(get(LONGEST))
        lengths = shortest + weights.clip(0.0, 1.0) * max(0.0, longest - shortest)
        look = PoseLook(
            str(self.config.acting("Shape")),
            get("Color"),
            float(get("Alpha")),
            SHAFT,
            HEAD,
            SHAFT,
            1.0,
        )
        self._shapes.draw(look, turns, places, wxyz, position, sizes=lengths)

    def placed(self) -> Iterator[Placed]:
        """Yield the particles, which cannot be selected."""
        yield from self._shapes.placed(None)

    def remove(self) -> None:
        """Take the particles out of the scene."""
        self._shapes.remove()

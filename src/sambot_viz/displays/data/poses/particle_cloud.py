"""ParticleCloud of Nav2: the particles of a localisation, longer with their weights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from sambot_viz.displays.data.display_node import DisplayNode
from sambot_viz.displays.data.kept import Taken
from sambot_viz.displays.data.message_filter import MessageFilterDisplay
from sambot_viz.displays.data.message_numbers import (
    Floats,
    poses_of,
    require_few,
    require_finite,
)
from sambot_viz.displays.data.poses.pose_shapes import (
    PoseLook,
    PoseShapes,
    many_poses_properties,
)
from sambot_viz.displays.data.properties import metres
from sambot_viz.meanings import Meaning

SHORTEST, LONGEST = "Min Arrow Length", "Max Arrow Length"
SHAFT, HEAD = (1.0, 0.0435), (0.3043, 0.1304)
"""Length and diameter of shaft and head, by the length of the shaft."""
Particles = tuple[Floats, Floats, Floats]
"""Rotations, (N, 4), positions, (N, 3) [m], and weights, (N,)."""


class ParticleCloudDisplay(MessageFilterDisplay[Particles]):
    """The particles of nav2_msgs/ParticleCloud; the newest message alone."""

    kind = "nav2_rviz_plugins/ParticleCloud"
    meanings = frozenset({Meaning.PARTICLES})
    properties = (
        *many_poses_properties("particle"),
        metres(SHORTEST, 0.02, "Length of a particle without weight."),
        metres(LONGEST, 0.3, "Length of a particle with the weight 1."),
    )
    _shapes = DisplayNode(PoseShapes, "")

    def read(self, message: Any) -> Particles:
        """Return the rotations, the positions and the weights of the particles."""
        particles = message.particles
        require_few(len(particles))
        weights = [float(particle.weight) for particle in particles]
        require_finite(weights)
        return (*poses_of([one.pose for one in particles]), np.array(weights))

    def draw_kept(self, kept: Sequence[Taken[Particles]]) -> None:
        """Draw the particles as they look now."""
        get = self.config.get
        turns, places, weights = kept[-1].read
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
        self._shapes.draw(look, turns, places, *kept[-1].pose, sizes=lengths)

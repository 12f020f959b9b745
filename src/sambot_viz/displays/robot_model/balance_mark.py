"""The centre of mass in the view: a ball, its plumb line, and the support polygon."""

from __future__ import annotations

import numpy as np

from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.scene.lines import chain_segments
from sambot_viz.displays.scene.marks import BallMark, FaceMark, LinesMark
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.geometry import Matrix
from sambot_viz.robot.balance.balance import Balance

BALL_SHARE = 0.035
"""Radius of the ball by the longest side of the robot."""
USUAL_SIZE = 0.5
"""Longest side of a robot without shapes [m]."""
YELLOW: Rgb = (255, 210, 0)
STANDS: Rgb = (60, 220, 90)
FALLS: Rgb = (255, 60, 60)
FACE_ALPHA = 0.25
_STEP = 1e-6
"""A centre of mass that moves less stays where it is drawn [m]."""


class BalanceMark:
    """Draws the balance of a robot in the frame of its root link.

    Args:
        context: what to draw with.
        key: begins the names of all nodes.
    """

    def __init__(self, context: DisplayContext, key: str) -> None:
        self._context = context
        self._key = key
        self._above: str | None = None
        self._make("")

    def draw(self, root: str, found: Balance | None) -> None:
        """Draw the balance; unchanged nodes are not sent again.

        Args:
            root: the frame of the root link.
            found: the balance; None for a robot without a mass.
        """
        above = self._context.nodes.path(root)
        if found is None or above is None or not self._context.nodes.connected(root):
            self.remove()
            return
        if above != self._above:
            self.remove()
            self._make(above)
        self._above = above
        support, center = found.support, np.array(found.center)
        size = USUAL_SIZE if support is None else support.size
        x, y, z = (np.round(center / _STEP) * _STEP).tolist()
        radius = BALL_SHARE * size
        self._ball.draw(radius, YELLOW, (x, y, z))
        if support is None or found.fixed:
            self._lines.remove()
            self._face.remove()
            return
        tipping = found.tipping
        stands = tipping is not None and tipping.margin >= 0.0
        color = STANDS if stands else FALLS
        height = support.height
        corners = np.array([(*corner, height) for corner in support.polygon])
        lines = [_cross(x, y, z, height, radius)]
        if len(corners) > 1:
            lines.append(chain_segments(corners, closed=True))
        self._lines.draw(np.concatenate(lines), color)
        if len(corners) > 2:
            self._face.draw(corners, color, FACE_ALPHA)
        else:
            self._face.remove()

    def remove(self) -> None:
        """Take it out of the scene."""
        for node in (self._ball, self._lines, self._face):
            node.remove()
        self._above = None

    def _make(self, above: str) -> None:
        scene, name = self._context.scene, f"{above}/{self._key}"
        self._ball = BallMark(scene, f"{name}cm")
        self._lines = LinesMark(scene, f"{name}cl")
        self._face = FaceMark(scene, f"{name}cf")


def _cross(x: float, y: float, z: float, ground: float, arm: float) -> Matrix:
    """Return the fall of a point, and a cross where it meets the ground, (3, 2, 3)."""
    below = np.array((x, y, ground))
    ahead, aside = np.array((arm, 0.0, 0.0)), np.array((0.0, arm, 0.0))
    return np.array(
        [
            [(x, y, z), below],
            [below - ahead, below + ahead],
            [below - aside, below + aside],
        ]
    )

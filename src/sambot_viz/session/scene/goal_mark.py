"""The arrow at the goal that a robot is on its way to."""

from __future__ import annotations

import math

from sambot_viz.displays.scene.solid_nodes import ArrowsNode
from sambot_viz.publishing.outbound import GroundPose
from sambot_viz.publishing.publisher import Publisher
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change
from sambot_viz.tools.publish import GREEN, HEAD, SHAFT

ALPHA = 0.4
"""Transparent, because an opaque arrow is the one that the tool is drawing."""


class GoalMark:
    """Shows the last sent goal to everyone, until it has ended.

    Its node is below that of the goal's frame, so it moves with the frame.

    Args:
        publisher: sends goals, and reports their progress.
        scene: the scene to draw in.
        change: sends the drawing.
    """

    def __init__(self, publisher: Publisher, scene: Scene, change: Change) -> None:
        self._publisher, self._change = publisher, change
        self._context = scene.context
        self._node: ArrowsNode | None = None
        self._drawn: tuple[str, GroundPose] | None = None

    def draw(self) -> None:
        """Draw after there is something new of the goal, or of the frames."""
        wanted = self._wanted()
        is_gone = self._node is not None and self._node.is_gone
        if wanted == self._drawn and not is_gone:
            return
        with self._change():
            if self._node is not None:
                self._node.remove()
                self._node = None
            if wanted is not None:
                self._node = self._arrow(*wanted)
            self._drawn = wanted

    def _wanted(self) -> tuple[str, GroundPose] | None:
        """Return the node above the goal, and the goal; None where none is shown."""
        goals = self._publisher.goals
        goal = None if goals is None else goals.on_the_way
        if not isinstance(goal, GroundPose) or self._context.pose(goal.frame) is None:
            return None
        return self._context.above(goal.frame), goal

    def _arrow(self, above: str, goal: GroundPose) -> ArrowsNode:
        node = ArrowsNode(self._context.scene, f"{above}/~goal")
        half = goal.yaw / 2.0
        turn, place = (math.cos(half), 0.0, 0.0, math.sin(half)), (goal.x, goal.y, 0.0)
        node.draw([turn], [place], SHAFT, HEAD, GREEN, alpha=ALPHA)
        return node

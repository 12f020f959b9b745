"""The arrow that shows the positive direction of a joint while a user moves it."""

from __future__ import annotations

import time

import viser

from sambot_viz.displays.scene.direction_arrow import add_direction_arrow
from sambot_viz.displays.scene.node_cache import any_gone, remove_all
from sambot_viz.robot.parts import Joint
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.worker import Worker

SHOWN_FOR = 1.5
"""It is shown this long after the last move [s]."""


class JointArrow:
    """Shows one arrow, at the joint that a user moved last.

    It takes two moves within `SHOWN_FOR`, so that a single step of a slider stays one
    message.

    Args:
        scene: where it is drawn.
        worker: removes it again.
    """

    def __init__(self, scene: Scene, worker: Worker) -> None:
        self._context = scene.context
        self._worker = worker
        self._joint = ""
        self._moved_at = float("-inf")
        self._nodes: list[viser.ArrowsHandle] = []
        self._waiting = False

    def moved(self, joint: Joint) -> None:
        """Show the arrow of a joint that a user has moved."""
        now = time.monotonic()
        again = joint.name == self._joint and now - self._moved_at < SHOWN_FOR
        if joint.name != self._joint:
            self.hide()
        self._joint, self._moved_at = joint.name, now
        if again and (not self._nodes or any_gone(self._nodes)):
            self._draw(joint)
        if self._nodes and not self._waiting:
            self._waiting = True
            self._worker.post_later(SHOWN_FOR, self._late)

    def hide(self) -> None:
        """Remove the arrow from the scene."""
        remove_all(self._nodes)
        self._nodes.clear()
        self._joint = ""

    def _late(self) -> None:
        left = self._moved_at + SHOWN_FOR - time.monotonic()
        self._waiting = left > 0
        if self._waiting:
            self._worker.post_later(left, self._late)
        else:
            self.hide()

    def _draw(self, joint: Joint) -> None:
        path = self._context.nodes.path(joint.child.lstrip("/"))
        if path is None or not any(joint.axis):
            return
        self._nodes = [add_direction_arrow(self._context.scene, path, joint)]

"""The arrow that shows the positive direction of a joint while a user moves it."""

from __future__ import annotations

import math
import time

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.scene.nodes import any_gone, remove_all
from sambot_viz.robot.parts import Joint
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.worker import Worker

SHOWN_FOR = 1.5
"""It is shown this long after the last move [s]."""
COLOR = (255, 170, 0)
LENGTH = 0.25
"""Of the arrow along the axis [m]."""
ARC, ARC_PIECES = 1.5 * math.pi, 4
"""Angle of the arc about the axis [rad], and of how many arrows it is made."""

Points = npt.NDArray[np.float32]


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

    def place(self, joint: Joint) -> list[str | float]:
        """Return the last part of the name of its link's node, and the axis there."""
        path = self._context.nodes.path(joint.child.lstrip("/"))
        return [(path or "").rpartition("/")[2], *joint.axis]

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
        arrows = self._context.scene.add_arrows(
            f"{path}/~positive",
            _arrows(joint),
            COLOR,
            shaft_radius=0.006,
            head_radius=0.02,
            head_length=0.04,
        )
        self._nodes = [arrows]


def _arrows(joint: Joint) -> Points:
    """Return (N, 2, 3) starts and ends in the child frame [m].

    One along the axis; for a joint that turns also an arc about it (right-hand rule).
    """
    axis = np.array(joint.axis, dtype=np.float64)
    straight = np.array([[np.zeros(3), axis * LENGTH]])
    if joint.type == "prismatic":
        return straight.astype(np.float32)
    across = np.cross(axis, (1.0, 0.0, 0.0) if abs(axis[0]) < 0.9 else (0.0, 1.0, 0.0))
    across /= np.linalg.norm(across)
    third = np.cross(axis, across)
    angle = np.linspace(0.0, ARC, ARC_PIECES + 1)[:, None]
    ring = 0.6 * LENGTH * (np.cos(angle) * across + np.sin(angle) * third)
    ring += 0.5 * LENGTH * axis
    turn = np.stack([ring[:-1], ring[1:]], axis=1)
    return np.concatenate([straight, turn]).astype(np.float32)

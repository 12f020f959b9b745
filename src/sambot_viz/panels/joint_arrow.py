"""The arrow at a joint that shows its positive direction while its slider moves."""

from __future__ import annotations

import math
import time

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.scene.kept_nodes import any_gone, remove_all
from sambot_viz.robot.joint import Joint
from sambot_viz.session import Session

SHOWN_FOR = 1.5
"""So long after the last move of the slider it is there [s]."""
COLOR = (255, 170, 0)
LENGTH = 0.25
ARC, ARC_PIECES = 1.5 * math.pi, 4

Points = npt.NDArray[np.float32]


class JointArrow:
    """One arrow, at the joint whose slider moved last.

    A single step of a slider shows none: it takes two within `SHOWN_FOR`, so that one
    step is one message.

    Args:
        session: whose joints these are.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._joint = ""
        self._moved_at = float("-inf")
        self._nodes: list[viser.ArrowsHandle] = []
        self._waiting = False

    def moved(self, joint: Joint) -> None:
        """A slider was moved."""
        now = time.monotonic()
        again = joint.name == self._joint and now - self._moved_at < SHOWN_FOR
        if joint.name != self._joint:
            self.hide()
        self._joint, self._moved_at = joint.name, now
        if again and (not self._nodes or any_gone(self._nodes)):
            self._draw(joint)
        if self._nodes and not self._waiting:
            self._waiting = True
            self._session.worker.post_later(SHOWN_FOR, self._late)

    def hide(self) -> None:
        """Take it out of the scene."""
        remove_all(self._nodes)
        self._nodes.clear()
        self._joint = ""

    def _late(self) -> None:
        left = self._moved_at + SHOWN_FOR - time.monotonic()
        self._waiting = left > 0
        if self._waiting:
            self._session.worker.post_later(left, self._late)
        else:
            self.hide()

    def _draw(self, joint: Joint) -> None:
        context = self._session.context
        path = context.nodes.path(joint.child.lstrip("/"))
        if path is None or not any(joint.axis):
            return
        node = self._session.audience.scene.add_arrows(
            f"{path}/~positive",
            arrow_points(joint),
            COLOR,
            shaft_radius=0.006,
            head_radius=0.02,
            head_length=0.04,
        )
        self._nodes = [node]


def arrow_points(joint: Joint) -> Points:
    """(N, 2, 3) starts and ends in the child frame [m].

    The axis; and for a joint that turns, a turn about it by the right hand.
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

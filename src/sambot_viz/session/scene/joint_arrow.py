"""The arrow that shows the positive direction of a joint while a user moves it."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.displays.scene.frame_nodes import any_gone, remove_all
from sambot_viz.robot.parts import Joint
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.worker import Worker

SHOWN_FOR = 1.5
"""It is shown this long after the last move [s]."""
COLOR = (255, 170, 0)
LENGTH = 0.25
"""Of the arrow along the axis [m]."""
ARC, ARC_PIECES = 1.5 * math.pi, 36
"""Angle of the arc about the axis [rad], and of how many lines it is made."""
HEADS = (0.5, 1.0)
"""Where on the arc its heads end."""
SHAFT, HEAD = 0.006, 0.04
"""Radius of a shaft, and length of a head [m]."""

Points = npt.NDArray[np.float32]
Array = npt.NDArray[np.float64]


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
        self._nodes: list[viser.SceneNodeHandle] = []
        self._waiting = False

    def place(self, joint: Joint) -> list[str | float]:
        """Return the last part of the name of its link's node, and the axis there."""
        path = self._context.nodes.path(joint.child.lstrip("/"))
        return [(path or "").rpartition("/")[2], *joint.axis]

    def moved(self, joint: Joint) -> None:
        """Show the arrow of a joint that a user has moved."""
        now = self._worker.clock.now()
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
        left = self._moved_at + SHOWN_FOR - self._worker.clock.now()
        self._waiting = left > 0
        if self._waiting:
            self._worker.post_later(left, self._late)
        else:
            self.hide()

    def _draw(self, joint: Joint) -> None:
        path = self._context.nodes.path(joint.child.lstrip("/"))
        if path is None or not any(joint.axis):
            return
        scene = self._context.scene
        ring = None if joint.type == "prismatic" else _arc(joint)
        arrows = scene.add_arrows(
            f"{path}/~positive",
            _arrows(joint, ring),
            COLOR,
            shaft_radius=SHAFT,
            head_radius=0.02,
            head_length=HEAD,
        )
        self._nodes = [arrows]
        if ring is not None:
            lines = np.stack([ring[:-1], ring[1:]], axis=1)
            arc = scene.add_line_segments(
                f"{path}/~turn", lines, COLOR, thickness=2 * SHAFT
            )
            self._nodes.append(arc)


def _arrows(joint: Joint, ring: Points | None) -> Points:
    """Return (N, 2, 3) starts and ends in the child frame [m].

    One along the axis; for a joint that turns also the heads of its arc.
    """
    axis = np.array(joint.axis, dtype=np.float64)
    arrows = [(np.zeros(3), axis * LENGTH)]
    if ring is not None:
        for last in (round(part * ARC_PIECES) for part in HEADS):
            way: Array = np.subtract(ring[last], ring[last - 1], dtype=np.float64)
            head = HEAD * way / np.linalg.norm(way)
            tip = ring[last] + 0.5 * head
            # All of it is a head, but for a shaft of 0.4 mm.
            arrows.append((tip - 1.01 * head, tip))
    return np.array(arrows, np.float32)


def _arc(joint: Joint) -> Points:
    """Return (N, 3) points of an arc about the axis (right-hand rule) [m]."""
    axis = np.array(joint.axis, dtype=np.float64)
    across = np.cross(axis, (1.0, 0.0, 0.0) if abs(axis[0]) < 0.9 else (0.0, 1.0, 0.0))
    across /= np.linalg.norm(across)
    third = np.cross(axis, across)
    angle = np.linspace(0.0, ARC, ARC_PIECES + 1)[:, None]
    ring = 0.6 * LENGTH * (np.cos(angle) * across + np.sin(angle) * third)
    ring += 0.5 * LENGTH * axis
    return ring.astype(np.float32)

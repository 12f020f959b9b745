"""Arrows that show the positive direction of a joint."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz.robot.parts import Joint

COLOR = (255, 170, 0)
LENGTH = 0.25
ARC, ARC_PIECES = 1.5 * math.pi, 4

Points = npt.NDArray[np.float32]


def add_direction_arrow(
    scene: viser.SceneApi, path: str, joint: Joint
) -> viser.ArrowsHandle:
    """Add the arrows of a joint below the node of its child frame.

    Args:
        scene: where to draw.
        path: name of the node of the child frame.
        joint: a joint with an axis.
    """
    return scene.add_arrows(
        f"{path}/~positive",
        arrow_points(joint),
        COLOR,
        shaft_radius=0.006,
        head_radius=0.02,
        head_length=0.04,
    )


def arrow_points(joint: Joint) -> Points:
    """(N, 2, 3) starts and ends in the child frame [m].

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

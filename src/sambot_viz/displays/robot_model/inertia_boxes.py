"""Masses and inertias of <inertial> elements, as RViz draws them.

A mass is the ball of lead that has it; an inertia is the box of that mass with the
same principal moments.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.geometry import Matrix, Vector3, Wxyz, wxyz_from_matrix
from sambot_viz.robot.parts import Inertial

LEAD_DENSITY = 11340.0
"""[kg/m³]"""


@dataclass(frozen=True, slots=True)
class InertiaBox:
    """A box that has the inertia of a link.

    Attributes:
        size: edge lengths [m].
        wxyz: its rotation in the link.
        position: its centre in the link [m].
    """

    size: Vector3
    wxyz: Wxyz
    position: Vector3


def ball_diameter(mass: float) -> float:
    """Return the diameter of a ball of lead [m]; 0 for a mass of 0 or less.

    Args:
        mass: [kg].
    """
    if mass <= 0:
        return 0.0
    return 2 * (0.75 * mass / (math.pi * LEAD_DENSITY)) ** (1 / 3)


def inertia_box(inertial: Inertial) -> InertiaBox | None:
    """Return the box of the same mass and moments.

    Args:
        inertial: mass [kg], pose of the centre of mass, inertia [kg m²].

    Returns:
        None for moments that a body cannot have: a mass of 0, a tensor that is not
        positive definite, or one moment greater than the other two together.
    """
    i = inertial
    tensor = np.array([[i.ixx, i.ixy, i.ixz], [i.ixy, i.iyy, i.iyz], [0, i.iyz, i.izz]])
    tensor[2, 0] = i.ixz
    if i.mass <= 0 or not np.isfinite(tensor).all():
        return None
    moments, axes = np.linalg.eigh(tensor)
    one, two, three = (float(moment) for moment in moments)
    # The moments are sorted. Rounding must not refuse a plate, where they are equal.
    if one <= 0 or one + two < three * (1 - 1e-6):
        return None
    if np.linalg.det(axes) < 0:
        axes[:, 0] *= -1
    turned: Matrix = np.eye(4)
    turned[:3, :3] = axes
    T = i.origin.matrix @ turned
    size = (
        _edge(two + three - one, i.mass),
        _edge(three + one - two, i.mass),
        _edge(one + two - three, i.mass),
    )
    return InertiaBox(size, wxyz_from_matrix(T), position_of(T))


def _edge(moments: float, mass: float) -> float:
    return math.sqrt(max(0.0, 6 * moments / mass))

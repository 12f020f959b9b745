"""Masses as balls and inertias as boxes."""

from __future__ import annotations

import numpy as np
import pytest

from sambot_viz.displays.robot_model.inertia_boxes import ball_diameter, inertia_box
from sambot_viz.robot.parts import Inertial, Origin


def inertial(mass: float, *moments: float, origin: Origin | None = None) -> Inertial:
    ixx, iyy, izz = moments
    return Inertial(mass, origin or Origin(), ixx, 0.0, 0.0, iyy, 0.0, izz)


def test_a_kilogram_of_lead_is_a_ball_of_five_and_a_half_centimetres() -> None:
    assert ball_diameter(1.0) == pytest.approx(0.0552, abs=5e-5)
    assert ball_diameter(0.0) == ball_diameter(-1.0) == 0.0


def test_the_box_of_a_boxs_inertia_is_that_box() -> None:
    size, mass = np.array([0.4, 0.2, 0.1]), 3.0
    x, y, z = size**2
    box = inertia_box(
        inertial(mass, mass / 12 * (y + z), mass / 12 * (x + z), mass / 12 * (x + y))
    )
    assert box is not None
    assert sorted(box.size) == pytest.approx(sorted(size))
    assert np.linalg.norm(box.wxyz) == pytest.approx(1.0)


def test_a_plate_is_allowed_to_be_flat() -> None:
    box = inertia_box(inertial(1.0, 1.0, 1.0, 2.0))
    assert box is not None
    assert min(box.size) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(
    ("mass", "moments"),
    [(0.0, (1, 1, 1)), (1.0, (0, 1, 1)), (1.0, (1, 1, 3)), (1.0, (1, float("nan"), 1))],
)
def test_what_no_body_can_have_has_no_box(
    mass: float, moments: tuple[float, ...]
) -> None:
    assert inertia_box(inertial(mass, *moments)) is None


def test_the_box_stands_at_the_centre_of_mass() -> None:
    box = inertia_box(inertial(1, 1, 1, 1, origin=Origin((1.0, 2.0, 3.0))))
    assert box is not None
    assert box.position == (1.0, 2.0, 3.0)

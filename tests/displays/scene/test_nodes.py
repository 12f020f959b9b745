"""Matrices to quaternions, checked by turning them back."""

from __future__ import annotations

import random

import numpy as np
import pytest

from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.geometry import wxyz_from_matrix, wxyz_from_z
from sambot_viz.matrices import inverse_matrix, wxyzs_from_matrices
from sambot_viz.robot.parts import Origin


def rotation(wxyz: tuple[float, float, float, float]) -> np.ndarray:
    w, x, y, z = wxyz
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def test_every_rotation_survives_the_way_there_and_back() -> None:
    source = random.Random(7)
    for _ in range(200):
        rpy = tuple(source.uniform(-4, 4) for _ in range(3))
        T = Origin(rpy=(rpy[0], rpy[1], rpy[2])).matrix
        assert np.allclose(rotation(wxyz_from_matrix(T)), T[:3, :3], atol=1e-12)


def test_many_rotations_at_once_are_the_same_to_the_last_digit() -> None:
    source = random.Random(4)
    turns = [[source.uniform(-4, 4) for _ in range(3)] for _ in range(100)]
    matrices = [Origin(rpy=(r, p, y)).matrix for r, p, y in [*turns, [np.pi, 0, 0]]]
    each = [wxyz_from_matrix(T) for T in matrices]
    assert wxyzs_from_matrices(np.array(matrices)) == each


@pytest.mark.parametrize("half_turn", [(np.pi, 0, 0), (0, np.pi, 0), (0, 0, np.pi)])
def test_half_turns_lose_no_digits(half_turn: tuple[float, float, float]) -> None:
    T = Origin(rpy=half_turn).matrix
    assert np.allclose(rotation(wxyz_from_matrix(T)), T[:3, :3], atol=1e-12)


@pytest.mark.parametrize("direction", [(0, 0, 2), (0, 0, -3), (1, 2, -3), (-1, 0, 0)])
def test_z_is_turned_into_any_direction(direction: tuple[float, float, float]) -> None:
    turned = rotation(wxyz_from_z(direction)) @ np.array([0.0, 0.0, 1.0])
    assert np.allclose(turned, np.array(direction) / np.linalg.norm(direction))


def test_the_inverse_undoes_a_pose() -> None:
    T = Origin((1.0, 2.0, 3.0), (0.3, -0.2, 1.1)).matrix
    assert np.allclose(inverse_matrix(T) @ T, np.eye(4))


@pytest.mark.parametrize(
    ("metres", "shown"),
    [(1.5, 1.5), (1e308, 1e30), (-1e308, -1e30), (np.inf, 1e30), (np.nan, 0.0)],
)
def test_a_position_is_finite_for_a_browser_whatever_it_was(
    metres: float, shown: float
) -> None:
    T = np.eye(4)
    T[:3, 3] = (metres, 0.0, metres)
    assert position_of(T) == (shown, 0.0, shown)

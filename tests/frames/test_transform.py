"""Transforms: direction, angles at the poles, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from close import is_close

from sambot_viz.errors import FrameError
from sambot_viz.frames import Transform, TransformRefused


def test_a_transform_takes_child_coordinates_to_the_parent() -> None:
    T_base_laser = Transform.from_xyz_rpy((0.1, 0.0, 0.2), (0, 0, math.pi / 2))
    # One metre ahead of the laser is one metre to the left of the base.
    point = T_base_laser.matrix @ (1.0, 0.0, 0.0, 1.0)
    assert np.allclose(point, (0.1, 1.0, 0.2, 1.0), atol=1e-12)


def test_composition_reads_from_left_to_right() -> None:
    T_map_odom = Transform.from_xyz_rpy((1, 0, 0), (0, 0, math.pi / 2))
    T_odom_base = Transform.from_xyz_rpy((2, 0, 0))
    assert np.allclose((T_map_odom @ T_odom_base).translation, (1, 2, 0))
    assert is_close((T_map_odom @ T_map_odom.inverse()), Transform.identity(), 1e-15)


def test_rpy_turns_about_fixed_axes_roll_first() -> None:
    roll, pitch, yaw = 0.3, -0.4, 2.5
    T = Transform.from_xyz_rpy(rpy=(roll, pitch, yaw))
    about_x = Transform.from_xyz_rpy(rpy=(roll, 0, 0))
    about_y = Transform.from_xyz_rpy(rpy=(0, pitch, 0))
    about_z = Transform.from_xyz_rpy(rpy=(0, 0, yaw))
    assert is_close(T, about_z @ about_y @ about_x, 1e-15)


@pytest.mark.parametrize("pitch", [-1.5, -1e-7, 0.0, 0.7, math.pi / 2 - 1e-6])
def test_rpy_comes_back_as_it_went_in(pitch: float) -> None:
    rpy = (0.3, pitch, -2.9)
    assert Transform.from_xyz_rpy(rpy=rpy).rpy == pytest.approx(rpy, abs=1e-9)


def test_at_a_pitch_of_plus_90_degrees_roll_carries_roll_minus_yaw() -> None:
    rpy = Transform.from_xyz_rpy(rpy=(0.3, math.pi / 2, 0.4)).rpy
    assert rpy == pytest.approx((-0.1, math.pi / 2, 0.0), abs=1e-12)


def test_at_a_pitch_of_minus_90_degrees_roll_carries_roll_plus_yaw() -> None:
    rpy = Transform.from_xyz_rpy(rpy=(0.3, -math.pi / 2, 0.4)).rpy
    assert rpy == pytest.approx((0.7, -math.pi / 2, 0.0), abs=1e-12)


@pytest.mark.parametrize("seed", range(20))
def test_the_poles_give_angles_that_make_the_same_rotation(seed: int) -> None:
    random = np.random.default_rng(seed)
    roll, yaw = random.uniform(-3, 3, 2)
    pitch = random.choice((-1, 1)) * (math.pi / 2 - 10.0 ** -random.integers(5, 18))
    T = Transform.from_xyz_rpy(rpy=(roll, pitch, yaw))
    assert is_close(Transform.from_xyz_rpy(rpy=T.rpy), T, 2e-9)


@pytest.mark.parametrize("seed", range(30))
def test_a_quaternion_comes_back_as_it_went_in_up_to_its_sign(seed: int) -> None:
    xyzw = np.random.default_rng(seed).normal(size=4)
    xyzw /= np.linalg.norm(xyzw)
    back = Transform.from_xyz_xyzw((0, 0, 0), xyzw.tolist()).rotation_xyzw
    assert min(np.abs(back - xyzw).max(), np.abs(back + xyzw).max()) < 1e-15


def test_the_sign_of_a_quaternion_is_that_of_the_real_publisher() -> None:
    # robot_state_publisher with a continuous joint about z at 10 rad.
    # The static publisher makes the same rotation from half angles.
    T = Transform.from_xyz_rpy(rpy=(0, 0, 10))
    joint = Transform(T.matrix)
    assert joint.rotation_xyzw == pytest.approx((0, 0, 0.9589, -0.2837), abs=5e-5)
    assert T.rotation_xyzw == pytest.approx((0, 0, -0.9589, 0.2837), abs=5e-5)


def test_a_quaternion_within_tf2s_tolerance_is_made_length_one() -> None:
    T = Transform.from_xyz_xyzw((0, 0, 0), (0, 0, 0.7071, 0.7071))
    assert np.allclose(T.matrix[:3, :3] @ T.matrix[:3, :3].T, np.eye(3), atol=1e-15)
    assert T.rpy[2] == pytest.approx(math.pi / 2, abs=1e-12)


def test_a_quaternion_of_another_length_is_refused_by_its_tf2_name() -> None:
    with pytest.raises(TransformRefused) as caught:
        Transform.from_xyz_xyzw((0, 0, 0), (0, 0, 1, 1))
    assert caught.value.tf2_name == "TF_DENORMALIZED_QUATERNION"
    assert str(caught.value) == (
        "TF_DENORMALIZED_QUATERNION: the quaternion (0, 0, 1, 1) has the length 1.414, "
        "and a rotation needs length 1"
    )


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_numbers_that_are_not_finite_are_refused_by_their_tf2_name(bad: float) -> None:
    matrix = np.eye(4)
    matrix[0, 3] = bad
    for make in (
        lambda: Transform.from_xyz_rpy((bad, 0, 0)),
        lambda: Transform.from_xyz_rpy(rpy=(0, bad, 0)),
        lambda: Transform.from_xyz_xyzw((0, 0, 0), (0, 0, bad, 1)),
        lambda: Transform(matrix),
    ):
        with pytest.raises(TransformRefused, match=r"^TF_NAN_INPUT: "):
            make()


@pytest.mark.parametrize(
    "matrix", [np.eye(3), np.zeros((4, 4)), np.diag((1, 1, -1, 1)), np.ones((4, 4))]
)
def test_only_rigid_motions_are_transforms(matrix: np.ndarray) -> None:
    with pytest.raises(FrameError):
        Transform(matrix)


def test_a_transform_cannot_be_changed_and_does_not_follow_its_source() -> None:
    matrix = np.eye(4)
    T = Transform(matrix)
    matrix[0, 3] = 5.0
    assert T.translation[0] == 0.0
    for array in (T.matrix, T.translation, T.rotation_xyzw, (T @ T).matrix):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


def test_equal_transforms_are_equal_keys() -> None:
    one = Transform.from_xyz_rpy((0.0, 1, 2))
    other = Transform.from_xyz_rpy((-0.0, 1, 2))
    assert one == other
    assert len({one, other}) == 1
    assert one != Transform.from_xyz_rpy((0, 1, 2.1))
    assert one != "a transform"


def test_a_transform_prints_what_a_reader_wants_to_know() -> None:
    T = Transform.from_xyz_rpy((0.1, 0, 0.2), (0, 0, 1.5))
    assert repr(T) == "Transform(xyz=(0.1, 0, 0.2), rpy=(0, 0, 1.5))"

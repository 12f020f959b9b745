"""Driving on two wheels: exact arcs, wheel angles, and finding the wheels."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sambot_viz.drive.differential import DifferentialDrive, PlanarPose, WheelPair, arc
from sambot_viz.errors import JointError

SAM_BOT = WheelPair("l", "r", radius=0.1, separation=0.36)


def at(pose: PlanarPose) -> tuple[float, float, float]:
    return (pose.x, pose.y, pose.yaw)


def test_a_square_returns_to_the_start() -> None:
    drive = DifferentialDrive(SAM_BOT)
    for _ in range(4):
        drive.step(0.5, 0.0, 4.0)
        drive.step(0.0, math.pi / 2, 1.0)
    assert at(drive.pose) == pytest.approx((0, 0, 2 * math.pi), abs=1e-12)


def test_a_square_with_round_corners_in_small_steps_returns_to_the_start() -> None:
    drive = DifferentialDrive(SAM_BOT)
    for _ in range(4):
        for _ in range(1000):
            drive.step(0.5, 0.0, 0.002)
        for _ in range(1000):
            drive.step(0.5, math.pi / 2, 0.001)
    assert at(drive.pose) == pytest.approx((0, 0, 2 * math.pi), abs=1e-9)


def test_a_square_also_returns_when_the_robot_turns_about_a_point_behind_it() -> None:
    wheels = WheelPair("l", "r", 0.1, 0.36, middle=PlanarPose(-0.12, 0.0, 0.3))
    drive = DifferentialDrive(wheels)
    for _ in range(4):
        drive.step(0.5, 0.0, 4.0)
        drive.step(0.0, math.pi / 2, 1.0)
    assert at(drive.pose) == pytest.approx((0, 0, 2 * math.pi), abs=1e-12)


def test_turning_on_the_spot_carries_the_root_round_the_wheels() -> None:
    drive = DifferentialDrive(
        WheelPair("l", "r", 0.1, 0.36, middle=PlanarPose(-0.12, 0.0))
    )
    drive.step(0.0, math.pi, 1.0)
    assert at(drive.pose) == pytest.approx((-0.24, 0.0, math.pi), abs=1e-15)
    assert drive.trail == ((-0.12, 0.0),)


def test_the_circle_has_the_radius_v_over_w() -> None:
    drive = DifferentialDrive(SAM_BOT)
    centre = np.array((0.0, 0.8))
    for _ in range(50):
        pose = drive.step(0.4, 0.5, 0.37).pose
        distance = np.hypot(*(np.array((pose.x, pose.y)) - centre))
        assert distance == pytest.approx(0.8, abs=1e-12)


@pytest.mark.parametrize("turned", [0.0, 1e-12, 1e-8, 1.1e-8, 1e-4, 0.5, -2.0, 7.0])
def test_one_long_arc_is_many_short_ones(turned: float) -> None:
    whole, parts = arc(2.0, turned), PlanarPose()
    for _ in range(64):
        parts = parts @ arc(2.0 / 64, turned / 64)
    assert at(parts) == pytest.approx(at(whole), abs=1e-13)


def test_the_wheels_turn_as_far_as_they_roll() -> None:
    drive = DifferentialDrive(SAM_BOT)
    assert drive.step(1.0, 0.0, 0.5).wheels == pytest.approx({"l": 5.0, "r": 5.0})
    # On the spot each wheel rolls along a circle of half the separation.
    turned = drive.step(0.0, 1.0, 2 * math.pi).wheels
    assert turned["r"] == pytest.approx(2 * math.pi * 0.18 / 0.1)
    assert turned["l"] == -turned["r"]


def test_a_wheel_with_its_axis_the_other_way_turns_the_other_way() -> None:
    wheels = WheelPair("l", "r", 0.1, 0.36, left_sign=1.0, right_sign=-1.0)
    turned = DifferentialDrive(wheels).step(1.0, 0.0, 0.5).wheels
    assert turned == pytest.approx({"l": 5.0, "r": -5.0})


def test_the_inverse_of_a_pose_undoes_it() -> None:
    pose = PlanarPose(1.0, -2.0, 0.7)
    assert at(pose @ pose.inverse()) == pytest.approx((0, 0, 0), abs=1e-15)
    assert at(pose.inverse() @ pose) == pytest.approx((0, 0, 0), abs=1e-15)


def test_the_trail_has_a_point_every_few_centimetres_and_an_end() -> None:
    drive = DifferentialDrive(SAM_BOT, trail_step=0.1, trail_length=5)
    for _ in range(100):
        drive.step(0.5, 0.0, 0.025)
    assert len(drive.trail) == 5
    assert drive.trail[-1][0] - drive.trail[-2][0] == pytest.approx(0.1, abs=0.0126)
    drive.reset()
    assert drive.trail == ((0.0, 0.0),)
    assert drive.pose == PlanarPose()


def test_a_full_trail_becomes_shorter_so_that_new_points_are_drawn() -> None:
    drive = DifferentialDrive(SAM_BOT, trail_step=0.1, trail_length=10)
    lengths: list[int] = []
    for _ in range(100):
        drive.step(0.5, 0.0, 0.25)
        lengths.append(len(drive.trail))
    assert set(lengths[20:]) == {9, 10}


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_step_that_is_no_number_moves_nothing(bad: float) -> None:
    drive = DifferentialDrive(SAM_BOT)
    for v, w, dt in ((bad, 0, 1), (0, bad, 1), (1, 0, bad), (1e200, 0, 1e200)):
        with pytest.raises(JointError, match=r"^cannot drive with "):
            drive.step(v, w, dt)
    assert drive.pose == PlanarPose()


def test_measures_that_make_no_sense_are_refused() -> None:
    with pytest.raises(JointError, match=r"^the radius of the wheels is 0\.0 m: "):
        WheelPair("l", "r", 0.0, 0.36)
    with pytest.raises(JointError, match=r"^the separation of the wheels is nan m: "):
        WheelPair("l", "r", 0.1, math.nan)
    with pytest.raises(JointError, match="both the left and right wheel"):
        WheelPair("l", "l", 0.1, 0.3)

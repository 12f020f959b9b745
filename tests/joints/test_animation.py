"""Motion by itself: wheels that keep turning."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from sambot_viz.errors import JointError
from sambot_viz.joints import JointState
from sambot_viz.joints.animation import turn, wrap_angle
from sambot_viz.robot.model import Robot

MakeRobot = Callable[..., Robot]


def test_a_wheel_keeps_turning_and_counts_its_turns(arm: Robot) -> None:
    state = JointState(arm)
    for _ in range(10):
        state.set_all(turn(state, {"wheel": 3.0}, dt=0.5))
    assert state.positions["wheel"] == 15.0


def test_a_wheel_can_be_kept_within_one_turn(arm: Robot) -> None:
    state = JointState(arm)
    state.set("wheel", 3.0)
    wrapped = turn(state, {"wheel": 1.0}, dt=0.5, wrap=True)
    assert wrapped["wheel"] == pytest.approx(3.5 - 2 * math.pi)


def test_a_limited_joint_stops_at_its_limit_and_can_come_back_from_outside(
    arm: Robot,
) -> None:
    state = JointState(arm)
    assert turn(state, {"j": 100.0}, dt=1.0) == {"j": 2.0}
    state.set("j", 3.0)
    assert turn(state, {"j": 1.0}, dt=1.0) == {"j": 3.0}
    assert turn(state, {"j": -0.5}, dt=1.0) == {"j": 2.5}


def test_a_velocity_that_is_no_number_or_for_a_follower_is_refused(arm: Robot) -> None:
    state = JointState(arm)
    for velocities in ({"wheel": math.inf}, {"k": 1.0}, {"weel": 1.0}):
        with pytest.raises(JointError):
            turn(state, velocities, dt=0.1)
    with pytest.raises(JointError, match="cannot be set to nan"):
        turn(state, {"wheel": 1.0}, dt=math.nan)


@pytest.mark.parametrize("turns", [-3, -1, 0, 1, 2])
@pytest.mark.parametrize("angle", [-math.pi, -1.0, 0.0, 3.0])
def test_wrapping_keeps_the_direction(angle: float, turns: int) -> None:
    wrapped = wrap_angle(angle + turns * 2 * math.pi)
    assert math.isclose(math.cos(wrapped), math.cos(angle), abs_tol=1e-12)
    assert math.isclose(math.sin(wrapped), math.sin(angle), abs_tol=1e-12)
    assert -math.pi <= wrapped <= math.pi

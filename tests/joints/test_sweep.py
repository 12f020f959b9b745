"""The motion that shows every joint of a robot."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import pytest

from sambot_viz.joints import JointState
from sambot_viz.joints.animation import LONGEST, sweep
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint, Limit

MakeRobot = Callable[..., Robot]


def chain(make_robot: MakeRobot, count: int, kind: str = "revolute") -> Robot:
    joints = [
        Joint(f"j{n}", kind, f"l{n}", f"l{n + 1}", limit=Limit(-1.0, 2.0))  # type: ignore[arg-type]
        for n in range(count)
    ]
    return make_robot(*joints)


def test_a_joint_goes_to_both_limits_and_back_to_where_it_was(
    make_robot: MakeRobot,
) -> None:
    state = JointState(chain(make_robot, 2))
    state.set("j0", 0.5)
    at = {name: [value] for name, value in state.positions.items()}
    for _, moved in sweep(state, 1 / 30):
        assert len(moved) <= 1, "one after the other"
        for name, value in moved.items():
            at[name].append(value)
    assert state.positions == {"j0": 0.5, "j1": 0.0}
    for name, first in (("j0", 0.5), ("j1", 0.0)):
        values = at[name]
        assert values[-1] == pytest.approx(first, abs=0.01)
        assert max(values) == pytest.approx(2.0, abs=0.1)
        assert min(values) == pytest.approx(-1.0, abs=0.1)
        assert min(values) >= -1.0 and max(values) <= 2.0
        assert max(abs(b - a) for a, b in pairwise(values)) < 0.2


def test_a_continuous_joint_turns_once(make_robot: MakeRobot) -> None:
    state = JointState(chain(make_robot, 1, "continuous"))
    values = [moved["j0"] for _, moved in sweep(state, 1 / 30) if moved]
    assert max(values) == pytest.approx(2 * math.pi, abs=0.05)
    assert values[-1] in (0.0, pytest.approx(2 * math.pi, abs=0.01))
    turning = values[:-1]
    assert turning == sorted(turning)


@pytest.mark.parametrize("count", [1, 8, 32, 300])
def test_the_motion_of_many_joints_takes_no_longer(
    make_robot: MakeRobot, count: int
) -> None:
    state = JointState(chain(make_robot, count))
    steps = list(sweep(state, 1 / 30))
    times = [time for time, _ in steps]
    assert times[-1] <= LONGEST
    assert times == sorted(times)
    assert {name for _, moved in steps for name in moved} == set(state.free)
    last = dict(state.positions)
    for _, moved in steps:
        last |= moved
    assert last == pytest.approx(dict(state.positions), abs=1e-9)


def test_a_robot_without_joints_does_not_move(make_robot: MakeRobot) -> None:
    assert list(sweep(JointState(make_robot()), 1 / 30)) == []

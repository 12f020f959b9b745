"""The pose a robot begins with."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from sambot_viz.errors import JointError
from sambot_viz.joints.presets import StartPose
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint, Mimic

MakeRobot = Callable[..., Robot]


@pytest.fixture
def gripper(make_robot: MakeRobot) -> Robot:
    return make_robot(
        Joint("finger", "prismatic", "a", "b"),
        Joint("thumb", "prismatic", "b", "c", mimic=Mimic("finger", -1.0, 0.01)),
    )


def test_a_message_may_contain_a_joint_that_mimics(gripper: Robot) -> None:
    recorded = {"finger": 0.02, "thumb": -0.0100004, "unknown": 1.0}
    state = StartPose(recorded=recorded).state(gripper)
    assert state.all_positions() == {"finger": 0.02, "thumb": pytest.approx(-0.01)}
    assert state.problems == ()


def test_an_argument_for_a_joint_that_mimics_is_taken_when_it_agrees(
    gripper: Robot,
) -> None:
    state = StartPose(positions={"thumb": -0.01, "finger": 0.02}).state(gripper)
    assert state.problems == ()


@pytest.mark.parametrize("given", ["recorded", "positions"])
def test_a_value_that_disagrees_is_a_warning_with_both_values(
    gripper: Robot, given: str
) -> None:
    values = {"finger": 0.02, "thumb": 0.5}
    (problem,) = StartPose(**{given: values}).state(gripper).problems
    assert (problem.severity, problem.code) == ("warning", "mimic-joint-disagrees")
    assert problem.message == (
        "joint 'thumb' was given 0.5, but it mimics 'finger' and so is at -0.01"
    )
    assert problem.hint == "set 'finger' instead"


def test_an_unknown_joint_in_an_argument_is_an_error(gripper: Robot) -> None:
    with pytest.raises(JointError, match="no joint 'fingr'; did you mean 'finger'"):
        StartPose(positions={"fingr": 1.0}).state(gripper)

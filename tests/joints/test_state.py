"""Joint states: joint_state_publisher's rules."""

from __future__ import annotations

import math
from collections.abc import Callable
from random import Random

import pytest

from sambot_viz.errors import JointError
from sambot_viz.joints import JointState
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint, Limit, Mimic, SoftLimit

MakeRobot = Callable[..., Robot]


def test_joints_come_in_document_order_with_mimic_joints_among_them(arm: Robot) -> None:
    state = JointState(arm)
    assert list(state.all_positions()) == ["l", "wheel", "k", "j", "lift", "stuck"]
    assert state.free == ("wheel", "j", "lift", "stuck")


def test_a_joint_with_one_point_of_range_is_published_but_has_no_slider(
    arm: Robot,
) -> None:
    assert JointState(arm).sliders == ("wheel", "j", "lift")
    assert JointState(arm).positions["stuck"] == 0.5


def test_fixed_floating_and_planar_joints_are_skipped_and_say_so(arm: Robot) -> None:
    assert dict(JointState(arm).skipped) == {
        "mast": "fixed: has no position in ROS",
        "free": "floating: has no position in ROS",
        "table": "planar: has no position in ROS",
    }


def test_a_joint_starts_at_zero_or_in_the_middle_of_a_range_without_zero(
    arm: Robot,
) -> None:
    assert JointState(arm).positions == {"wheel": 0, "j": 0, "lift": 2, "stuck": 0.5}


def test_soft_limits_count_for_range_and_start(
    make_robot: MakeRobot,
) -> None:
    limit, soft_limit = Limit(-1, 1), SoftLimit(lower=0.2, upper=0.6)
    robot = make_robot(
        Joint("j", "revolute", "a", "b", limit=limit, soft_limit=soft_limit)
    )
    assert JointState(robot).positions["j"] == pytest.approx(0.4)
    assert JointState(robot).joints["j"].range == (0.2, 0.6)


def test_reversed_limits_start_at_zero(make_robot: MakeRobot) -> None:
    robot = make_robot(Joint("j", "revolute", "a", "b", limit=Limit(1, -1)))
    state = JointState(robot)
    assert state.positions["j"] == 0
    assert state.over_limit() == ()


def test_a_zero_from_outside_counts_even_beyond_the_limits(arm: Robot) -> None:
    state = JointState(arm, zeros={"lift": 0.0, "wheel": 9.0})
    assert (state.positions["lift"], state.positions["wheel"]) == (0.0, 9.0)
    state.set("lift", 2.5)
    state.center()
    assert state.positions["lift"] == 0.0
    assert state.over_limit() == ("lift",)


def test_a_zero_for_an_unknown_joint_is_refused(arm: Robot) -> None:
    with pytest.raises(JointError, match=r"^no joint 'weel'; did you mean 'wheel'\?$"):
        JointState(arm, zeros={"weel": 1.0})


def test_mimic_joints_follow_through_chains(arm: Robot) -> None:
    # j = 0.5, k = j + 0.1, l = −k.
    state = JointState(arm)
    state.set("j", 0.5)
    positions = state.all_positions()
    assert (positions["k"], positions["l"]) == (0.6, -0.6)
    assert list(state.followers) == ["l", "k"]
    assert state.followers["l"].leader == "j"


def test_a_chain_accumulates_multipliers_and_offsets(make_robot: MakeRobot) -> None:
    robot = make_robot(
        Joint("j", "revolute", "a", "b", limit=Limit(-9, 9)),
        Joint("k", "revolute", "b", "c", mimic=Mimic("j", 3.0, 5.0)),
        Joint("l", "revolute", "c", "d", mimic=Mimic("k", 7.0, 11.0)),
    )
    state = JointState(robot)
    state.set("j", 2.0)
    assert state.all_positions()["l"] == 7 * 3 * 2 + 7 * 5 + 11


def test_values_are_kept_exactly(arm: Robot) -> None:
    state = JointState(arm)
    state.set("j", 0.12345678901234567)
    assert state.positions["j"] == 0.12345678901234567


def test_setting_tells_what_moved_followers_included(arm: Robot) -> None:
    state = JointState(arm)
    assert state.set("j", 1.0)
    assert not state.set("j", 1.0)
    assert state.set_all({"wheel": 2.0, "j": 1.0}) == ("wheel",)
    assert state.set_all({"wheel": 3.0, "j": 2.0}) == ("wheel", "j", "k", "l")


def test_what_follows_from_a_step_is_what_all_joints_say(arm: Robot) -> None:
    state, random = JointState(arm), Random(1)
    seen, shown = 0, dict.fromkeys(state.all_positions(), math.nan)
    for _ in range(200):
        names = random.sample(state.free, random.randrange(len(state.free) + 1))
        state.set_all({name: random.choice((0.0, 1.0, 2.0, 50.0)) for name in names})
        if random.random() < 0.05:
            state.reload(arm)
        whole = state.kinematics.positions(state.positions)
        assert state.all_positions() == {name: whole[name] for name in state.joints}
        over = [
            name
            for name, joint in state.joints.items()
            if not joint.endless
            and joint.limit is not None
            and None not in joint.limit.ends
            and not min(joint.range) <= whole[name] <= max(joint.range)
        ]
        assert list(state.over_limit()) == over
        if random.random() < 0.5:
            shown |= state.moved_since(seen)
            seen = state.moves
            assert shown == state.all_positions()
    assert state.moved_since(state.moves) == {}


def test_values_over_a_limit_pass_and_are_marked(arm: Robot) -> None:
    state = JointState(arm)
    state.set_all({"j": 2.5, "wheel": 100.0})
    assert state.over_limit() == ("j",)


@pytest.mark.parametrize("bad", [math.nan, math.inf, "x", None, [1.0], 10**400])
def test_a_value_that_is_no_finite_number_changes_nothing(
    arm: Robot, bad: float
) -> None:
    state = JointState(arm)
    with pytest.raises(
        JointError, match=r"^joint 'j' cannot be set to .*: it is not a"
    ):
        state.set_all({"wheel": 1.0, "j": bad})
    assert state.positions["wheel"] == 0


def test_joints_that_cannot_be_set_say_why(arm: Robot) -> None:
    state = JointState(arm)
    for name, text in {
        "k": "joint 'k' mimics 'j' and cannot be set; set 'j'",
        "mast": "joint 'mast' cannot be set; fixed: has no position in ROS",
        "lft": "no joint 'lft'; did you mean 'lift'?",
    }.items():
        with pytest.raises(JointError) as caught:
            state.set(name, 0.0)
        assert str(caught.value) == text


def test_randomize_stays_in_range_and_repeats_with_a_seed(arm: Robot) -> None:
    one, other = JointState(arm), JointState(arm)
    one.randomize(seed=7)
    other.randomize(seed=7)
    assert one.positions == other.positions
    for name, value in one.positions.items():
        lower, upper = one.joints[name].range
        assert lower <= value <= upper
    other.randomize(seed=8)
    assert one.positions != other.positions


def test_center_goes_to_the_start_values_not_to_the_middle(
    make_robot: MakeRobot,
) -> None:
    robot = make_robot(Joint("j", "revolute", "a", "b", limit=Limit(-1, 2)))
    state = JointState(robot)
    state.randomize(seed=1)
    assert state.center() == ("j",)
    assert state.positions["j"] == 0.0


def test_a_ring_of_mimic_joints_is_told_once_and_stops_nothing(
    make_robot: MakeRobot,
) -> None:
    robot = make_robot(
        Joint("j", "revolute", "a", "b", mimic=Mimic("k")),
        Joint("k", "revolute", "b", "c", mimic=Mimic("j")),
        Joint("m", "revolute", "c", "d", mimic=Mimic("m")),
        Joint("w", "continuous", "d", "e"),
    )
    state = JointState(robot)
    assert [p.code for p in state.problems] == ["mimic-ring", "mimic-ring"]
    assert [p.message for p in state.problems] == [
        "the joints j → k → j mimic each other in a ring",
        "joint 'm' mimics itself",
    ]
    assert state.all_positions() == {"j": 0, "k": 0, "m": 0, "w": 0}
    with pytest.raises(JointError, match=r"'j' cannot be set, because it mimics 'k'"):
        state.set("j", 1.0)


def test_a_joint_that_mimics_nothing_useful_is_told_and_stays(
    make_robot: MakeRobot,
) -> None:
    robot = make_robot(
        Joint("arm", "revolute", "a", "b", mimic=Mimic("shoulder")),
        Joint("hand", "revolute", "b", "c", mimic=Mimic("arm")),
        Joint("mast", "fixed", "c", "d"),
        Joint("flag", "revolute", "d", "e", mimic=Mimic("mast")),
        Joint("wheel", "continuous", "e", "f"),
    )
    state = JointState(robot)
    assert [p.message for p in state.problems] == [
        "joint 'arm' mimics 'shoulder', which does not exist",
        "joint 'hand' mimics 'shoulder' through 'arm', which does not exist",
        "joint 'flag' mimics 'mast', which is fixed",
    ]
    assert state.problems[0].hint == "known: 'hand', 'flag', 'wheel'"
    assert state.free == ("wheel",)


def test_a_reload_keeps_the_values_of_joints_that_still_exist(
    arm: Robot, make_robot: MakeRobot
) -> None:
    state = JointState(arm)
    state.set_all({"j": 1.5, "wheel": 3.0, "stuck": 0.7})
    edited = make_robot(
        Joint("wheel", "revolute", "base_link", "d", limit=Limit(-1, 1)),
        Joint("j", "revolute", "base_link", "a", limit=Limit(-1, 1)),
        Joint("lift", "prismatic", "base_link", "e", limit=Limit(5, 7)),
        Joint("new", "continuous", "base_link", "z"),
    )
    assert state.reload(edited) == ("wheel", "lift", "new")
    # The wheel has another type; the lift was at its start, and still is.
    assert state.positions == {"wheel": 0, "j": 1.5, "lift": 6, "new": 0}
    assert state.over_limit() == ("j",)

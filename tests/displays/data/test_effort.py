"""Effort: the circles of joints, the robot they belong to, and what is refused."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from inside import session_of
from lower_limit import lower
from patience import until

from sambot_viz.displays.data.effort.effort_joints import JointEffort, placed_ring
from sambot_viz.robot.parts import Joint

Make = Callable[[Any], tuple[str, str, object]]
Open = Callable[..., Any]
NAN = float("nan")
ROBOT = """
<robot name="arm">
  <link name="base"/>
  <link name="upper"/>
  <link name="lower"/>
  <link name="wheel"/>
  <link name="free"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper"/><origin xyz="0 0 1"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="10" velocity="1"/>
  </joint>
  <joint name="elbow" type="revolute">
    <parent link="upper"/><child link="lower"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="0" velocity="1"/>
  </joint>
  <joint name="roll" type="continuous">
    <parent link="base"/><child link="wheel"/>
    <axis xyz="0 1 0"/><limit effort="5" velocity="1"/>
  </joint>
  <joint name="spin" type="continuous">
    <parent link="base"/><child link="free"/><axis xyz="0 1 0"/>
  </joint>
</robot>
"""


def described(text: str = ROBOT, topic: str = "/robot_description") -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        name = "std_msgs/msg/String"
        return topic, name, types[name](text)

    return make


def placed(child: str, stamp_s: int) -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        name = "tf2_msgs/msg/TFMessage"
        stamp = types["builtin_interfaces/msg/Time"](stamp_s, 0)
        pose = types["geometry_msgs/msg/Transform"](
            types["geometry_msgs/msg/Vector3"](0.0, 0.0, 1.0),
            types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
        )
        header = types["std_msgs/msg/Header"](stamp, "base")
        stamped = types["geometry_msgs/msg/TransformStamped"](header, child, pose)
        return "/tf", name, types[name]([stamped])

    return make


def efforts(_count: int | None = None, _stamp_s: int = 0, /, **joints: float) -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        name = "sensor_msgs/msg/JointState"
        stamp = types["builtin_interfaces/msg/Time"](_stamp_s, 0)
        header = types["std_msgs/msg/Header"](stamp, "")
        zeros = np.zeros(len(joints))
        values = np.array(list(joints.values()), np.float64)[:_count]
        return "/a", name, types[name](header, list(joints), zeros, zeros, values)

    return make


def circles(shown: Any) -> int:
    """So many circles it shows: each has one head."""
    handles = shown.viz.viser.scene._handle_from_node_name
    names = [name for name in shown.node_names() if name.endswith("sco")]
    return sum(len(handles[name].batched_positions) for name in names)


def ring(
    effort: float,
    most: float = 10.0,
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0),
) -> Any:
    joint = Joint("j", "revolute", "a", "b", axis=axis)
    placed = placed_ring(joint, np.eye(4))
    return JointEffort("j", effort, most, placed).ring(scale=1.0, width=0.02)


@pytest.mark.parametrize(
    ("effort", "most", "size"),
    [(2, 10, 0.25), (-8, 10, 0.85), (50, 10, 1.05), (0.3, 0, 0.35), (0.3, -1, 0.35)],
)
def test_a_circle_is_as_wide_as_its_effort(
    effort: float, most: float, size: float
) -> None:
    found = ring(effort, most)
    radius = 0.05 + size / 2
    arms = found.points - found.middle
    assert len(arms) == 30
    assert np.hypot(*arms[:, :2].T) == pytest.approx(np.full(30, radius))
    assert arms[-1] == pytest.approx((0, radius, 0))
    (head,) = found.tip
    assert head.scale == pytest.approx((0.08, 0.08, 0.04))


@pytest.mark.parametrize(
    ("effort", "color"),
    [(-9.5, (255, 0, 0)), (3.5, (0, 255, 255)), (1.5, (0, 0, 255))],
)
def test_a_circle_has_the_colour_of_its_effort(
    effort: float, color: tuple[int, int, int]
) -> None:
    assert ring(effort).color == color


@pytest.mark.parametrize(
    ("axis", "about"),
    [
        ((0.0, 0.0, 1.0), (0, 0, 1)),
        ((1.0, 0.0, 0.0), (-1, 0, 0)),
        ((0.0, 0.6, 0.8), (0, -0.6, 0.8)),
        ((0.0, 0.0, -1.0), (0, 0, 1)),
        ((0.0, 0.0, 0.0), (0, 0, 1)),
    ],
)
@pytest.mark.parametrize("effort", [4.0, -4.0])
def test_a_circle_turns_about_the_axis_as_rviz_has_it(
    axis: Any, about: tuple[float, float, float], effort: float
) -> None:
    """Pictures of RViz show circles about x and y that turn the other way."""
    found = ring(effort, axis=axis)
    turned = np.cross(found.to_head, found.to_quarter)
    expected = np.array(about) * math.copysign(1, effort)
    assert turned / np.linalg.norm(turned) == pytest.approx(expected)


def test_the_recorded_efforts_are_four_circles(opened: Open) -> None:
    shown = opened("effort", "Effort")
    assert circles(shown) == 4
    assert shown.statuses == {
        "Topic": ("Ok", "1 messages received at 0.0 hz."),
        "Robot Description": ("Ok", "OK"),
        "URDF": ("Ok", "Robot model parsed Ok"),
        **{f"j{n}": ("Ok", "OK") for n in range(4)},
    }


def test_a_joint_whose_box_is_unticked_is_not_shown(opened: Open) -> None:
    shown = opened("effort", "Effort")
    session = session_of(shown.viz)
    (joints,) = shown.display.entries()
    assert joints.names == ("j0", "j1", "j2", "j3")
    assert joints.facts("j1") == {"Effort": "-8", "Max Effort": "10"}
    with session.history.acting(1):
        session.display_edits.set_entry(shown.display, "Joints", "j1", "Value", False)
    assert circles(shown) == 3
    assert shown.display.config.dynamic("Joints")["j1"] == {"Value": "false"}
    session.history.undo(1)
    assert circles(shown) == 4


def test_revolute_joints_are_drawn_and_continuous_ones_are_listed(
    messages: Open,
) -> None:
    made = efforts(shoulder=1, elbow=2, roll=3, spin=4, unknown=5)
    shown = messages("Effort", described(), made, frame="base")
    assert circles(shown) == 2
    (joints,) = shown.display.entries()
    assert joints.names == ("elbow", "roll", "shoulder")
    assert joints.facts("roll")["Effort"] == "3"
    shown.set("Width", 0)
    assert circles(shown) == 0


def test_efforts_of_no_joint_of_the_robot_are_named(messages: Open) -> None:
    shown = messages("Effort", described(), efforts(roll=3), frame="base")
    level, text = shown.statuses["Efforts"]
    assert level == "Warn"
    assert "a revolute joint of the robot" in text
    assert shown.node_names() == []


def test_older_efforts_stay_up_to_the_history_length(messages: Open) -> None:
    made = [efforts(shoulder=n) for n in range(5)]
    shown = messages(
        "Effort", described(), *made, frame="base", **{"History Length": 3}
    )
    assert circles(shown) == 3
    shown.set("History Length", 1)
    assert circles(shown) == 1


def test_a_long_history_has_a_limit_of_its_circles(
    messages: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "EFFORT_CIRCLES", 7)
    made = [efforts(shoulder=n, elbow=n) for n in range(5)]
    history = {"History Length": 100}
    shown = messages("Effort", described(), *made, frame="base", **history)
    # Three joints are listed, so two messages have room.
    assert circles(shown) == 4


@pytest.mark.parametrize("count", [0, 1])
def test_efforts_of_another_number_than_the_joints_are_refused(
    messages: Open, count: int
) -> None:
    made = efforts(count, shoulder=1, elbow=2)
    shown = messages("Effort", described(), made, frame="base")
    text = "Received a joint state msg with different joint names and efforts size!"
    assert shown.statuses["Topic"] == ("Error", text)
    assert shown.node_names() == []


@pytest.mark.parametrize("bad", [NAN, float("-inf"), 1e300])
def test_one_effort_without_a_number_leaves_the_others(
    messages: Open, bad: float
) -> None:
    made = efforts(shoulder=bad, elbow=2)
    shown = messages("Effort", described(), made, frame="base")
    assert shown.statuses["shoulder"] == ("Error", f"Invalid effort: {bad:g}")
    assert shown.statuses["elbow"] == ("Ok", "OK")
    assert circles(shown) == 1


def test_joints_without_a_place_wait_and_a_prefix_gives_them_one(
    messages: Open,
) -> None:
    made = efforts(shoulder=1)
    prefix = {"TF Prefix": "other"}
    shown = messages("Effort", described(), made, frame="base", **prefix)
    assert shown.node_names() == []
    assert "shoulder" not in shown.statuses
    shown.set("TF Prefix", "")
    assert circles(shown) == 1
    assert shown.statuses["shoulder"] == ("Ok", "OK")


@pytest.mark.parametrize(("newest", "count"), [(1, 0), (3, 1)])
def test_efforts_wait_for_the_places_of_their_time(
    messages: Open, newest: int, count: int
) -> None:
    made = (placed("upper", 0), placed("upper", newest), efforts(None, 2, shoulder=1))
    shown = messages("Effort", described(), *made, frame="base")
    assert circles(shown) == count
    assert ("shoulder" in shown.statuses) == bool(count)


def test_a_joint_without_a_place_leaves_the_others(messages: Open) -> None:
    made = (placed("upper", 0), placed("upper", 3), placed("lower", 0))
    both = efforts(None, 2, shoulder=1, elbow=1)
    shown = messages("Effort", described(), *made, both, frame="base")
    assert circles(shown) == 1
    assert shown.statuses["shoulder"] == ("Ok", "OK")
    text = "Error transforming from frame 'lower' to frame 'base'"
    assert shown.statuses["elbow"] == ("Error", text)


def test_without_a_description_nothing_is_shown(messages: Open) -> None:
    shown = messages("Effort", efforts(shoulder=1), frame="base")
    assert shown.statuses["Robot Description"][0] == "Error"
    text = "Robot model might not be loaded yet"
    assert shown.statuses["Process message"] == ("Error", text)
    assert shown.display.entries() == ()


def test_the_robot_of_another_topic_is_read(messages: Open) -> None:
    weak = ROBOT.replace('effort="10"', 'effort="2"')
    made = (described(), described(weak, "/weak"), efforts(shoulder=1))
    shown = messages("Effort", *made, frame="base")
    shown.set("Robot Description", "weak")

    def limit() -> str:
        (joints,) = shown.display.entries()
        return joints.facts("shoulder")["Max Effort"]

    until(lambda: limit() == "2")
    until(lambda: shown.statuses["URDF"] == ("Ok", "Robot model parsed Ok"))
    until(lambda: circles(shown) == 1)

"""Finding the two driven wheels of a robot in its model."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz import Robot, load_robot
from sambot_viz.drive.differential import DifferentialDrive
from sambot_viz.drive.driven_wheels import find_wheel_pair
from sambot_viz.errors import JointError

SPHERE = '<sphere radius="0.1"/>'

WHEEL = """
  <link name="{name}_link"><visual><origin rpy="1.5708 0 0" xyz="0 {offset} 0"/>
    <geometry>{shape}</geometry></visual></link>
  <joint name="{name}" type="continuous">
    <parent link="base_link"/><child link="{name}_link"/>
    <origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>
  </joint>
"""


def wheel(
    name: str,
    xyz: str,
    *,
    axis: str = "0 1 0",
    rpy: str = "0 0 0",
    radius: float = 0.1,
    offset: float = 0.0,
    shape: str = "",
) -> str:
    shape = shape or f'<cylinder radius="{radius}" length="0.04"/>'
    return WHEEL.format(
        name=name, xyz=xyz, axis=axis, rpy=rpy, shape=shape, offset=offset
    )


MakeRobot = Callable[..., Robot]


@pytest.fixture
def robot(tmp_path: Path) -> MakeRobot:
    """Wheels as text → a robot on them."""

    def make(*wheels: str) -> Robot:
        file = tmp_path / "robot.urdf"
        body = "".join(wheels)
        file.write_text(f'<robot name="r"><link name="base_link"/>{body}</robot>')
        return load_robot(file)

    return make


def test_the_wheels_of_sam_bot_are_found(repository: Path) -> None:
    pair = find_wheel_pair(load_robot(repository / "assets" / "sam_bot.urdf.xacro"))
    assert (pair.left, pair.right) == ("drivewhl_l_joint", "drivewhl_r_joint")
    assert pair.radius == pytest.approx(0.1)
    assert pair.separation == pytest.approx(0.36)
    assert (pair.left_sign, pair.right_sign) == (1.0, 1.0)
    middle = pair.middle
    assert (middle.x, middle.y, middle.yaw) == pytest.approx((-0.12, 0, 0), abs=1e-12)


def test_sam_bot_drives_a_square_and_returns(repository: Path) -> None:
    drive = DifferentialDrive(
        find_wheel_pair(load_robot(repository / "assets" / "sam_bot.urdf.xacro"))
    )
    for _ in range(4):
        for _ in range(30):
            drive.step(0.5, 0.0, 1 / 30)
        for _ in range(30):
            drive.step(0.0, math.pi / 2, 1 / 30)
    pose = drive.pose
    assert (pose.x, pose.y, pose.yaw) == pytest.approx((0, 0, 2 * math.pi), abs=1e-9)


def test_the_wheels_of_mbot_are_found(repository: Path) -> None:
    pair = find_wheel_pair(load_robot(repository / "assets" / "mbot.urdf.xacro"))
    assert pair.radius > 0
    assert pair.middle.yaw == pytest.approx(0.0, abs=1e-9)
    drive = DifferentialDrive(pair)
    assert drive.step(1.0, 0.0, 1.0).pose.x == pytest.approx(1.0)


def test_axes_turned_by_their_origins_are_one_line_all_the_same(
    robot: MakeRobot,
) -> None:
    # One wheel is mounted the other way round, as many exported models have it.
    pair = find_wheel_pair(
        robot(
            wheel("a", "0 -0.2 0", axis="0 0 1", rpy="1.5708 0 0", shape=SPHERE),
            wheel("b", "0 0.2 0", axis="0 0 1", rpy="-1.5708 0 0", shape=SPHERE),
        )
    )
    assert (pair.left, pair.right) == ("b", "a")
    assert (pair.left_sign, pair.right_sign) == (1.0, -1.0)


def test_a_robot_that_looks_along_y_is_driven_along_y(robot: MakeRobot) -> None:
    along_x = {"axis": "1 0 0", "shape": SPHERE}
    pair = find_wheel_pair(
        robot(wheel("a", "-0.2 0 0", **along_x), wheel("b", "0.2 0 0", **along_x))
    )
    assert pair.middle.yaw == pytest.approx(math.pi / 2)
    assert (pair.left, pair.right) == ("a", "b")
    assert (pair.left_sign, pair.right_sign) == (-1.0, -1.0)


def test_the_separation_is_that_of_the_tyres_not_of_the_joints(
    robot: MakeRobot,
) -> None:
    pair = find_wheel_pair(
        robot(wheel("l", "0 0.1 0", offset=0.05), wheel("r", "0 -0.1 0", offset=-0.05))
    )
    assert pair.separation == pytest.approx(0.3)


def test_of_two_pairs_the_larger_wheels_drive(robot: MakeRobot) -> None:
    casters = [
        wheel("c", "0.3 0.1 0", radius=0.03),
        wheel("d", "0.3 -0.1 0", radius=0.03),
    ]
    pair = find_wheel_pair(
        robot(*casters, wheel("l", "0 0.2 0"), wheel("r", "0 -0.2 0"))
    )
    assert (pair.left, pair.right, pair.radius) == ("l", "r", 0.1)


def test_what_is_given_counts(robot: MakeRobot) -> None:
    mesh = {"shape": '<box size="0.2 0.04 0.2"/>'}
    model = robot(wheel("l", "0 0.2 0", **mesh), wheel("r", "0 -0.2 0", **mesh))
    with pytest.raises(JointError) as caught:
        find_wheel_pair(model)
    assert str(caught.value) == (
        "the wheels 'l' and 'r' have no cylinder or sphere to take their radius from; "
        "give the radius"
    )
    pair = find_wheel_pair(model, radius=0.1)
    assert (pair.radius, pair.separation) == (0.1, pytest.approx(0.4))
    pair = find_wheel_pair(model, left="r", right="l", radius=0.1, separation=0.5)
    assert (pair.left, pair.right, pair.separation) == ("r", "l", 0.5)
    assert abs(pair.middle.yaw) == pytest.approx(math.pi)


def test_without_a_pair_the_reason_is_given(robot: MakeRobot) -> None:
    lone = robot(wheel("l", "0 0.2 0"))
    with pytest.raises(JointError) as caught:
        find_wheel_pair(lone)
    assert str(caught.value) == (
        "a differential drive needs two continuous joints; this robot has 1"
    )
    apart = robot(wheel("l", "0 0.2 0"), wheel("r", "0.1 -0.2 0"))
    with pytest.raises(JointError) as caught:
        find_wheel_pair(apart)
    assert str(caught.value) == (
        "no two of the continuous joints turn about one level axis with wheels of one "
        "size: 'l', 'r'; name the left and the right wheel"
    )


def test_unequal_upright_and_coinciding_wheels_are_no_pair(robot: MakeRobot) -> None:
    for second in (
        wheel("r", "0 -0.2 0", radius=0.2),
        wheel("r", "0 0.2 0"),
        wheel("r", "0 -0.2 0", axis="0 0 1"),
    ):
        with pytest.raises(JointError, match=r"^no two of the continuous joints"):
            find_wheel_pair(robot(wheel("l", "0 0.2 0"), second))


def test_a_wheel_named_wrongly_is_told(robot: MakeRobot) -> None:
    model = robot(wheel("left", "0 0.2 0"), wheel("right", "0 -0.2 0"))
    with pytest.raises(JointError, match=r"no continuous joint 'rigt'; did you "):
        find_wheel_pair(model, left="left", right="rigt")
    with pytest.raises(JointError, match=r"the right wheel's joint is not named"):
        find_wheel_pair(model, left="left")


def test_nobody_guesses_the_driven_pair_of_a_hundred_wheels(robot: MakeRobot) -> None:
    many = robot(*(wheel(f"w{i}", f"{i} 0 0") for i in range(100)))
    with pytest.raises(JointError, match="100 continuous joints turn about level axes"):
        find_wheel_pair(many)

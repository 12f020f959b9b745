import json
import math
from pathlib import Path
from random import Random

import numpy as np
import pytest

from sambot_viz.errors import JointError
from sambot_viz.geometry import PlainPose
from sambot_viz.robot.kinematics import Kinematics
from sambot_viz.robot.model import Robot, load_robot

RECORDED = (
    "a1", "all_joints", "chain40", "floating_planar", "kinova", "mimic_chain",
    "panda", "pr2", "sam_bot", "tree300", "upkie", "ur5",
)  # fmt: skip


def rotation(x: float, y: float, z: float, w: float) -> np.ndarray:
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


@pytest.mark.parametrize("name", RECORDED)
def test_link_poses_equal_those_of_the_real_nodes(name: str, shared: Path):
    recorded = json.loads((shared / "data" / "tf" / f"{name}.json").read_text())
    robot = load_robot(shared / "data" / "tf" / f"{name}.urdf")
    kinematics = Kinematics(robot)

    worst = 0.0
    for config in recorded["configs"]:
        poses = kinematics.forward(config["joint_positions"])
        for frame, pose in config["transforms"].items():
            T = poses[frame]
            worst = max(worst, np.abs(T[:3, 3] - pose["xyz"]).max())
            worst = max(worst, np.abs(T[:3, :3] - rotation(*pose["xyzw"])).max())

    assert worst <= 1e-9


def robot_with(joints: str, links: int = 4):
    text = "".join(f'<link name="l{n}"/>' for n in range(links))
    return load_robot(f'<robot name="r">{text}{joints}</robot>')


def joint(name: str, kind: str, parent: int, child: int, inside: str = "") -> str:
    limit = '<limit lower="-9" upper="9" effort="1" velocity="1"/>'
    return (
        f'<joint name="{name}" type="{kind}"><parent link="l{parent}"/>'
        f'<child link="l{child}"/>{limit}{inside}</joint>'
    )


@pytest.mark.parametrize("name", RECORDED)
def test_the_start_in_plain_numbers_is_that_of_the_arrays(name: str, shared: Path):
    robot = load_robot(shared / "data" / "tf" / f"{name}.urdf")
    same_at_start(robot)


def test_joints_of_all_types_have_their_start_values_in_plain_numbers():
    turned = '<origin xyz="0.1 -0.2 0.3" rpy="0.4 1.5 -2.6"/>'
    slides = f'{turned}<axis xyz="0.6 0 0.8"/><limit lower="0.5" upper="1.5" '
    turns = f'{turned}<axis xyz="0 -0.6 0.8"/><limit lower="1" upper="2" '
    rest = 'effort="1" velocity="1"/>'
    follows = '<axis xyz="0 0 1"/><mimic joint="a" multiplier="2" offset="0.5"/>'
    robot = robot_with(
        one_joint("a", "prismatic", 0, 1, slides + rest)
        + one_joint("b", "revolute", 1, 2, turns + rest)
        + joint("c", "revolute", 2, 3, turned + follows)
    )
    same_at_start(robot)
    assert robot.at_start["l1"].position != robot.joints["a"].origin.xyz


def one_joint(name: str, kind: str, parent: int, child: int, inside: str) -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="l{parent}"/>'
        f'<child link="l{child}"/>{inside}</joint>'
    )


def same_at_start(robot: Robot) -> None:
    poses = robot.forward_kinematics()
    assert list(robot.at_start) == list(poses)
    for link, T_root_link in poses.items():
        placed = robot.at_start[link]
        corners = [placed.of(point) for point in np.eye(3).tolist()]
        expected = T_root_link[:3, :3] + T_root_link[:3, 3:]
        assert np.allclose(np.transpose(corners), expected, atol=1e-9)
        again = PlainPose.of_matrix(T_root_link) @ placed.inverse()
        assert np.allclose(again.position, 0, atol=1e-9)
        assert np.allclose(again.turned((0.6, 0.0, 0.8)), (0.6, 0, 0.8), atol=1e-9)


def test_a_robot_of_one_link_has_one_pose():
    poses = robot_with("", 1).forward_kinematics()
    assert list(poses) == ["l0"]
    assert np.array_equal(poses["l0"], np.eye(4))


def test_a_prismatic_axis_is_a_direction_not_a_factor():
    robot = robot_with(joint("j", "prismatic", 0, 1, '<axis xyz="0 0 2"/>'), 2)
    assert robot.forward_kinematics({"j": 0.5})["l1"][2, 3] == 0.5


def test_mimic_chains_are_followed_and_may_be_overruled():
    robot = robot_with(
        joint("c", "continuous", 2, 3, '<mimic joint="b" multiplier="-1"/>')
        + joint("b", "continuous", 1, 2, '<mimic joint="a" offset="0.1"/>')
        + joint("a", "continuous", 0, 1)
    )
    kinematics = Kinematics(robot)

    assert kinematics.positions({"a": 0.5}) == {"a": 0.5, "b": 0.6, "c": -0.6}
    assert kinematics.positions({"b": 1.0}) == {"a": 0.0, "b": 1.0, "c": -1.0}


def test_a_ring_of_mimic_joints_stays_at_the_start():
    robot = robot_with(
        joint("a", "continuous", 0, 1, '<mimic joint="b"/>')
        + joint("b", "continuous", 1, 2, '<mimic joint="a"/>'),
        3,
    )
    assert Kinematics(robot).positions({}) == {"a": 0.0, "b": 0.0}


def test_a_joint_without_direction_and_joints_ros_does_not_move_stand_still():
    robot = robot_with(
        joint("none", "revolute", 0, 1, '<axis xyz="0 0 0"/>')
        + joint("float", "floating", 1, 2)
        + joint("plane", "planar", 2, 3)
    )
    poses = robot.forward_kinematics({"none": 1.0, "float": 1.0, "plane": 1.0})
    assert all(np.array_equal(T, np.eye(4)) for T in poses.values())


def test_one_joint_alone_gives_the_same_transform_as_the_whole_robot():
    robot = robot_with(
        joint("a", "revolute", 0, 1, '<axis xyz="1 2 3"/><origin rpy="1 2 3"/>')
        + joint("b", "prismatic", 1, 2, '<axis xyz="1 0 1"/><origin xyz="1 2 3"/>')
        + joint("c", "fixed", 2, 3, '<origin rpy="0 1 0"/>')
    )
    kinematics = Kinematics(robot)
    poses = kinematics.forward({"a": 0.7, "b": -2.0})

    expected = np.eye(4)
    for name, position in (("a", 0.7), ("b", -2.0), ("c", 0.0)):
        expected = expected @ kinematics.joint_transform(name, position)
    np.testing.assert_allclose(poses["l3"], expected, atol=1e-14)


def test_a_joint_not_given_stands_at_its_start_value():
    limit = '<limit lower="0.2" upper="0.6" effort="1" velocity="1"/>'
    joint_text = (
        '<joint name="j" type="prismatic"><parent link="l0"/><child link="l1"/>'
        f"{limit}</joint>"
    )
    assert robot_with(joint_text, 2).forward_kinematics()["l1"][0, 3] == 0.4


@pytest.mark.parametrize("value", [math.nan, math.inf, "x", None])
def test_a_position_that_is_no_finite_number_is_refused(value: object):
    robot = robot_with(joint("j", "continuous", 0, 1), 2)
    with pytest.raises(JointError, match=r"'j'.*not a finite number"):
        robot.forward_kinematics({"j": value})  # type: ignore[dict-item]


def test_an_unknown_joint_is_named_with_the_nearest_one():
    robot = robot_with(joint("wheel_joint", "continuous", 0, 1), 2)
    with pytest.raises(JointError, match="did you mean 'wheel_joint'"):
        robot.forward_kinematics({"whel_joint": 0.0})


@pytest.mark.parametrize("seed", range(12))
def test_poses_are_the_product_of_the_joints_above(seed: int):
    random = Random(seed)
    links, reach = random.choice(((1, 1), (2, 1), (7, 2), (40, 1), (60, 60), (90, 8)))
    kinds = ("fixed", "revolute", "continuous", "prismatic", "floating", "planar")
    numbers = lambda: " ".join(f"{random.uniform(-2, 2):.3f}" for _ in range(3))  # noqa: E731
    joints = [
        joint(
            f"j{n}",
            random.choice(kinds),
            max(0, n - random.randint(1, reach)),
            n,
            f'<origin xyz="{numbers()}" rpy="{numbers()}"/><axis xyz="{numbers()}"/>',
        )
        for n in range(1, links)
    ]
    random.shuffle(joints)
    robot = robot_with("".join(joints), links)
    kinematics = robot.kinematics
    given = {name: random.uniform(-7, 7) for name in robot.joint_names}

    poses = kinematics.forward(given)

    assert list(poses) == list(kinematics.links)
    positions = kinematics.positions(given)
    for each in robot.joints.values():
        own = kinematics.joint_transform(each.name, positions[each.name])
        assert np.allclose(poses[each.child], poses[each.parent] @ own, atol=1e-12)

"""Several robots as one: names with prefixes, and each joint where it was."""

from __future__ import annotations

import numpy as np

from sambot_viz import Robot, load_robot
from sambot_viz.robot.merged_robots import HungRobot, merged
from sambot_viz.robot.parts import Origin

ARM = """<robot name="arm"><link name="base"/><link name="hand"/><link name="finger"/>
<joint name="wrist" type="continuous"><parent link="base"/><child link="hand"/>
<origin xyz="0 0 1"/><axis xyz="0 0 1"/></joint>
<joint name="grip" type="prismatic"><parent link="hand"/><child link="finger"/>
<axis xyz="1 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/>
<mimic joint="wrist" multiplier="2"/></joint></robot>"""


def test_a_hung_robot_keeps_its_shape_and_its_joints(sam_bot: Robot) -> None:
    arm = load_robot(ARM)
    origin = Origin((1.0, 2.0, 3.0))
    both = merged(
        sam_bot,
        [
            HungRobot("a", arm, "base_link", origin),
            HungRobot("b", arm, "a/hand", Origin()),
        ],
    )
    assert both.root == sam_bot.root
    assert both.joint_names == (*sam_bot.joint_names, "a/wrist", "b/wrist")
    T = both.forward_kinematics({"a/wrist": 0.25})
    alone = arm.forward_kinematics({"wrist": 0.25})
    for link, T_arm_link in alone.items():
        assert np.allclose(T[f"a/{link}"], origin.matrix @ T_arm_link)
    assert np.allclose(T["b/base"], T["a/hand"])
    assert all(np.array_equal(T[n], p) for n, p in sam_bot.forward_kinematics().items())
    assert both.urdf == sam_bot.urdf and both.files == sam_bot.files


def test_a_robot_whose_parent_has_gone_hangs_at_the_root(sam_bot: Robot) -> None:
    both = merged(sam_bot, [HungRobot("a", load_robot(ARM), "gone", Origin())])
    assert np.allclose(both.forward_kinematics()["a/base"], np.eye(4))


def test_files_may_be_read_from_the_folders_of_all_or_from_anywhere(
    sam_bot: Robot,
) -> None:
    arm = load_robot(ARM, trusted=False)
    assert arm.file_roots is not None and sam_bot.file_roots is None
    hung = HungRobot("a", arm, "base_link", Origin())
    assert merged(sam_bot, [hung]).file_roots is None
    assert merged(arm, [HungRobot("a", arm, "base", Origin())]).file_roots == (
        *arm.file_roots,
        *arm.file_roots,
    )


def test_without_another_robot_the_first_is_the_same_object(sam_bot: Robot) -> None:
    assert merged(sam_bot, []) is sam_bot

"""Look-ups beside transforms recorded from the real ROS nodes (data/tf)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sambot_viz import load_robot
from sambot_viz.errors import JointError
from sambot_viz.frames import LookupRefused, Transform
from sambot_viz.frames.robot_frames import robot_frames
from sambot_viz.joints import JointState
from sambot_viz.robot.kinematics import Kinematics

OURS = ("sam_bot", "all_joints", "mimic_chain", "floating_planar", "chain40", "tree300")
OTHERS = ("a1", "kinova", "panda", "pr2", "upkie", "ur5")


def recording(shared: Path, name: str) -> tuple[Any, Any]:
    folder = shared / "data" / "tf"
    record = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
    return load_robot(folder / f"{name}.urdf"), record


def difference(transform: Transform, recorded: Any) -> float:
    """The largest difference of a number, the quaternion's sign included."""
    xyz = np.abs(transform.translation - recorded["xyz"]).max()
    xyzw = np.abs(transform.rotation_xyzw - recorded["xyzw"]).max()
    return float(max(xyz, xyzw))


@pytest.mark.parametrize("name", [*OURS, *OTHERS])
def test_lookups_agree_with_tf2_to_the_sign_of_the_quaternion(
    shared: Path, name: str
) -> None:
    robot, record = recording(shared, name)
    kinematics = Kinematics(robot)
    tree = robot_frames(robot)
    for config in record["configs"][:: 5 if name == "tree300" else 1]:
        positions = kinematics.positions(config["joint_positions"])
        moved = {
            joint.child: kinematics.joint_transform(name, positions[name])
            for name, joint in robot.joints.items()
            if joint.movable
        }
        tree.update(moved)
        for frame, recorded in config["transforms"].items():
            assert difference(tree.lookup(record["root"], frame), recorded) <= 1e-9


def test_what_hangs_below_a_floating_joint_is_a_tree_of_its_own(shared: Path) -> None:
    robot, record = recording(shared, "floating_planar")
    for config in record["configs"]:
        tree = robot_frames(robot, config["joint_positions"])
        for frame in config["unreachable_from_root"]:
            with pytest.raises(LookupRefused):
                tree.lookup("base_link", frame)
        for frame, recorded in config["transforms_in_separate_trees"].items():
            seen = tree.lookup(recorded["relative_to"], frame)
            assert difference(seen, recorded) <= 1e-9


@pytest.mark.parametrize("name", [n for n in (*OURS, *OTHERS) if n != "upkie"])
def test_joint_states_agree_with_joint_state_publisher(shared: Path, name: str) -> None:
    robot, record = recording(shared, name)
    state = JointState(robot)
    first, *others = record["configs"]
    assert state.all_positions() == pytest.approx(first["joint_states"], abs=1e-12)
    assert list(state.all_positions()) == list(first["joint_states"])
    assert set(state.free) == set(record["driven_joints"])
    for config in others:
        state.set_all(config["joint_positions"])
        expected = config["joint_states"]
        assert state.all_positions() == pytest.approx(expected, abs=1e-9)


def test_a_prefix_is_put_before_every_frame_as_it_is(shared: Path) -> None:
    robot, _ = recording(shared, "sam_bot")
    tree = robot_frames(robot, prefix="robot1/")
    assert tree.frames[:2] == ("robot1/base_link", "robot1/base_footprint")
    assert tree.hop("robot1/base_footprint").static
    assert not tree.hop("robot1/drivewhl_l_link").static
    with pytest.raises(JointError, match="no joint 'weel'"):
        robot_frames(robot, {"weel": 1.0})

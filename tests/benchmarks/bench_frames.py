"""Costs of frames and joints; run it with ``pytest tests/benchmarks/bench_frames.py``.

The best of many runs counts: other work on the machine only ever adds time.
"""

from __future__ import annotations

import math
import timeit
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from sambot_viz import Robot, load_robot
from sambot_viz.frames import FrameTree, Transform
from sambot_viz.frames.export.svg import tree_svg
from sambot_viz.frames.robot_frames import robot_frames
from sambot_viz.joints import JointState
from sambot_viz.robot.kinematics import Kinematics

pytestmark = pytest.mark.benchmark

Measure = Callable[[str, Callable[[], object], float], None]


@pytest.fixture
def measure(capsys: pytest.CaptureFixture[str]) -> Measure:
    """Time a call [µs], print the best of many, and hold it against its limit."""

    def measure(what: str, call: Callable[[], object], limit: float) -> None:
        # Enough calls for about 5 ms a run, so that the clock does not matter.
        number = max(1, math.ceil(0.005 / (timeit.timeit(call, number=5) / 5)))
        best = min(timeit.repeat(call, number=number, repeat=25)) / number * 1e6
        with capsys.disabled():
            print(f"\n  {what}: {best:.2f} µs (limit {limit:g} µs)", end="")
        assert best <= limit

    return measure


@pytest.fixture
def arm() -> FrameTree:
    """map → odom → base_link → six joints → tool → camera, and a laser: 12 frames."""
    names = ("map", "odom", "base_link", *(f"link_{i}" for i in range(1, 7)))
    names = (*names, "tool", "camera")
    tree, pose = FrameTree(), Transform.from_xyz_rpy((0.1, 0.2, 0.3), (0.1, 0.2, 0.3))
    for parent, child in pairwise(names):
        tree.set(parent, child, pose)
    tree.set_static("base_link", "base_laser", pose)
    return tree


@pytest.fixture
def tree300(shared: Path) -> Robot:
    return load_robot(shared / "data" / "tf" / "tree300.urdf")


def test_a_lookup_when_nothing_changed(arm: FrameTree, measure: Measure) -> None:
    measure("look-up, nothing changed", lambda: arm.lookup("map", "camera"), 20)


@pytest.mark.parametrize(
    ("target", "source"),
    [
        ("base_link", "base_laser"),
        ("base_link", "link_6"),
        ("link_6", "base_link"),
        ("base_laser", "link_6"),
    ],
)
def test_a_lookup_after_a_joint_moved(
    arm: FrameTree, measure: Measure, target: str, source: str
) -> None:
    moved = {"link_3": np.eye(4)}
    hops = len(arm.chain(target, source))

    def call() -> None:
        arm.update(moved)
        arm.lookup(target, source)

    measure(f"a joint moves, then a look-up of {hops} hops", call, 20)


def test_a_lookup_with_its_quaternion_and_angles(
    arm: FrameTree, measure: Measure
) -> None:
    moved = {"link_3": np.eye(4)}

    def call() -> None:
        arm.update(moved)
        seen = arm.lookup("base_link", "link_6")
        _ = seen.rotation_xyzw, seen.rpy

    measure("the same with quaternion and rpy", call, 100)


def test_an_update_of_all_joints_of_300_links(tree300: Robot, measure: Measure) -> None:
    tree, kinematics = robot_frames(tree300), Kinematics(tree300)
    matrices = {
        joint.child: kinematics.joint_transform(name, 0.1)
        for name, joint in tree300.joints.items()
    }
    measure("update of 299 transforms", lambda: tree.update(matrices), 2500)


def test_one_joint_of_300_is_set(tree300: Robot, measure: Measure) -> None:
    state = JointState(tree300)
    values = iter(range(10**9))
    measure("one joint of 299 is set", lambda: state.set("j2", next(values)), 20)


def test_the_positions_of_300_joints(tree300: Robot, measure: Measure) -> None:
    state = JointState(tree300)
    measure("all positions of 299 joints", state.all_positions, 1000)


def test_the_picture_of_300_frames(tree300: Robot, measure: Measure) -> None:
    tree = robot_frames(tree300)
    measure("SVG of 300 frames", lambda: tree_svg(tree, tree300), 500_000)

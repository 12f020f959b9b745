"""How long it takes to read and to move robots.

Run with ``pytest -s tests/benchmarks/bench_robot.py``.

Times are CPU time of this process and its children: other work on the machine then
hardly counts. The figures are those of the project's goals.
"""

from __future__ import annotations

import os
import timeit
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from sambot_viz import Robot, RobotError, load_robot
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.meshes.mesh import MeshError
from sambot_viz.robot.kinematics import Kinematics
from sambot_viz.robot.parts import MeshFile

pytestmark = pytest.mark.benchmark

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
TREE = (
    HEAD
    + """
  <xacro:macro name="arm" params="number above">
    <link name="l${number}">
      <visual>
        <origin xyz="0 0 ${0.05 * 2}"/>
        <geometry><cylinder radius="0.02" length="${0.1 + number * 0.001}"/></geometry>
        <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
      </visual>
      <inertial>
        <mass value="1"/>
        <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
      </inertial>
    </link>
    <joint name="j${number}" type="revolute">
      <parent link="l${above}"/>
      <child link="l${number}"/>
      <origin xyz="0 0 0.1" rpy="0 0 ${pi / 7}"/>
      <axis xyz="0 1 0"/>
      <limit lower="-1" upper="1" effort="1" velocity="1"/>
    </joint>
  </xacro:macro>
  <link name="l0"/>
"""
    + "".join(
        f'  <xacro:arm number="{number}" above="{(number - 1) // 2}"/>\n'
        for number in range(1, 300)
    )
    + "</robot>\n"
)
SMALL = HEAD + '<link name="${1 + 1}"/></robot>\n'
PLAIN = '<robot name="r"><link name="2"/></robot>\n'


def cpu() -> float:
    """CPU seconds of this process and of its children that have ended."""
    times = os.times()
    return sum(times[:4])


def best(call: Callable[[], object], rounds: int = 5) -> float:
    """The least CPU time of some rounds [s]."""
    taken: list[float] = []
    for _ in range(rounds):
        start = cpu()
        call()
        taken.append(cpu() - start)
    return min(taken)


def test_300_links_without_meshes_are_read_within_a_second(tmp_path: Path) -> None:
    model = tmp_path / "tree.urdf.xacro"
    model.write_text(TREE)
    assert len(load_robot(model).links) == 300
    taken = best(lambda: load_robot(model))
    print(f"\n300 links, xacro included: {taken:.2f} s (goal 1 s)")
    assert taken < 1.0


def test_the_child_costs_little_of_a_start(tmp_path: Path) -> None:
    xacro, plain = tmp_path / "m.urdf.xacro", tmp_path / "m.urdf"
    xacro.write_text(SMALL)
    plain.write_text(PLAIN)
    with_child, without = (
        best(lambda path=path: load_robot(path)) for path in (xacro, plain)
    )
    print(f"\nthe smallest xacro file: {with_child:.3f} s, as URDF: {without:.3f} s")
    assert with_child < 0.5


def test_all_poses_of_300_links_take_a_millisecond(shared: Path) -> None:
    kinematics = Kinematics(load_robot(shared / "data" / "tf" / "tree300.urdf"))
    given = dict.fromkeys(list(kinematics.joints)[:50], 0.1)
    all_of_them = min(timeit.repeat(lambda: kinematics.poses(given), number=20)) / 20
    one = min(timeit.repeat(lambda: kinematics.joint_transform("j2", 0.1), number=2000))
    one /= 2000
    print(f"\nposes of 300 links: {all_of_them * 1e3:.2f} ms (goal 1 ms), one joint:")
    print(f"  {one * 1e6:.1f} µs")
    assert all_of_them < 1e-3
    assert one < all_of_them / 10


def real_robots(shared: Path) -> list[Path]:
    folder = shared / "data" / "robots"
    index: Any = yaml.safe_load((folder / "index.yaml").read_text("utf-8"))
    return [
        folder / entry["path"]
        for entry in index["robots"]
        if entry["expected"].startswith("render") and "args" not in entry["expected"]
    ]


def meshes_of(robot: Robot) -> list[Path]:
    """Each distinct mesh file once."""
    shapes = (s for link in robot.links.values() for s in link.visuals)
    found = (s.geometry.path for s in shapes if isinstance(s.geometry, MeshFile))
    return list(dict.fromkeys(path for path in found if path is not None))


@pytest.mark.filterwarnings("ignore")
def test_real_robots_are_no_slower_than_1_3_times_trimesh_alone(shared: Path) -> None:
    import trimesh

    untyped: Any = trimesh

    def read(paths: list[Path]) -> None:
        store = MeshCache()
        for path in paths:
            try:
                store.read(Asset("mesh", path))
            except MeshError:
                continue

    def theirs(paths: list[Path]) -> None:
        for path in paths:
            try:
                untyped.load_scene(path)
            except Exception:  # What trimesh cannot read costs it nothing here.
                continue

    ours_total = theirs_total = reading = 0.0
    count = 0
    for model in real_robots(shared):
        try:
            robot = load_robot(model)
        except RobotError:
            continue
        paths = meshes_of(robot)
        if not paths:
            continue
        count += 1
        reading += best(lambda model=model: load_robot(model), 1)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            ours_total += best(lambda paths=paths: read(paths), 2)
            theirs_total += best(lambda paths=paths: theirs(paths), 2)
    print(
        f"\n{count} robots with meshes: ours {ours_total:.2f} s, trimesh alone "
        f"{theirs_total:.2f} s, ratio {ours_total / theirs_total:.2f}; "
        f"URDF and xacro besides {reading:.2f} s"
    )
    assert ours_total < 1.3 * theirs_total

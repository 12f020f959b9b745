"""Processes that a launch file starts twice, and handlers that wait for no process."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files
from manifests import written

from sambot_viz.checks import check

LAUNCH = "launch/start.launch.py"
FILES = {
    "package.xml": """\
<package format="3">
  <name>robot</name>
  <version>0.0.1</version>
  <description>A robot.</description>
  <maintainer email="me@example.org">me</maintainer>
  <license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
""",
    "CMakeLists.txt": """\
cmake_minimum_required(VERSION 3.8)
project(robot)
find_package(ament_cmake REQUIRED)
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
ament_package()
""",
    LAUNCH: """\
from launch import LaunchDescription
from launch.actions import RegisterEventHandler, TimerAction
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch_ros.actions import Node


def generate_launch_description():
    talker = Node(package='demo_nodes_cpp', executable='talker')
    listener = Node(package='demo_nodes_cpp', executable='listener')
    adder = Node(package='demo_nodes_cpp', executable='add_two_ints_client')
    late = TimerAction(period=3.0, actions=[talker])
    after = RegisterEventHandler(
        OnProcessStart(target_action=talker, on_start=[listener])
    )
    last = RegisterEventHandler(OnProcessExit(target_action=listener, on_exit=adder))
    return LaunchDescription([
        late,
        after,
        last,
    ])
""",
}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A right package with a timer and two handlers."""
    folder = written(tmp_path / "robot", FILES)
    (folder / "robot.urdf").write_text('<robot name="r"><link name="base"/></robot>')
    return folder


def test_right_handlers_have_no_problem(package: Path) -> None:
    assert check(package) == []


CASES = [
    ("t(target_action=talker", "t(target_action=late", "and late is a TimerAction"),
    ("t(target_action=listener", "t(target_action=after", "a RegisterEventHandler"),
    ("        late,\n", "        talker,\n        late,\n", "by TimerAction (line 11)"),
    ("        last,\n", "        last,\n        listener,\n", "by OnProcessStart"),
    ("        last,\n", "        last,\n        adder,\n", "OnProcessExit (line 15)"),
]


@pytest.mark.parametrize(("right", "wrong", "cause"), CASES)
def test_a_process_is_named_with_its_remedy(
    package: Path, right: str, wrong: str, cause: str
) -> None:
    path = package / LAUNCH
    assert right in FILES[LAUNCH]
    path.write_text(FILES[LAUNCH].replace(right, wrong, 1))
    (problem,) = [p for p in check(package) if cause in p.message]
    assert problem.severity == "error"
    if "RegisterEventHandler" in cause:
        assert problem.hint == "write a node or an ExecuteProcess there"
        return
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert path.read_text() == FILES[LAUNCH]


def test_what_a_condition_or_another_call_starts_is_another_process(
    package: Path,
) -> None:
    path = package / LAUNCH
    node = "Node(package='demo_nodes_cpp', executable='talker')"
    path.write_text(FILES[LAUNCH].replace("        late,", f"        {node}, late,"))
    assert check(package) == []
    text = FILES[LAUNCH].replace("        late,", "        talker, late,")
    text = text.replace("=[talker]", "=[talker], condition=IfCondition('true')")
    first = "from launch import LaunchDescription\n"
    needed = "from launch.conditions import IfCondition\n"
    path.write_text(text.replace(first, f"{first}{needed}"))
    assert check(package) == []

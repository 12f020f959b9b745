"""Commands with and without a time stamp that meet on one topic are found."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files
from manifests import manifest, written

from sambot_viz.checks import check

LAUNCH, PARAMETERS = "launch/robot.launch.py", "config/params.yaml"
FILES = {
    "package.xml": manifest(),
    "robot.urdf": '<robot name="r"><link name="base_link"/></robot>',
    LAUNCH: """\
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    config = os.path.join(
        get_package_share_directory('robot'), 'config', 'params.yaml')
    return LaunchDescription([
        Node(package='controller_manager', executable='ros2_control_node',
             parameters=[config]),
        Node(package='controller_manager', executable='spawner',
             arguments=['diff_cont']),
        Node(package='teleop_twist_joy', executable='teleop_node',
             remappings=[('cmd_vel', 'cmd_vel_joy')],
             parameters=[config]),
        Node(package='twist_mux', executable='twist_mux',
             remappings=[('cmd_vel_out', '/diff_cont/cmd_vel')],
             parameters=[config]),
    ])
""",
    PARAMETERS: """\
controller_manager:
  ros__parameters:
    diff_cont:
      type: diff_drive_controller/DiffDriveController
diff_cont:
  ros__parameters:
    left_wheel_names: [left_wheel_joint]
    right_wheel_names: [right_wheel_joint]
teleop_twist_joy_node:
  ros__parameters:
    publish_stamped_twist: true
twist_mux:
  ros__parameters:
    use_stamped: true
    topics:
      joystick:
        topic: cmd_vel_joy
        timeout: 0.5
        priority: 10
""",
}
STAMPED = "    publish_stamped_twist: true\n"
SWITCH = "    use_stamped: true\n"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package whose commands have a time stamp at all ends."""
    return written(tmp_path / "robot", FILES)


def findings(package: Path) -> list[str]:
    found = [p for p in check(package) if p.code == "topic-type"]
    return [f"{p.line} {p.message}; {p.hint}" for p in found]


def edit(package: Path, file: str, old: str, new: str) -> None:
    text = (package / file).read_text()
    assert old in text, old
    (package / file).write_text(text.replace(old, new, 1))


def test_the_right_package_has_none(package: Path) -> None:
    assert findings(package) == []


@pytest.mark.parametrize("name", ["publish_stamped_twist", "use_stamped"])
def test_the_switch_that_fits_no_other_is_turned(package: Path, name: str) -> None:
    edit(package, PARAMETERS, f"{name}: true", f"{name}: false")
    (problem,) = [p for p in check(package) if p.code == "topic-type"]
    assert problem.hint == f"write {name}: true"
    assert problem.message.endswith("nothing arrives")
    (after,) = edited_files(problem.edits).values()
    assert after.decode() == FILES[PARAMETERS]


def test_a_missing_switch_counts_where_its_default_never_changed(
    package: Path,
) -> None:
    edit(package, PARAMETERS, STAMPED, "    axis_linear.x: 1\n")
    (found,) = findings(package)
    assert "teleop_twist_joy_node publishes /cmd_vel_joy as Twist, but" in found
    assert "twist_mux reads it as TwistStamped (params.yaml line 14)" in found
    assert "the parameter publish_stamped_twist: true" in found


def test_a_default_that_changed_says_nothing(package: Path) -> None:
    edit(package, PARAMETERS, SWITCH, "")
    assert findings(package) == []


def test_a_topic_that_only_another_value_reads(package: Path) -> None:
    edit(package, LAUNCH, "diff_cont/cmd_vel'", "diff_cont/cmd_vel_unstamped'")
    edit(package, PARAMETERS, SWITCH, SWITCH.replace("true", "false"))
    edit(package, PARAMETERS, STAMPED, STAMPED.replace("true", "false"))
    switch = "    use_stamped_vel: true\n    left_wheel"
    edit(package, PARAMETERS, "    left_wheel", switch)
    (found,) = findings(package)
    assert found.startswith("7 twist_mux publishes /diff_cont/cmd_vel_unstamped as")
    assert "diff_cont reads it only with use_stamped_vel: false" in found
    assert found.endswith("write use_stamped_vel: false")


def test_nodes_that_may_start_instead_of_each_other_do_not_meet(
    package: Path,
) -> None:
    edit(package, PARAMETERS, "use_stamped: true", "use_stamped: false")
    text = (package / LAUNCH).read_text()
    head, mark, tail = text.partition("        Node(package='twist_mux'")
    unknown = "        Node(package='my_driver', executable='driver'),\n    ])\n"
    (package / LAUNCH).write_text(head + unknown)
    start = head.partition("        Node(")[0]
    (package / "launch/mux.launch.py").write_text(start + mark + tail)
    assert findings(package) == []

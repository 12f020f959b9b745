"""Controllers of ros2_control have one name everywhere, and a class that exists."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check

MODEL = '<robot name="r"><link name="base_link"/></robot>'
MANIFEST = "<package><name>r</name></package>"
LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(
            package="controller_manager",
            executable="ros2_control_node",
            parameters=["config/controllers.yaml"],
        ),
        Node(
            package="controller_manager",
            executable="spawner",
            arguments=["--controller-manager", "/controller_manager", "wheels"],
        ),
    ])
"""
YAML = """\
controller_manager:
  ros__parameters:
    wheels:
      type: diff_drive_controller/DiffDriveController
wheels:
  ros__parameters:
    wheel_separation: 0.3
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    for name, text in (
        ("package.xml", MANIFEST),
        ("r.urdf", MODEL),
        ("launch/robot.launch.py", LAUNCH),
        ("config/controllers.yaml", YAML),
    ):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, "utf-8")
    return tmp_path


def test_controllers_with_one_name_are_right(package: Path) -> None:
    assert check(package / "r.urdf") == []


@pytest.mark.parametrize(
    ("file", "right", "wrong", "line"),
    [
        ("launch/robot.launch.py", '"wheels"', '"wheel"', 14),
        ("config/controllers.yaml", "\nwheels:", "\nwheel:", 5),
        ("config/controllers.yaml", "/DiffDriveController", "/DiffDrive", 4),
    ],
)
def test_another_name_carries_the_right_one(
    package: Path, file: str, right: str, wrong: str, line: int
) -> None:
    text = (package / file).read_text("utf-8")
    (package / file).write_text(text.replace(right, wrong), "utf-8")

    (problem,) = check(package / "r.urdf")

    assert (problem.code, problem.file, problem.line) == (
        "controller-unknown",
        str(package / file),
        line,
    )
    (edit,) = problem.edits
    changed = (package / file).read_text("utf-8")
    assert changed[: edit.start] + edit.text + changed[edit.end :] == text


def test_a_spawner_may_bring_the_parameters_of_its_controller(package: Path) -> None:
    launch = package / "launch/robot.launch.py"
    text = launch.read_text("utf-8")
    own = '"wheel", "--param-file", "wheel.yaml"'
    launch.write_text(text.replace('"wheels"', own), "utf-8")
    assert check(package / "r.urdf") == []


def test_a_node_in_a_namespace_does_not_read_the_parameters_of_its_name(
    package: Path,
) -> None:
    launch = package / "launch/robot.launch.py"
    text = launch.read_text("utf-8")
    program = '            executable="ros2_control_node",\n'
    below = f'{program}            namespace="robot",\n'
    launch.write_text(text.replace(program, below), "utf-8")

    found = [p for p in check(package / "r.urdf") if p.file.endswith(".yaml")]

    assert [p.code for p in found] == ["launch-parameters-unread"]
    assert "robot/controller_manager" in found[0].message
    assert found[0].hint == "write /**/controller_manager"

"""A file belongs to the robot that names it, or whose launch file has it."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check

WHEEL = """
<link name="{0}_wheel"><collision><geometry><sphere radius="{1}"/></geometry>
</collision></link>
<joint name="{0}_joint" type="continuous"><parent link="base_link"/>
<child link="{0}_wheel"/><origin xyz="0 {2} 0"/><axis xyz="0 1 0"/></joint>"""
CONTROL = """
<ros2_control name="all" type="system">
<hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
<joint name="left_joint"><command_interface name="velocity"/></joint>
<joint name="right_joint"><command_interface name="velocity"/></joint>
</ros2_control>
<gazebo><plugin filename="gz_ros2_control-system" name="control">{}</plugin></gazebo>
"""
NAMES_FILE = "<parameters>$(find r)/config/{}.yaml</parameters>"
YAML = """\
controller_manager:
  ros__parameters:
    drive:
      type: diff_drive_controller/DiffDriveController
drive:
  ros__parameters:
    left_wheel_names: [left_joint]
    right_wheel_names: [right_joint]
    wheel_radius: {}
"""
LAUNCH = """\
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node

def generate_launch_description():
    share = get_package_share_directory("r")
    model = os.path.join(share, "urdf", "{0}.urdf")
    params = os.path.join(share, "config", "{1}.yaml")
    return LaunchDescription([
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            parameters=[{{"robot_description": Command(["xacro ", model])}}],
        ),
        Node(
            package="controller_manager",
            executable="spawner",
            arguments=["drive", "--param-file", params],
        ),
    ])
"""
ROBOTS = {"small": 0.1, "large": 0.3}
CODES = {"gazebo-joint", "drive-wheel-radius", "control-interface"}


def robot(name: str, radius: float, names: str = "") -> str:
    wheels = WHEEL.format("left", radius, 0.2) + WHEEL.format("right", radius, -0.2)
    return (
        f'<robot name="{name}"><link name="base_link"/>{wheels}'
        f"{CONTROL.format(NAMES_FILE.format(names) if names else '')}</robot>"
    )


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """Has two robots, whose parameters have names that say nothing of them."""
    files = {"package.xml": "<package><name>r</name></package>"}
    for name, radius in ROBOTS.items():
        files[f"urdf/{name}.urdf"] = robot(name, radius)
        files[f"config/{name[::-1]}.yaml"] = YAML.format(radius)
    for path, text in files.items():
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(text, "utf-8")
    return tmp_path


def named_by_models(package: Path) -> None:
    for name, radius in ROBOTS.items():
        text = robot(name, radius, name[::-1])
        (package / f"urdf/{name}.urdf").write_text(text, "utf-8")


def launched(package: Path) -> None:
    (package / "launch").mkdir()
    for name in ROBOTS:
        launch = package / f"launch/{name}.launch.py"
        launch.write_text(LAUNCH.format(name, name[::-1]), "utf-8")


def included(package: Path) -> None:
    """Let the launch file that opens a model include the one with the parameters."""
    (package / "launch").mkdir()
    for name in ROBOTS:
        (package / f"launch/{name}.launch.xml").write_text(
            '<launch><node pkg="robot_state_publisher" exec="robot_state_publisher">'
            '<param name="robot_description" value="$(command \'xacro '
            f"$(find-pkg-share r)/urdf/{name}.urdf')\"/></node>"
            f'<include file="$(find-pkg-share r)/launch/{name}_nodes.launch.xml"/>'
            "</launch>"
        )
        (package / f"launch/{name}_nodes.launch.xml").write_text(
            '<launch><node pkg="controller_manager" exec="spawner" args="drive '
            f'--param-file $(find-pkg-share r)/config/{name[::-1]}.yaml"/></launch>'
        )


def found(path: Path) -> list[tuple[str, str, int | None]]:
    problems = [p for p in check(path) if p.code in CODES and p.severity == "warning"]
    return [(p.code, Path(p.file or "").name, p.line) for p in problems]


@pytest.mark.parametrize("owned", [named_by_models, launched, included])
@pytest.mark.parametrize(
    ("right", "wrong", "code", "line"),
    [
        ("radius: 0.1", "radius: 0.2", "drive-wheel-radius", 9),
        ("[left_joint]", "[left_wheel]", "gazebo-joint", 7),
    ],
)
def test_parameters_are_compared_with_the_robot_that_uses_them(
    package: Path, owned: object, right: str, wrong: str, code: str, line: int
) -> None:
    assert callable(owned)
    owned(package)
    file = package / "config/llams.yaml"
    assert found(package) == []
    file.write_text(file.read_text("utf-8").replace(right, wrong), "utf-8")
    assert found(package) == [(code, "llams.yaml", line)]
    assert found(package / "urdf/small.urdf") == [(code, "llams.yaml", line)]
    assert found(package / "urdf/large.urdf") == []


def test_an_interface_is_that_of_the_robot(package: Path) -> None:
    launched(package)
    model = package / "urdf/small.urdf"
    text = model.read_text("utf-8").replace('"velocity"', '"position"', 1)
    model.write_text(text, "utf-8")
    assert [code for code, _, _ in found(package)] == ["control-interface"]


def test_a_file_without_a_known_robot_may_belong_to_any(package: Path) -> None:
    file = package / "config/llams.yaml"
    file.write_text(YAML.format(0.2), "utf-8")
    assert found(package) == []


def test_a_launch_file_that_may_open_any_model_decides_nothing(package: Path) -> None:
    launched(package)
    launch = package / "launch/small.launch.py"
    text = launch.read_text("utf-8").replace(
        '"small.urdf"', 'os.uname().nodename + ".urdf"'
    )
    launch.write_text(text, "utf-8")
    (package / "config/llams.yaml").write_text(YAML.format(0.2), "utf-8")
    assert found(package) == []

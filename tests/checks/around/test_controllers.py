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
    left_wheel_names: [left]
    right_wheel_names: [right]
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


@pytest.mark.parametrize(
    ("file", "right", "other"),
    [
        ("config/controllers.yaml", "diff_drive_controller/D", "my_drive_controller/D"),
        ("launch/robot.launch.py", '"wheels"', '"wheel_sensors"'),
    ],
)
def test_what_another_package_may_have_is_not_said(
    package: Path, file: str, right: str, other: str
) -> None:
    text = (package / file).read_text("utf-8")
    (package / file).write_text(text.replace(right, other), "utf-8")
    assert check(package / "r.urdf") == []


@pytest.mark.parametrize(
    ("package_of_node", "program"),
    [("rclcpp_components", "component_container"), ("own_driver", "driver_node")],
)
def test_a_node_whose_name_or_parts_are_not_known_may_read_any_file(
    package: Path, package_of_node: str, program: str
) -> None:
    launch = package / "launch/robot.launch.py"
    node = (
        f'        Node(package="{package_of_node}", executable="{program}",\n'
        '             parameters=["config/parts.yaml"]),\n'
    )
    text = launch.read_text("utf-8")
    launch.write_text(text.replace("    ])", f"{node}    ])"), "utf-8")
    (package / "config/parts.yaml").write_text(
        "camera:\n  ros__parameters:\n    rate: 1.0\n", "utf-8"
    )
    assert check(package / "r.urdf") == []


def test_a_file_that_another_launch_file_chooses_is_its_own_question(
    package: Path,
) -> None:
    launch = package / "launch/robot.launch.py"
    text = launch.read_text("utf-8")
    chosen = text.replace('"config/controllers.yaml"', 'LaunchConfiguration("file")')
    launch.write_text(
        chosen.replace(
            "from launch_ros",
            "from launch.actions import DeclareLaunchArgument\n"
            "from launch.substitutions import LaunchConfiguration\nfrom launch_ros",
            1,
        ).replace("[\n", '[\n        DeclareLaunchArgument("file"),\n', 1),
        "utf-8",
    )
    (package / "launch/other.launch.xml").write_text(
        '<launch><include file="$(find-pkg-share r)/launch/robot.launch.py">'
        '<arg name="file" value="$(find-pkg-share r)/config/other.yaml"/>'
        "</include></launch>",
        "utf-8",
    )
    (package / "config/other.yaml").write_text(
        "camera:\n  ros__parameters:\n    rate: 1.0\n", "utf-8"
    )
    assert "launch-parameters-unread" not in {p.code for p in check(package / "r.urdf")}


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


@pytest.mark.parametrize(
    "wrong",
    [
        "DiffDriveController",
        "diff_drive_controller",
        "diff_drive_controller::DiffDriveController",
        "DiffDriveController/diff_drive_controller",
        "DiffDriveControler",
    ],
)
@pytest.mark.parametrize("in_own_section", [False, True])
def test_a_class_is_package_and_class(
    package: Path, wrong: str, *, in_own_section: bool
) -> None:
    right, file = "diff_drive_controller/DiffDriveController", "config/controllers.yaml"
    text = YAML
    if in_own_section:
        # A spawner with --param-file reads the class there.
        launch = LAUNCH.replace('parameters=["config/controllers.yaml"],', "")
        (package / "launch/robot.launch.py").write_text(launch, "utf-8")
        text = text[text.index("wheels:\n  ros__") :].replace(
            "    wheel_sep", f"    type: {right}\n    wheel_sep"
        )
    (package / file).write_text(text.replace(right, wrong), "utf-8")

    (problem,) = check(package / "r.urdf")

    assert (problem.code, problem.hint) == ("controller-unknown", f"write {right}")


OWN = """\
import os
from ament_index_python.packages import get_package_share_directory
""" + LAUNCH.replace(
    "    return",
    """    params = os.path.join(
        get_package_share_directory("r"), "config", "controllers.yaml")
    return""",
).replace('"wheels"', '"{}", "--param-file", params')


@pytest.mark.parametrize(
    ("name", "found"),
    [("wheels", []), ("drive", ["write wheels"]), ("brake", [])],
)
def test_a_spawner_finds_its_controller_in_its_file(
    package: Path, name: str, found: list[str]
) -> None:
    (package / "launch/robot.launch.py").write_text(OWN.format(name), "utf-8")
    brake = "brake:\n  ros__parameters:\n    rate: 1.0\n"
    (package / "config/controllers.yaml").write_text(YAML + brake, "utf-8")
    problems = check(package / "r.urdf")
    assert [p.hint for p in problems if p.code == "controller-unknown"] == found


@pytest.mark.parametrize(
    ("name", "found"), [("diff_drive_controller", ["write wheels"]), ("lift", [])]
)
def test_the_only_controller_that_none_asks_for_is_the_one_of_the_class(
    package: Path, name: str, found: list[str]
) -> None:
    launch = package / "launch/robot.launch.py"
    launch.write_text(LAUNCH.replace('"wheels"', f'"{name}"'), "utf-8")
    other = package / "launch/other.launch.py"
    other.write_text(LAUNCH, "utf-8")
    assert [problem.hint for problem in check(package / "r.urdf")] == found


def test_the_file_of_the_model_has_the_controllers(package: Path) -> None:
    launch = package / "launch/robot.launch.py"
    launch.write_text(LAUNCH.replace('"wheels"', '"lift"'), "utf-8")
    plugin = (
        '<gazebo><plugin filename="gz_ros2_control-system" name="control">'
        "<parameters>/share/r/config/controllers.yaml</parameters></plugin></gazebo>"
    )
    model = MODEL.replace("</robot>", f"{plugin}</robot>")
    (package / "r.urdf").write_text(model, "utf-8")
    problems = check(package / "r.urdf")
    hints = [p.hint for p in problems if p.code == "controller-unknown"]
    assert hints == ["write wheels"]


def test_each_file_is_that_of_one_robot(package: Path) -> None:
    other = package / "config/other.yaml"
    other.write_text(YAML, "utf-8")
    file = package / "config/controllers.yaml"
    file.write_text(YAML.replace("DiffDriveC", "DiffDriveK"), "utf-8")
    (problem,) = check(package / "r.urdf")
    assert (problem.file, problem.line) == (str(file), 4)

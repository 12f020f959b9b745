"""Launch files that Python reads and launch cannot run are found, and mended."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files
from manifests import manifest

from sambot_viz.checks import check
from sambot_viz.errors import Problem

MANIFEST = manifest(
    "demo",
    "launch_ros",
    "robot_state_publisher",
    "ros_gz_bridge",
    "ros_gz_sim",
    "xacro",
)
LISTED = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    time = LaunchConfiguration("use_sim_time")
    node = Node(
        package="demo", executable="talker", parameters=[{"use_sim_time": time}]
    )
    return LaunchDescription([
        DeclareLaunchArgument("use_sim_time", default_value="true"),
        node,
    ])
"""
ADDED = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    ld = LaunchDescription()
    name = LaunchConfiguration("name")
    ld.add_action(DeclareLaunchArgument("name", default_value="a"))
    ld.add_action(Node(package="demo", executable="b", name=name))
    return ld
"""
DECLARED = '        DeclareLaunchArgument("use_sim_time", default_value="true"),\n'
ADDS = '    ld.add_action(DeclareLaunchArgument("name", default_value="a"))\n'
LATE = "        node,\n"
GZ = """\
from launch import LaunchDescription
from ros_gz_bridge.actions import RosGzBridge
from ros_gz_sim.actions import GzServer


def generate_launch_description():
    return LaunchDescription([
        GzServer(
            container_name="gz_parts",
            create_own_container="True",
            use_composition="True",
        ),
        RosGzBridge(
            bridge_name="bridge",
            config_file="bridge.yaml",
            container_name="gz_parts",
            create_own_container="False",
            use_composition="True",
        ),
    ])
"""


def problems(folder: Path, text: str, name: str = "sim.launch.py") -> list[Problem]:
    (folder / "launch").mkdir(exist_ok=True)
    (folder / "package.xml").write_text(MANIFEST)
    (folder / "launch" / name).write_text(text)
    return [p for p in check(folder) if p.file and p.file.endswith(name)]


def mended(folder: Path, problem: Problem, name: str = "sim.launch.py") -> str:
    return edited_files(problem.edits)[str(folder / "launch" / name)].decode()


@pytest.mark.parametrize("text", [LISTED, ADDED, GZ])
def test_a_right_launch_file_has_no_finding(tmp_path: Path, text: str) -> None:
    assert problems(tmp_path, text) == []


@pytest.mark.parametrize(
    ("text", "wrong", "cause"),
    [
        (
            LISTED,
            LISTED.replace(DECLARED, "").replace(LATE, LATE + DECLARED),
            "use_sim_time is declared after its first use (line 13)",
        ),
        (
            ADDED,
            ADDED.replace(ADDS, "").replace("    return ld", ADDS + "    return ld"),
            "name is declared after its first use (line 10)",
        ),
        (
            LISTED,
            LISTED.replace("    return LaunchD", "return LaunchD"),
            "'return' outside function",
        ),
        (
            GZ,
            GZ.replace('"gz_parts"', '"parts"', 1),
            "loaded into the container gz_parts, but the one that starts is parts",
        ),
    ],
)
def test_what_stops_a_launch_file_is_mended(
    tmp_path: Path, text: str, wrong: str, cause: str
) -> None:
    (problem,) = problems(tmp_path, wrong)
    assert cause in problem.message
    right = text.replace('"gz_parts"', '"parts"') if text == GZ else text
    assert mended(tmp_path, problem) == right


def test_an_included_file_may_declare_an_argument(tmp_path: Path) -> None:
    late = LISTED.replace(DECLARED, "        IncludeLaunchDescription(other()),\n")
    late = late.replace(LATE, LATE + DECLARED)
    late = late.replace("import Declare", "import IncludeLaunchDescription, Declare")
    late = late.replace(
        "\n\n\ndef gen", "\n\nfrom robot.mine import other\n\n\ndef gen"
    )
    assert problems(tmp_path, late) == []


def test_an_argument_given_twice_is_no_python(tmp_path: Path) -> None:
    twice = LISTED.replace('"demo", ', '"demo", package="demo", ')
    (problem,) = problems(tmp_path, twice)
    assert (problem.code, problem.line) == ("python-syntax", 10)


PUBLISHER = """\
<launch>
  <arg name="model" default="$(find-pkg-share robot)/robot.urdf"/>
  <node pkg="robot_state_publisher" exec="robot_state_publisher">
    <param name="robot_description" value="$(command 'xacro $(var model)')"/>
  </node>
</launch>
"""


@pytest.mark.parametrize("value", ["xacro $(var model)", "$(find-pkg-share a)/b.urdf"])
def test_a_description_needs_its_command(tmp_path: Path, value: str) -> None:
    (tmp_path / "robot.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    name = "view.launch.xml"
    wrong = PUBLISHER.replace("$(command 'xacro $(var model)')", value)
    found = problems(tmp_path, wrong, name)
    problem = next(p for p in found if p.code == "launch-description")
    path = value.removeprefix("xacro ")
    assert mended(tmp_path, problem, name) == PUBLISHER.replace("$(var model)", path)


def test_the_text_of_a_model_is_no_file_of_parameters(tmp_path: Path) -> None:
    text = LISTED.replace("demo", "robot_state_publisher")
    text = text.replace("talker", "robot_state_publisher")
    text = text.replace("[{", "[model, {").replace(
        "    node = ", '    model = Command(["xacro ", "robot.urdf"])\n    node = '
    )
    text = text.replace("import LaunchConf", "import Command, LaunchConf")
    found = [p for p in problems(tmp_path, text) if p.code == "launch-description"]
    assert "this is the text of the model" in found[0].message
    assert "[{'robot_description': model}, {" in mended(tmp_path, found[0])


def test_a_key_of_yaml_is_mended_at_its_line(tmp_path: Path) -> None:
    right = "launch:\n- node:\n    pkg: demo\n    exec: talker\n"
    name = "a.launch.yaml"
    assert problems(tmp_path, right, name) == []
    (problem,) = problems(tmp_path, right.replace("exec", "executable"), name)
    assert problem.line == 4
    assert mended(tmp_path, problem, name) == right

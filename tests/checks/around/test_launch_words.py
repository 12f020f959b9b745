"""What launch does not know or take is found in each form of launch file."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files
from manifests import written

from sambot_viz.checks import check
from sambot_viz.errors import Problem

PYTHON, XML, YAML = "launch/a.launch.py", "launch/b.launch.xml", "launch/c.launch.yaml"
FILES = {
    "package.xml": """\
<package format="3">
  <name>robot</name>
  <version>0.0.1</version>
  <description>A robot.</description>
  <maintainer email="me@example.org">me</maintainer>
  <license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <exec_depend>joint_state_publisher</exec_depend>
  <exec_depend>joint_state_publisher_gui</exec_depend>
  <exec_depend>rviz2</exec_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
""",
    "CMakeLists.txt": """\
cmake_minimum_required(VERSION 3.8)
project(robot)
find_package(ament_cmake REQUIRED)
install(DIRECTORY launch rviz DESTINATION share/${PROJECT_NAME})
ament_package()
""",
    "rviz/colours.yaml": "/**:\n  ros__parameters: {colour: red}\n",
    "rviz/robot.rviz": """\
Visualization Manager:
  Global Options: {Fixed Frame: base}
  Displays:
    - {Class: rviz_default_plugins/RobotModel, Enabled: true}
""",
    PYTHON: """\
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    share = get_package_share_directory('robot')
    config = os.path.join(share, 'rviz', 'robot.rviz')
    kind = 'yaml'
    colours = os.path.join(share, 'rviz', f'colours.{kind}')
    other = 'start'
    return LaunchDescription([
        IncludeLaunchDescription(
            os.path.join(share, 'launch', 'b.launch.xml'),
            launch_arguments={'view': 'true', 'rviz': config}.items(),
        ),
        DeclareLaunchArgument('gui', default_value='true'),
        Node(
            package='joint_state_publisher',
            executable='joint_state_publisher',
            output='screen',
            name=other,
            parameters=[{'use_sim_time': True}, colours],
            arguments=[
                '--log-level',
                'info',
            ],
            remappings=[('a', 'b')],
            condition=IfCondition(LaunchConfiguration('gui')),
        ),
    ])
""",
    XML: """\
<launch>
  <arg name="view" default="true"/>
  <node pkg="rviz2" exec="rviz2" output="screen" if="$(var view)"
        args="-d $(find-pkg-share robot)/rviz/robot.rviz">
    <param name="use_sim_time" value="true"/>
    <param from="$(find-pkg-share robot)/rviz/colours.yaml"/>
    <remap from="a" to="b"/>
  </node>
</launch>
""",
    YAML: """\
launch:
- arg: {name: model, default: a, choice: [{value: a}, {value: b}]}
- node: {pkg: rviz2, exec: rviz2, args: $(var model)}
""",
}
STOPS = "ros2 launch stops with it"
CASES = [
    (PYTHON, "tory('robot')", "tory(\n        'robt')", "asks for the package robt"),
    (XML, 'pkg="rviz2"', 'pkg="rviz"', "no package rviz, but rviz2 is in rviz2"),
    (PYTHON, "'true', 'rviz'", "'ture', 'rviz'", "ture is neither true nor false"),
    (PYTHON, "LaunchConfiguration('gui')", "'gui'", "neither true nor false"),
    (PYTHON, "_ros.actions import", ".actions import", "launch.actions has no Node"),
    (PYTHON, "substitutions import", "substitution import", "no module launch.subst"),
    (PYTHON, "import IfCondition", "import IfConditon", "conditions has no IfConditon"),
    (PYTHON, "package=", "pkg=", "Node has no argument pkg, but package"),
    (PYTHON, "executable=", "exec=", "Node has no argument exec, but executable"),
    (PYTHON, "   arguments=", "   args=", "Node has no argument args, but arguments"),
    (PYTHON, "default_value=", "default=", "no argument default, but default_value"),
    (PYTHON, "use_sim_time", "use_simtime", "but each has use_sim_time"),
    (PYTHON, "'--log-level',\n", "'--log-level'\n", "a comma is missing at the end"),
    (
        PYTHON,
        "'--log-level',\n                'info',",
        "'--log-level ' + other",
        "the plus makes one word",
    ),
    (
        PYTHON,
        "[{'use_sim_time': True}, colours]",
        "[os.path.join(share, 'rviz/colours.yaml', {'use_sim_time': True})]",
        "this is a dict",
    ),
    (PYTHON, "('a', 'b')", "['a', 'b']", "remappings are a list of tuples"),
    (PYTHON, "[('a', 'b')]", "('a', 'b')", "remappings are a list of tuples"),
    (PYTHON, "[{'use_sim_time': True}, colours]", "{'use_sim_time': True}", "a dict"),
    (PYTHON, "f'colours", "'colours", "has no f before its quotation mark"),
    (PYTHON, "time': True", "time', True", "use_sim_time gets no value"),
    (
        PYTHON,
        "'view': 'true', 'rviz': config",
        "'view', 'true', 'rviz', config",
        "a comma makes this a set of values, not a dict: view gets no value",
    ),
    (PYTHON, "('a', 'b')", "{'a', 'b'}", "remappings are a list of tuples"),
    (PYTHON, "generate_launch_description", "generate", "this one is called generate"),
    (PYTHON, "        Node(", "        'Node'(", "Node is in quotation marks"),
    (
        PYTHON,
        "executable='joint_state_publisher'",
        "executable='joint_state_publisher_gui'",
        "which is in joint_state_publisher_gui",
    ),
    (PYTHON, "Configuration('gui')", "Configuration('gu')", "gui is (line 22)"),
    (XML, "pkg=", "package=", "<node> has no attribute package, but pkg"),
    (XML, "exec=", "type=", "<node> has no attribute type, but exec"),
    (XML, "find-pkg-share", "find", "no substitution $(find …)"),
    (XML, "$(var view)", "$(arg view)", "no substitution $(arg …), but $(var …)"),
    (XML, "$(var view)", "$(var vew)", "vew is not declared; view is (line 2)"),
    (XML, "<remap ", "<remaps ", "no <remaps> in <node>, but <remap>"),
    (XML, "<param from", '<rosparam command="load" file', "no <rosparam> in <node>"),
    (XML, "<param from", '<param command="load" from', "has no command beside it"),
    (XML, "<param from", '<param name="a" from', "has no name beside it"),
    (XML, "default=", "value=", "<arg> has no attribute value, but default"),
    (YAML, "exec:", "executable:", "node has no attribute executable, but exec"),
    (PYTHON, "'screen'", "'sceen'", "output is sceen, and takes only screen, log"),
    (XML, '"screen"', '"Screen"', "output is Screen, and takes only screen, log"),
    (PYTHON, ".join(", ".jion(", "os.path has no jion, but join"),
    (PYTHON, ".items()", ".item()", "a dict has no item, but items"),
    (XML, "share robot)", "share robt)", "asks for the package robt"),
    (XML, "robot.rviz", "robots.rviz", "uses rviz/robots.rviz, which the package"),
    (
        YAML,
        "exec: rviz2,",
        "exec: rviz2, remappings: [{from: a, to: b}],",
        "there is no remappings in node, but remap:",
    ),
    (YAML, "launch:", "launhc:", "key of a launch file is launch, and this is launhc"),
    (YAML, "default: a", "default: aa", "default is aa, and takes only a and b"),
    (YAML, "pkg: rviz2", "pkg: my_rviz", "rviz2 is in rviz2, and a package my_rviz"),
]
UNSURE = [
    (
        PYTHON,
        "config = os.path.join(share, 'rviz', 'robot.rviz')",
        "config = os.path.join(LaunchConfiguration('quick'), 'rviz')",
        "LaunchConfiguration is a substitution, whose text launch finds later",
    ),
    (
        PYTHON,
        "config = os.path.join(share, 'rviz', 'robot.rviz')",
        "config = open(LaunchConfiguration('quick')).read()",
        "and open takes texts",
    ),
    (PYTHON, "LaunchDescription([", "LaunchDescription(['gui',", "a text in a list"),
    (PYTHON, "'info'", "'$(find robot)/x'", "launch replaces $(find robot) in launch"),
    (PYTHON, "Configuration('gui')", "Configuration('quick')", "quick is not declared"),
    (PYTHON, "remappings=[('a', 'b')]", "remappings=['a', 'b']", "and this is none"),
    (PYTHON, "'true'),\n", "'true'),\n        [],\n", "a list in a list of actions"),
    (XML, "<param from", '<param name="a" value="b" from', "has no name beside it"),
    (XML, 'param name="use_sim_time" v', 'rosparam param="a" v', "no <rosparam> in"),
    (XML, "$(var view)", "$(var quick)", "quick is not declared"),
    (PYTHON, "'view': 'true'", "'view': 'yes'", "view is yes, neither true nor false"),
    (XML, "  </node>\n", "", "<node> begins here, and </launch> comes before"),
    (PYTHON, "executable='joint_state_publisher',", "", "Node has no executable"),
    (
        PYTHON,
        "package='joint_state_publisher',",
        "",
        "joint_state_publisher has no pac",
    ),
    (PYTHON, "'gui', default", "default", "DeclareLaunchArgument has no name, which"),
    (
        PYTHON,
        "share, 'rviz', f'colours.{kind}')",
        "share, '{gui}')\n    gui = LaunchConfiguration('gui')",
        "has no f before its quotation mark",
    ),
    (PYTHON, "(share, 'r", "(other, 'r", "other is used here, but gets its first"),
]


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A right package with a launch file of each form."""
    folder = written(tmp_path / "robot", FILES)
    (folder / "robot.urdf").write_text('<robot name="r"><link name="base"/></robot>')
    return folder


def found(package: Path, file: str, right: str, wrong: str) -> list[Problem]:
    """Return what is found after a change of one file."""
    text = (package / file).read_text()
    assert right in text
    (package / file).write_text(text.replace(right, wrong, 1))
    return check(package)


def test_right_launch_files_have_no_problem(package: Path) -> None:
    assert check(package) == []


@pytest.mark.parametrize(("file", "right", "wrong", "cause"), CASES)
def test_a_mistake_in_a_launch_file_is_undone_by_its_edit(
    package: Path, file: str, right: str, wrong: str, cause: str
) -> None:
    problems = [p for p in found(package, file, right, wrong) if cause in p.message]
    (problem,) = problems
    path = package / file
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert check(package) == []


@pytest.mark.parametrize(("file", "right", "wrong", "cause"), UNSURE)
def test_a_mistake_with_several_remedies_has_its_line(
    package: Path, file: str, right: str, wrong: str, cause: str
) -> None:
    line = FILES[file].partition(right)[0].count("\n") + 1
    problems = found(package, file, right, wrong)
    assert any(cause in p.message and abs((p.line or 0) - line) < 6 for p in problems)
    assert not any(p.edits for p in problems)


def test_a_launch_file_of_ros_1_is_told_once(package: Path) -> None:
    old = '<launch><node pkg="a" type="b" args="$(find c)"/></launch>'
    (package / "launch/old.launch").write_text(old)
    (problem,) = check(package)
    assert problem.severity == "info"
    assert "this launch file is written for ROS 1" in problem.message
    gone = old.replace("$(find c)", "$(find robot)/config/robott.rviz")
    (package / "launch/older.launch").write_text(gone)
    (problem,) = check(package)
    assert "old.launch and older.launch are launch files written" in problem.message


def test_what_an_included_file_declares_is_declared(package: Path) -> None:
    path = package / XML
    include = '<include file="$(find-pkg-share other)/launch/x.launch.xml"/>'
    text = path.read_text().replace("<node", f"{include}<node")
    path.write_text(text.replace("(var view)", "(var elsewhere)"))
    (problem,) = check(package)
    assert problem.severity == "info"


SHARES = [
    "share = FindPackageShare('robot')",
    "share = FindPackageShare(package='robot')",
    "folder = FindPackageShare('robot')\n    share = os.path.join(folder, '')",
]


@pytest.mark.parametrize("share", SHARES)
def test_a_substitution_is_no_text_for_python(package: Path, share: str) -> None:
    imported = "from ament_index_python.packages import get_package_share_directory"
    text = FILES[PYTHON].replace(
        imported, "from launch_ros.substitutions import FindPackageShare"
    )
    path = package / PYTHON
    old = "share = get_package_share_directory('robot')"
    path.write_text(text.replace(old, share))
    (problem,) = check(package)
    assert (problem.code, problem.severity) == ("launch-code", "error")
    assert problem.hint == "write .find('robot') after it"
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert check(package) == []


def test_an_input_of_a_function_may_be_a_text(package: Path) -> None:
    path = package / PYTHON
    text = path.read_text()
    text = text.replace("other = 'start'", "other = LaunchConfiguration('gui')")
    before = "def path(other):\n    return os.path.join(other, 'a')\n\n\n"
    path.write_text(text.replace("def gen", f"{before}def gen"))
    assert check(package) == []

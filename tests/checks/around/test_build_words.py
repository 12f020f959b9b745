"""What stops a build, or hides what it has built, is found and undone by its edit."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files
from manifests import written

from sambot_viz.checks import check
from sambot_viz.errors import Problem

CMAKE, MANIFEST, SETUP, CFG = "CMakeLists.txt", "package.xml", "setup.py", "setup.cfg"
LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package='rviz2', executable='rviz2'),
        Node(package='xacro', executable='xacro'),
        Node(package='tf2_ros', executable='tf2_monitor'),
    ])
"""
XML = """\
<package format="3">
  <name>robot</name>
  <version>0.0.1</version>
  <description>A robot.</description>
  <maintainer email="me@example.org">me</maintainer>
  <license>MIT</license>
  <buildtool_depend>{kind}</buildtool_depend>
  <exec_depend>rviz2</exec_depend>
  <exec_depend>xacro</exec_depend>
  <exec_depend>tf2_ros</exec_depend>
  <export><build_type>{kind}</build_type></export>
</package>
"""
IN_CMAKE = {
    MANIFEST: XML.format(kind="ament_cmake"),
    CMAKE: """\
cmake_minimum_required(VERSION 3.8)
project(robot)
find_package(ament_cmake REQUIRED)
if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
endif()
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
ament_export_dependencies(rviz2)
ament_package()
""",
    "launch/a.launch.py": LAUNCH,
}
MARK = """
        ('share/ament_index/resource_index/packages', ['resource/robot']),"""
IN_PYTHON = {
    MANIFEST: XML.format(kind="ament_python"),
    SETUP: f"""\
from glob import glob
from setuptools import setup

setup(
    name='robot',
    packages=['robot'],
    data_files=[{MARK}
        ('share/robot', ['package.xml']),
        ('share/robot/launch', glob('launch/*.py')),
    ],
    entry_points={{'console_scripts': ['drive = robot.drive:main']}},
)
""",
    CFG: """\
[develop]
script_dir=$base/lib/robot
[install]
install_scripts=$base/lib/robot
""",
    "resource/robot": "",
    "robot/__init__.py": "",
    "robot/drive.py": "def main():\n    pass\n",
    "launch/a.launch.py": LAUNCH,
}
DRIVE = "drive = robot.drive:main"
TF = "<exec_depend>tf2_ros</exec_depend>\n  "
CASES = [
    (MANIFEST, '<package format="3">', '<pckage format="3">', "<pckage> is not a tag"),
    (MANIFEST, 'format="3"', "format=3", "the value of format is not in quotes"),
    (MANIFEST, 'format="3"', 'format="3', "the value of format is not in quotes"),
    (MANIFEST, '<package format="3">\n', "", "</package> closes nothing"),
    (MANIFEST, "\n</package>", "", "<package> is not closed"),
    (MANIFEST, "</package>", "</pakage>", "</pakage> is not a tag"),
    (MANIFEST, "<license>", "<licence>", "<licence> is closed by </license>"),
    (MANIFEST, "<license>", "license>", "license has no <"),
    (MANIFEST, "<license>", "<license", "<license has no >"),
    (MANIFEST, "0.0.1", "", "<version> is empty"),
    (MANIFEST, "depend>ament_cmake", "depend>catkin", "is a package of ROS 1"),
    (MANIFEST, "depend>ament_cmake", "depend>maent_cmake", "there is ament_cmake"),
    (MANIFEST, ">tf2_ros<", ">tf2ros<", "package.xml depends on tf2ros"),
    (MANIFEST, "type>ament_cmake", "type>Ament_cmake", "colcon knows no Ament_cmake"),
    (CMAKE, "\nendif()", "", "the if( … ) of line 4 has no endif()"),
    (MANIFEST, ' format="3"', "", "of format 1, which has no <exec_depend>"),
    (CMAKE, "project(robot)\n", "", "there is no project( … )"),
    (CMAKE, "VERSION", "version", "cmake_minimum_required( … ) has version"),
    (CMAKE, "project(", "projcet(", "there is no command projcet()"),
    (CMAKE, "install(", "instal(", "there is no command instal()"),
    (CMAKE, "REQUIRED", "required", "find_package knows no word required"),
    (CMAKE, "DESTINATION", "destination", "install( … ) has destination"),
    (CMAKE, "DIRECTORY", "DIRECTROY", "install( … ) has DIRECTROY"),
    (CMAKE, "ament_package()", "ament_package(", "the ( of ament_package is not"),
    (CMAKE, "if(BUILD_TESTING)", "if(BUILD_TESTING", "the ( of if is not closed"),
    (CMAKE, "launch DEST", "launch)\n  DEST", "this ) closes nothing"),
    (CMAKE, "3.8)", '"3.8)', "is opened and not closed"),
    (CFG, "[install]", "[instal]", "no install_scripts in [install]"),
    (CFG, "[install]\n", "", "no install_scripts in [install]"),
    (CFG, "install_scripts=$base/lib/robot\n", "", "no install_scripts in [install]"),
    (CFG, "script_dir", "script_dirs", "no script_dir in [develop]"),
    (CFG, "[develop]\n", "", "is in no section"),
    (SETUP, "from glob import glob", "import glob", "glob is a module here"),
    (SETUP, "glob('", "glob.glob('", "glob is not the module here"),
    (SETUP, "from setuptools import setup\n", "", "setup is used here"),
    (SETUP, "robot.drive:main", "drive:main", "has no drive.py beside setup.py"),
    (SETUP, "share/robot/launch", "share/robto/launch", "installed into share/robto"),
    (SETUP, "glob('launch/*.py')", "glob('launch/')", "launch, which is a folder"),
    (SETUP, "['package.xml']),", "['package.xml'])", "a comma is missing"),
    (MANIFEST, "type>ament_cmake", "type>catkin", "is the build type of ROS 1"),
    (SETUP, "name='robot'", "version='0.0.1'", "setup( … ) is given no name"),
    (SETUP, ", ['resource/robot'])", ")", "alone, and no list of files"),
    (SETUP, "'drive = ", "'drive ", "no = between a program and its function"),
    (SETUP, "robot.drive:main", "robot.drive.py:main", "has dots and no .py"),
    (SETUP, "robot.drive:main", "robot/drive:main", "has dots and no .py"),
    (SETUP, "robot.drive:main", "robot.drive", "a colon has to be before the function"),
    (SETUP, MARK, "", "by which ROS finds the package"),
    (SETUP, "launch/*.py", "launch/*.xml", "launch/*.xml fits no file"),
]
SAID = [
    (CMAKE, "\nif(BUILD_TESTING)", "", "error", "endif() closes nothing"),
]


def package_of(folder: Path, files: dict[str, str]) -> Path:
    """Write a package with a model into a folder."""
    model = {"robot.urdf": '<robot name="r"><link name="base"/></robot>'}
    return written(folder, files | model)


def package_with(folder: Path, file: str, right: str, wrong: str) -> Path:
    """Write a package in which one text of a file is another."""
    files = dict(IN_PYTHON if file in (SETUP, CFG) else IN_CMAKE)
    assert right in files[file]
    return package_of(folder, {**files, file: files[file].replace(right, wrong, 1)})


def undone(package: Path, problem: Problem, file: str) -> list[Problem]:
    """Return what is found after the edits of a problem."""
    path = package / file
    path.write_bytes(edited_files(problem.edits)[str(path)])
    return check(package)


@pytest.mark.parametrize("files", [IN_CMAKE, IN_PYTHON])
def test_a_right_package_has_no_problem(tmp_path: Path, files: dict[str, str]) -> None:
    assert check(package_of(tmp_path / "robot", files)) == []


@pytest.mark.parametrize(("file", "right", "wrong", "cause"), CASES)
def test_a_mistake_in_a_build_file_is_undone_by_its_edit(
    tmp_path: Path, file: str, right: str, wrong: str, cause: str
) -> None:
    package = package_with(tmp_path / "robot", file, right, wrong)
    (problem,) = check(package)
    assert cause in problem.message
    assert undone(package, problem, file) == []


def test_the_name_of_a_variable_in_quotation_marks(tmp_path: Path) -> None:
    package = package_of(tmp_path / "robot", IN_PYTHON)
    text = "package_name = 'robot'\n" + IN_PYTHON[SETUP].replace(
        "'share/robot/launch'", "'share/' + 'package_name' + '/launch'"
    )
    (package / SETUP).write_text(text)
    (problem,) = check(package)
    assert problem.hint == "write 'share/' + package_name + '/launch'"
    assert undone(package, problem, SETUP) == []


def test_a_name_that_only_package_xml_has_is_the_wrong_one(tmp_path: Path) -> None:
    package = package_of(tmp_path / "robot", IN_PYTHON)
    text = IN_PYTHON[MANIFEST].replace("<name>robot<", "<name>my-robot<")
    (package / MANIFEST).write_text(text)
    (problem,) = check(package)
    assert (problem.code, problem.file) == ("setup-py-name", str(package / MANIFEST))
    assert undone(package, problem, MANIFEST) == []


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("<version>0.0.1</version>", "<versoin>0.0.1</versoin>"),
        (TF.strip(), TF.strip().replace("exec_depend", "exec_depends")),
    ],
)
def test_an_element_that_is_misspelt_is_not_missing_too(
    tmp_path: Path, right: str, wrong: str
) -> None:
    package = package_with(tmp_path / "robot", MANIFEST, right, wrong)
    (problem,) = check(package)
    assert f"has no {wrong.partition('>')[0]}>" in problem.message
    assert undone(package, problem, MANIFEST) == []


@pytest.mark.parametrize(("file", "right", "wrong", "severity", "cause"), SAID)
def test_a_mistake_in_a_build_file_without_an_edit_is_told(
    tmp_path: Path, file: str, right: str, wrong: str, severity: str, cause: str
) -> None:
    (problem,) = check(package_with(tmp_path / "robot", file, right, wrong))
    assert (problem.severity, problem.edits) == (severity, ())
    assert cause in problem.message


def test_ament_package_is_moved_to_the_end(tmp_path: Path) -> None:
    lines = "ament_export_dependencies(rviz2)\nament_package()\n"
    other = "ament_package()\nament_export_dependencies(rviz2)\n"
    package = package_with(tmp_path / "robot", CMAKE, lines, other)
    (problem,) = check(package)
    assert "comes before ament_export_dependencies()" in problem.message
    assert undone(package, problem, CMAKE) == []
    assert (package / CMAKE).read_text() == IN_CMAKE[CMAKE]


def test_a_package_that_is_started_is_added_to_the_dependencies(tmp_path: Path) -> None:
    package = package_with(tmp_path / "robot", MANIFEST, TF, "")
    (problem,) = check(package)
    assert problem.severity == "info"
    assert "launch files use tf2_ros (a.launch.py line 9)" in problem.message
    assert undone(package, problem, MANIFEST) == []


@pytest.mark.parametrize(
    ("found", "needed", "missing"),
    [
        ("", "rclcpp", "rclcpp"),
        ("rclcpp", "rclcpp sensor_msgs", "sensor_msgs"),
        ("sensor_msgs", "sensor_msgs rclcpp", "rclcpp"),
        # What a package brings may be all that another one needs.
        ("sensor_msgs", "geometry_msgs", None),
        ("tf2_ros", "rclcpp", None),
        ("rclcpp", "builtin_interfaces", None),
        ("", "my_own_package", None),
    ],
)
def test_a_target_needs_packages_that_are_found(
    tmp_path: Path, found: str, needed: str, missing: str | None
) -> None:
    target = f"add_executable(n n.cpp)\nament_target_dependencies(n {needed})\n"
    lines = "".join(f"find_package({name} REQUIRED)\n" for name in found.split())
    package = package_with(tmp_path / "robot", CMAKE, "if(", f"{lines}{target}if(")
    problems = check(package)
    assert len(problems) == (missing is not None)
    for problem in problems:
        assert f"is given {missing}, which no find_package" in problem.message
        assert undone(package, problem, CMAKE) == []


def test_a_package_that_only_tests_find_is_not_found_before(tmp_path: Path) -> None:
    target = "add_executable(n n.cpp)\nament_target_dependencies(n rclcpp)\nif("
    tests = "  find_package(rclcpp REQUIRED)\nendif("
    package = package_with(tmp_path / "robot", CMAKE, "if(", target)
    text = (package / CMAKE).read_text()
    (package / CMAKE).write_text(text.replace("endif(", tests))
    (problem,) = check(package)
    assert "is given rclcpp" in problem.message
    assert undone(package, problem, CMAKE) == []


def test_a_plugin_reads_parameters_that_the_package_has(tmp_path: Path) -> None:
    package = package_of(tmp_path / "robot", IN_CMAKE)
    (package / "config").mkdir()
    (package / "config/controllers.yaml").write_text("a: {ros__parameters: {b: 1}}\n")
    text = IN_CMAKE[CMAKE].replace("DIRECTORY launch", "DIRECTORY launch config")
    (package / CMAKE).write_text(text)
    (package / "robot.urdf").unlink()
    model = package / "robot.urdf.xacro"
    right = (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<link name="base"/>\n<gazebo><plugin name="gz_ros2_control::'
        'GazeboSimROS2ControlPlugin" filename="gz_ros2_control-system">\n'
        "<parameters>$(find robot)/config/controllers.yaml</parameters>\n"
        "</plugin></gazebo></robot>"
    )
    model.write_text(right)
    assert not [p for p in check(model) if "does not have" in p.message]
    model.write_text(right.replace("controllers.yaml", "controlers.yaml"))
    (problem,) = [p for p in check(model) if "does not have" in p.message]
    assert edited_files(problem.edits)[str(model)].decode() == right


def test_a_package_of_python_that_is_misspelt(tmp_path: Path) -> None:
    right = IN_PYTHON[SETUP]
    assert "packages=['robot']," in right
    needed = "packages=['robot'],\n    install_requires=['setuptools'],"
    wrong = needed.replace("setuptools", "setupptools")
    package = package_with(tmp_path / "robot", SETUP, "packages=['robot'],", wrong)
    (problem,) = check(package)
    assert "setupptools, which is no package of Python" in problem.message
    assert undone(package, problem, SETUP) == []
    text = (package / SETUP).read_text()
    assert text == right.replace("packages=['robot'],", needed)

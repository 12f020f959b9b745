"""CMakeLists.txt installs the programs that launch files start."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits, by_file

CMAKE = """\
cmake_minimum_required(VERSION 3.8)
project(r)
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
add_executable(drive src/drive.cpp)
ament_target_dependencies(drive rclcpp)
install(TARGETS drive DESTINATION lib/${PROJECT_NAME})
install(PROGRAMS scripts/stop.py DESTINATION lib/${PROJECT_NAME})
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
ament_package()
"""
LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(package="r", executable="drive"),
        Node(package="r", executable="stop.py"),
    ])
"""
FILES = {
    "package.xml": "<package format='3'><name>r</name><version>0.0.0</version>"
    "<description>R.</description><maintainer email='a@b.c'>A</maintainer>"
    "<license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend>"
    "<depend>rclcpp</depend><exec_depend>launch_ros</exec_depend>"
    "<export><build_type>ament_cmake</build_type></export></package>",
    "CMakeLists.txt": CMAKE,
    "src/drive.cpp": "int main() {}",
    "scripts/stop.py": "import rclpy",
    "launch/r.launch.py": LAUNCH,
    "r.urdf": '<robot name="r"><link name="base_link"/></robot>',
}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, "utf-8")
    return tmp_path


def test_installed_programs_are_right(package: Path) -> None:
    assert found(package) == {}


STOP = "install(PROGRAMS scripts/stop.py DESTINATION lib/${PROJECT_NAME})\n"


@pytest.mark.parametrize(
    ("right", "wrong", "code", "hint"),
    [
        (STOP, "", "launch-program-unknown", f"add {STOP.strip()} to CMakeLists.txt"),
        (
            "stop.py DESTINATION lib/",
            "stop.py DESTINATION share/",
            "install-destination",
            "write lib/${PROJECT_NAME}",
        ),
        (
            "drive DESTINATION lib/${PROJECT_NAME}",
            "drive DESTINATION bin",
            "install-destination",
            "write lib/${PROJECT_NAME}",
        ),
        ("PROGRAMS", "FILES", "install-destination", "write PROGRAMS"),
        (
            "PROGRAMS scripts/stop.py",
            "DIRECTORY scripts",
            "install-destination",
            "write scripts/",
        ),
        (
            "PROGRAMS scripts/stop.py",
            "PROGRAMS stop.py",
            "cmake-file-missing",
            "write scripts/stop.py",
        ),
        (
            "src/drive.cpp",
            "src/drives.cpp",
            "cmake-file-missing",
            "write src/drive.cpp",
        ),
        (
            "dependencies(drive",
            "dependencies(driver",
            "cmake-file-missing",
            "write drive",
        ),
        (
            'executable="stop.py"',
            'executable="stop"',
            "launch-program-unknown",
            "write stop.py",
        ),
    ],
)
def test_the_edit_makes_launch_find_the_program(
    package: Path, right: str, wrong: str, code: str, hint: str
) -> None:
    name = "CMakeLists.txt" if right in CMAKE else "launch/r.launch.py"
    text = FILES[name].replace(right, wrong, 1)
    (package / name).write_text(text, "utf-8")

    assert found(package) == {code: hint}
    for problem in check(package / "r.urdf"):
        for name, edits in by_file(problem.edits).items():
            better = apply_edits(edits, Path(name).read_text("utf-8"))
            Path(name).write_text(better, "utf-8")
    assert found(package) == {}


@pytest.mark.parametrize("line", ["include(programs.cmake)", "add_subdirectory(src)"])
def test_what_others_may_install_is_not_reported(package: Path, line: str) -> None:
    text = CMAKE.replace(STOP, f"{line}\n")
    (package / "CMakeLists.txt").write_text(text, "utf-8")

    assert "launch-program-unknown" not in found(package)


def found(package: Path) -> Mapping[str, str]:
    return {p.code: p.hint for p in check(package / "r.urdf")}

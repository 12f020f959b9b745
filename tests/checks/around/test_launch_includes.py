"""Included launch files: where they are, and which arguments they declare."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from manifests import written

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

LAUNCH = "launch/display.launch.py"
OTHER = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument


def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument("use_sim_time")])
"""
INCLUDE = """\
    other = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(os.path.join(share, "launch", "other.launch.py")),
        launch_arguments={"use_sim_time": "true"}.items(),
    )
    return"""
XML = """\
<launch>
  <node pkg="joint_state_publisher" exec="joint_state_publisher"/>
</launch>
"""

Copied = Callable[[str], Path]


@pytest.fixture
def package(copied: Copied) -> Path:
    """The package "gz" with a file of its own that it includes, and one in XML."""
    folder = copied("gz")
    launch = folder / LAUNCH
    text = launch.read_text().replace("    return", INCLUDE, 1)
    launch.write_text(text.replace(" spawn,", " spawn,\n            other,"))
    (folder / "launch" / "other.launch.py").write_text(OTHER)
    (folder / "launch" / "joints.launch.xml").write_text(XML)
    return folder


def test_what_is_right_is_left_alone(package: Path) -> None:
    assert [p for p in check(package) if p.severity != "info"] == []


def test_an_include_passes_on_what_the_files_below_it_declare(package: Path) -> None:
    launch = package / LAUNCH
    own = 'os.path.join(share, "launch", "other.launch.py")'
    slam = "[FindPackageShare('nav2_bringup'), '/launch/slam_launch.py']"
    text = launch.read_text().replace(own, slam)
    launch.write_text(text.replace('{"use_sim_time": "', '{"slam_params_file": "'))
    codes = {p.code for p in check(package)}
    assert "launch-argument-unknown" not in codes
    launch.write_text(launch.read_text().replace("slam_params_f", "the_params_f"))
    assert "launch-argument-unknown" in {p.code for p in check(package)}


def test_pairs_of_launch_arguments_are_no_path(package: Path) -> None:
    launch = package / LAUNCH
    given = '{"use_sim_time": "true"}.items()'
    pairs = """[
            ("world", ["-r -v 4 ", os.path.join(share, "config/ekf.yaml")]),
            ("use_sim_time", "true"),
        ]"""
    launch.write_text(launch.read_text().replace(given, pairs))
    assert "launch-file-missing" not in {p.code for p in check(package)}


@pytest.mark.parametrize(
    ("right", "wrong", "cause"),
    [
        (
            '{"use_sim_time": "',
            '{"use_simtime": "',
            "other.launch.py declares no argument",
        ),
        ('"entity_name":', '"name":', "declares no argument name, but entity_name"),
        ('"world":', '"world_name":', "declares no argument world_name, but world"),
        ('"ros_gz_sim")', '"ros_gz_simm")', "there is no package ros_gz_simm"),
        ("gz_spawn_model.launch", "gz_spawn_modl.launch", "but launch/gz_spawn_model"),
        ('"config", "bridge_config', '"bridge_config', "it has config/bridge_config"),
        ('"cart.rviz"', '"carts.rviz"', "it has rviz/cart.rviz"),
    ],
)
def test_what_an_include_names_otherwise(
    package: Path, right: str, wrong: str, cause: str
) -> None:
    launch = package / LAUNCH
    good = launch.read_text()
    assert right in good
    launch.write_text(good.replace(right, wrong, 1))

    (problem,) = (p for p in check(package) if p.severity != "info")

    assert cause in problem.message
    fixed = apply_edits(problem.edits, launch.read_text())
    assert fixed in (good, good.replace('"config", "bridge', '"config/bridge'))


def test_a_program_in_xml_that_its_package_does_not_have(package: Path) -> None:
    launch = package / "launch" / "joints.launch.xml"
    launch.write_text(XML.replace('exec="joint', 'exec="joints'))
    (problem,) = (p for p in check(package) if p.severity != "info")
    assert "has no program joints_state_publisher" in problem.message
    assert apply_edits(problem.edits, launch.read_text()) == XML


@pytest.mark.parametrize("name", ["camera_name", "neo_nav2_bringup"])
def test_arguments_and_packages_of_others(package: Path, name: str) -> None:
    launch = package / LAUNCH
    text = launch.read_text().replace('"world":', f'"{name}": "x", "world":')
    more = f'    get_package_share_directory("{name}")\n    return'
    launch.write_text(text.replace("    return", more, 1))
    assert [p for p in check(package) if p.severity != "info"] == []


SLAM = """
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    slam = os.path.join(
        get_package_share_directory("slam_toolbox"), "launch", "online_async_launch.py")
    return LaunchDescription([
        Node(package="{}", executable="create"),
        IncludeLaunchDescription(
            slam, launch_arguments={{"params_file": "slam.yaml"}}.items()),
    ])
"""


@pytest.mark.parametrize(
    ("beside", "found"), [("ros_gz_sim", ["write slam_params_file"]), ("other", [])]
)
def test_an_argument_of_foxy_was_right_without_the_new_gazebo(
    tmp_path: Path, beside: str, found: list[str]
) -> None:
    manifest = "<package><name>r</name></package>"
    files = {"package.xml": manifest, "launch/slam.launch.py": SLAM.format(beside)}
    problems = check(written(tmp_path, files))
    hints = [p.hint for p in problems if p.code == "launch-argument-unknown"]
    assert hints == found

"""A fixed frame that a node of the package may publish is not said to be missing."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.checks.checked import frame_is_published
from sambot_viz.robot.model import load_robot

RVIZ = "rviz/cart.rviz"
DISPLAY = """
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[{"robot_description": Command(["xacro ", "a.urdf.xacro"])}]),
        Node(package="rviz2", executable="rviz2"),
        # more
    ])
"""
STATIC = """Node(package="tf2_ros", executable="static_transform_publisher",
    arguments=["--frame-id", "dock", "--child-frame-id", "base_link"]),"""
DRIVER = 'Node(package="cart_driver", executable="driver"),'
PREFIX = 'Node(package="rviz2", executable="b", parameters=[{"frame_prefix": "one/"}]),'
SLAM = 'Node(package="slam_toolbox", executable="async_slam_toolbox_node"),'

Said = Callable[[str], bool]


@pytest.fixture
def bare(copied: Callable[[str], Path]) -> Path:
    """The package "gz" with a launch file of two nodes, and no parameters."""
    package = copied("gz")
    for file in (*package.glob("config/*"), *package.glob("launch/*")):
        file.unlink()
    (package / "launch/display.launch.py").write_text(DISPLAY)
    model = package / "urdf/cart.urdf.xacro"
    model.write_text(model.read_text().split("<gazebo")[0] + "</robot>\n")
    return package


def said(package: Path, frame: str) -> bool:
    config = package / RVIZ
    lines = config.read_text().splitlines()
    at = next(n for n, line in enumerate(lines) if "Fixed Frame:" in line)
    lines[at] = f"{lines[at].partition(':')[0]}: {frame}"
    config.write_text("\n".join(lines))
    problems = check(package)
    return any(problem.code == "setup-fixed-frame" for problem in problems)


@pytest.mark.parametrize("kind", ["gz", "classic"])
@pytest.mark.parametrize(
    ("frame", "missing"),
    [("odom", False), ("map", False), ("/map", False), ("base_lnk", True)],
)
def test_odometry_and_maps_are_published(
    copied: Callable[[str], Path], kind: str, frame: str, missing: bool
) -> None:
    assert said(copied(kind), frame) == missing


@pytest.mark.parametrize("frame", ["map", "odom", "world", "dock"])
def test_without_a_node_that_publishes_it_a_frame_is_missing(
    bare: Path, frame: str
) -> None:
    assert said(bare, frame)


@pytest.mark.parametrize(
    ("node", "frame", "missing"),
    [
        (STATIC, "dock", False),
        (STATIC, "deck", True),
        (DRIVER, "dock", False),
        (DRIVER, "base_lin", True),
        (PREFIX, "one/base_link", False),
        (PREFIX, "one/base", True),
        (SLAM, "map", False),
        (SLAM, "dock", True),
    ],
)
def test_a_node_that_is_started_may_publish_a_frame(
    bare: Path, node: str, frame: str, missing: bool
) -> None:
    launch = bare / "launch/display.launch.py"
    launch.write_text(launch.read_text().replace("# more", node))
    assert said(bare, frame) == missing


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("src/driver.cpp", 'msg.header.frame_id = "dock";\n'),
        ("scripts/dock.py", "FRAME = 'dock'\n"),
        ("config/driver.yaml", "driver:\n  ros__parameters:\n    dock_frame: dock\n"),
        ("config/cart.srdf", '<virtual_joint name="v" parent_frame="dock"/>'),
        ("launch/driver.launch.xml", '<launch><node pkg="cart_driver"/></launch>'),
    ],
)
def test_files_of_the_package_may_name_a_frame(
    bare: Path, name: str, text: str
) -> None:
    (bare / name).parent.mkdir(exist_ok=True)
    (bare / name).write_text(text)
    assert not said(bare, "dock")


def test_moveit_draws_the_robot_without_a_robot_model(bare: Path) -> None:
    config = bare / RVIZ
    text = config.read_text()
    other = text.replace("rviz_default_plugins/RobotModel", "other_plugin/Robot")
    config.write_text(other)
    assert [p.code for p in check(bare)] == ["setup-no-robot-model"]
    config.write_text(other.replace("other_plugin/Robot", "moveit_rviz_plugin/Motion"))
    assert check(bare) == []


def test_the_package_of_the_config_counts_too(bare: Path, tmp_path: Path) -> None:
    bringup = tmp_path / "cart_bringup"
    (bringup / "config").mkdir(parents=True)
    (bringup / "package.xml").write_text("<package><name>cart_bringup</name></package>")
    config = bringup / "cart.rviz"
    config.write_text((bare / RVIZ).read_text().replace("base_link", "map"))
    robot = load_robot(bare / "urdf/cart.urdf.xacro")
    assert not frame_is_published(robot, "map", str(config))
    ekf = "ekf_filter_node:\n  ros__parameters:\n    odom0: odom\n"
    (bringup / "config/ekf.yaml").write_text(ekf)
    assert frame_is_published(robot, "map", str(config))

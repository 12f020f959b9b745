"""Topics of RViz displays are compared with what launch files start."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

MODEL, CONFIG = "urdf/cart.urdf.xacro", "rviz/cart.rviz"
LAUNCH = "launch/display.launch.py"

Copied = Callable[[str], Path]

DISPLAYS = """\
    - Class: rviz_default_plugins/LaserScan
      Enabled: true
      Name: LaserScan
      Topic: {Value: /scan, Reliability Policy: Best Effort}
    - Class: rviz_default_plugins/Odometry
      Enabled: true
      Name: Odometry
      Topic:
        Durability Policy: Volatile
        Value: /odometry/filtered
    - Class: rviz_default_plugins/Map
      Enabled: true
      Name: Map
      Topic:
        Durability Policy: Transient Local
        Value: /map
  Tools:
    - Class: rviz_default_plugins/SetGoal
      Topic: {Value: /goal_pose}
"""
MAP_SERVER = """\
            Node(package="nav2_map_server", executable="map_server"),
            rviz,
"""


@pytest.fixture
def package(copied: Copied) -> Path:
    """A package whose config has displays of what is published."""
    folder = copied("gz")
    config, launch = folder / CONFIG, folder / LAUNCH
    text = config.read_text()
    config.write_text(text.replace("  Global", f"{DISPLAYS}  Global"))
    launch.write_text(launch.read_text().replace(f"{' ' * 12}rviz,\n", MAP_SERVER))
    assert check(folder) == []
    return folder


def _change(package: Path, right: str, wrong: str) -> str:
    config = package / CONFIG
    text = config.read_text()
    assert right in text
    config.write_text(text.replace(right, wrong, 1))
    return text


@pytest.mark.parametrize(
    ("right", "wrong", "cause"),
    [
        ("Value: /scan", "Value: /lidar", "the bridge publishes this LaserScan as"),
        ("Value: /map", "Value: /mapp", "map_server publishes this OccupancyGrid as"),
        (
            "Class: rviz_default_plugins/LaserScan",
            "Class: rviz_default_plugins/PointCloud2",
            "takes PointCloud2, but the bridge publishes /scan as LaserScan",
        ),
        ("Transient Local", "Volatile", "publishes it only once: RViz misses it"),
        ("/goal_pose", "/move_base_simple/goal", "is the topic of ROS 1"),
        ("/goal_pose", "/goal_poses", "is read by no node"),
    ],
)
def test_what_a_display_does_not_get(
    package: Path, right: str, wrong: str, cause: str
) -> None:
    text = _change(package, right, wrong)

    (problem,) = check(package)

    assert cause in problem.message
    assert problem.file == str(package / CONFIG)
    config = package / CONFIG
    assert apply_edits(problem.edits, config.read_text()) == text


def test_of_two_topics_of_a_type_none_is_preferred(package: Path) -> None:
    _change(package, "Value: /odometry/filtered", "Value: /demo/imu")
    (problem,) = check(package)
    assert problem.code == "topic-type"
    assert problem.hint == "write /demo/odom or /odometry/filtered"


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("Enabled: true\n      Name: LaserScan", "Enabled: false\n      Name: x"),
        ("Value: /map", "Value: /global_costmap/costmap"),
        ("Value: /goal_pose", "Value: /way_point"),
    ],
)
def test_topics_of_nodes_that_start_later(
    package: Path, right: str, wrong: str
) -> None:
    _change(package, right, wrong)
    assert check(package) == []


def test_another_node_may_publish_what_a_display_reads(package: Path) -> None:
    launch = package / LAUNCH
    text = launch.read_text()
    node = 'Node(package="lidar_driver", executable="driver"),'
    launch.write_text(text.replace(" rviz,", f" rviz,\n{' ' * 12}{node}"))
    _change(package, "Value: /scan", "Value: /lidar")
    assert [p.severity for p in check(package)] == ["info"]


def test_two_displays_of_one_topic_have_one_type(package: Path) -> None:
    display = (
        "    - Class: rviz_default_plugins/{0}\n      Enabled: true\n      Name: {0}\n"
        "      Topic: {{Value: {1}}}\n"
    )
    config, text = package / CONFIG, (package / CONFIG).read_text()
    for clouds, said in (("/eye/image_raw", 1), ("/eye/points", 0)):
        shown = display.format("Image", "/eye/image_raw")
        shown += display.format("PointCloud2", clouds)
        config.write_text(text.replace("    - Class", f"{shown}    - Class", 1))
        found = [p for p in check(package) if p.code == "topic-type"]
        assert len(found) == said
        assert all("PointCloud2 shows nothing" in p.message for p in found)

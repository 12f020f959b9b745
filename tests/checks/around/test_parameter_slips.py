"""Slips in parameter files and maps are found at their lines, whatever the node."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files
from manifests import manifest, written

from sambot_viz.checks import check
from sambot_viz.errors import Problem

EKF = "config/ekf.yaml"
PARAMETERS, MAP, SLAM = "config/params.yaml", "maps/map.yaml", "config/slam.yaml"
FILES = {
    "package.xml": manifest(),
    PARAMETERS: """\
tracker:
  ros__parameters:
    debug: true
    kind: tree
    radius: 0.1
controller_server:
  ros__parameters:
    FollowPath:
      plugin: dwb_core::DWBLocalPlanner
      critics: [PathAlign, GoalAlign]
      PathAlign.scale: 32.0
      PathAlign.forward_point_distance: 0.1
twist_mux:
  ros__parameters:
    topics:
      joystick:
        topic: cmd_vel_joy
        timeout: 0.5
        priority: 10
""",
    EKF: """\
ekf_filter_node:
  ros__parameters:
    odom0: odom
    map_frame: map
    odom_frame: odom
    world_frame: odom
""",
    SLAM: """\
slam_toolbox:
  ros__parameters:
    odom_frame: odom
    map_frame: map
""",
    MAP: """\
image: map.pgm
mode: trinary
resolution: 0.05
origin: [0.0, 0.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.25
""",
    "maps/map.pgm": "P5 1 1 255 0",
}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A right package with parameters and a map."""
    return written(tmp_path / "robot", FILES)


def problems(package: Path) -> list[Problem]:
    """Return what is found, without the note that there is no model."""
    return [p for p in check(package) if p.code != "package-without-model"]


def found(package: Path, file: str, right: str, wrong: str) -> Problem:
    """Return the one problem after a change of one file."""
    assert problems(package) == []
    path = package / file
    assert right in FILES[file]
    path.write_text(FILES[file].replace(right, wrong, 1))
    (problem,) = problems(package)
    assert problem.file == str(path)
    return problem


@pytest.mark.parametrize(
    ("file", "right", "wrong", "cause"),
    [
        (PARAMETERS, "debug: true", "debug: ture", "debug is the text ture"),
        (PARAMETERS, "radius: 0.1", "radius: 0,1", "radius is the text 0,1"),
        (PARAMETERS, "PathAlign.for", "PaathAlign.for", "FollowPath lists PathAlign"),
        (
            PARAMETERS,
            "ros__parameters:\n    debug",
            "ros_parameters:\n    debug",
            "no ros",
        ),
        (PARAMETERS, "topics:", "topiics:", "twist_mux has no topiics, but topics"),
        (PARAMETERS, "timeout:", "time_out:", "has no parameter time_out"),
        (EKF, "odom_frame: odom", "odom_frame: map", "map_frame and odom_frame are"),
        (PARAMETERS, "twist_mux:", "twist_mx:", "but probably twist_mux is meant"),
        (
            PARAMETERS,
            "tracker:\n  ros__parameters:\n    debug: true\n    kind: tree\n    r",
            "tracker:\nros__parameters:\n  debug: true\n  kind: tree\n  r",
            "ros__parameters is beside tracker (line 1), not below it",
        ),
        (
            PARAMETERS,
            "  ros__parameters:\n    debug: true\n    kind: tree\n    radius",
            "  ros__parameters:\n  debug: true\n  kind: tree\n  radius",
            "debug is beside ros__parameters (line 2), not below it",
        ),
        (MAP, "trinary", "triary", "a map has no mode triary"),
        (MAP, "image: map", "image: maps", "has the image maps.pgm, which is not"),
        (MAP, "negate:", "neagte:", "this map has no negate"),
        (
            MAP,
            "0.65\nfree_thresh: 0.25",
            "0.25\nfree_thresh: 0.65",
            "free_thresh is 0.65, and occupied_thresh (line 6) is less",
        ),
    ],
)
def test_a_slip_is_undone_by_its_edit(
    package: Path, file: str, right: str, wrong: str, cause: str
) -> None:
    problem = found(package, file, right, wrong)
    assert cause in problem.message
    path = package / file
    assert edited_files(problem.edits)[str(path)].decode() == FILES[file]


@pytest.mark.parametrize(
    ("file", "right", "wrong", "line", "cause"),
    [
        (PARAMETERS, "tracker:\n  ", "", 1, "ros__parameters is at the top"),
        (
            PARAMETERS,
            "twist_mux:\n",
            "",
            13,
            "ros__parameters is below controller_server",
        ),
        (PARAMETERS, "        priority: 10\n", "", 17, "joystick has no priority"),
        (MAP, "resolution: 0.05\n", "", 1, "this map has no resolution"),
        (SLAM, "map_frame: map", "map_frame: odom", 4, "from odom to itself"),
    ],
)
def test_what_is_missing_has_the_line_where_it_is_needed(
    package: Path, file: str, right: str, wrong: str, line: int, cause: str
) -> None:
    problem = found(package, file, right, wrong)
    assert cause in problem.message
    assert abs((problem.line or 0) - line) <= 1


@pytest.mark.parametrize("given", ["left_wheel_names: [l]", "right_wheel_names: [r]"])
def test_a_controller_needs_the_wheels_of_both_sides(package: Path, given: str) -> None:
    (package / "config/wheels.yaml").write_text(
        "controller_manager:\n  ros__parameters:\n    wheels:\n"
        "      type: diff_drive_controller/DiffDriveController\n"
        f"wheels:\n  ros__parameters:\n    {given}\n"
    )
    (problem,) = problems(package)
    assert (problem.severity, problem.line) == ("warning", 7)
    assert "_wheel_names, which its class needs" in problem.message


def test_the_image_of_a_map_is_no_map(package: Path) -> None:
    text = """\
from launch import LaunchDescription
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare
from launch.substitutions import PathJoinSubstitution


def generate_launch_description():
    map_file = PathJoinSubstitution([FindPackageShare('robot'), 'maps', 'map.pgm'])
    return LaunchDescription([
        Node(
            package='nav2_map_server',
            executable='map_server',
            parameters=[{'yaml_filename': map_file}],
        ),
    ])
"""
    path = package / "launch/map.launch.py"
    path.parent.mkdir()
    path.write_text(text)
    (problem,) = [p for p in problems(package) if p.severity != "info"]
    assert problem.code == "parameter-value"
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert path.read_text() == text.replace("map.pgm", "map.yaml")
    assert [p for p in problems(package) if p.severity != "info"] == []

"""A lifecycle manager lists the nodes that start."""

from __future__ import annotations

from pathlib import Path

import pytest
from manifests import written

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

MODEL = '<robot name="r"><link name="base_link"/></robot>'
MANIFEST = "<package><name>r</name></package>"
LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    names = {names}
    return LaunchDescription([
        Node(package="nav2_map_server", executable="map_server", name="{map}"),
        Node(package="nav2_amcl", executable="amcl", name="amcl"),
        Node(
            package="nav2_lifecycle_manager",
            executable="lifecycle_manager",
            name="manager",
            parameters=[{given}],
        ),
        {more}
    ])
"""
IN_LAUNCH = '{"autostart": True, "node_names": names}'
IN_FILE = "'config/manager.yaml'"
YAML = """\
manager:
  ros__parameters:
    autostart: true
    node_names: [{}]
"""


def package(
    folder: Path, names: str, map_server: str = "map_server", more: str = ""
) -> Path:
    launch = LAUNCH.format(names=names, map=map_server, given=IN_LAUNCH, more=more)
    files = {"package.xml": MANIFEST, "r.urdf": MODEL, "launch/m.launch.py": launch}
    return written(folder, files)


def found(folder: Path) -> list[tuple[int | None, str]]:
    problems = check(folder / "r.urdf")
    return [(p.line, p.hint) for p in problems if p.code == "lifecycle-node"]


@pytest.mark.parametrize(
    ("names", "map_server", "expected"),
    [
        ("['map_server', 'amcl']", "map_server", []),
        ("['map_sever', 'amcl']", "map_server", [(5, "write map_server")]),
        ("['map_server', 'amcl']", "maps", [(5, "write maps")]),
        ("['lidar', 'map_server', 'amcl']", "map_server", []),
    ],
)
def test_the_list_has_the_names_of_the_nodes(
    tmp_path: Path, names: str, map_server: str, expected: list[tuple[int, str]]
) -> None:
    folder = package(tmp_path, names, map_server)
    assert found(folder) == expected


def test_the_edit_writes_the_name(tmp_path: Path) -> None:
    folder = package(tmp_path, "['map_server', 'amlc']")
    file = folder / "launch/m.launch.py"
    (problem,) = (p for p in check(folder / "r.urdf") if p.code == "lifecycle-node")
    text = apply_edits(problem.edits, file.read_text("utf-8"))
    assert "['map_server', 'amcl']" in text


def test_another_launch_file_may_start_the_node(tmp_path: Path) -> None:
    more = "IncludeLaunchDescription(unknown()),"
    folder = package(tmp_path, "['map_server', 'amcl']", "maps", more)
    assert found(folder) == []


def test_a_list_in_a_file(tmp_path: Path) -> None:
    folder = package(tmp_path, "[]")
    launch = folder / "launch/m.launch.py"
    text = launch.read_text("utf-8").replace(IN_LAUNCH, IN_FILE)
    launch.write_text(text, "utf-8")
    written(folder, {"config/manager.yaml": YAML.format("map_servr, amcl")})
    assert found(folder) == [(4, "write map_server")]

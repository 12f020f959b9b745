"""A world in which nothing stands, or that does not load, is found with its edit."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files
from manifests import written

from sambot_viz.checks import check

WORLD = "worlds/room.sdf"
SYSTEM = 'filename="gz-sim-imu-system" name="gz::sim::systems::Imu"'
FILES = {
    "package.xml": """\
<package format="3">
  <name>room</name>
  <version>0.0.1</version>
  <description>A room.</description>
  <maintainer email="me@example.org">me</maintainer>
  <license>MIT</license>
</package>
""",
    "launch/sim.launch.py": """\
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import ExecuteProcess


def generate_launch_description():
    world = os.path.join(get_package_share_directory("room"), "worlds", "room.sdf")
    return LaunchDescription([ExecuteProcess(cmd=["gz", "sim", world])])
""",
    WORLD: f"""\
<sdf version="1.8">
  <world name="room">
    <plugin {SYSTEM}/>
    <gravity>0 0 -9.8</gravity>
    <physics type="ode">
      <max_step_size>0.001</max_step_size>
      <real_time_update_rate>1000</real_time_update_rate>
    </physics>
    <light type="point" name="lamp"><pose>0 0 2.5 0 0 0</pose></light>
    <light type="directional" name="sun"><direction>0.1 0 -1</direction></light>
    <model name="ground">
      <static>true</static>
      <link name="l">
        <collision name="c"><geometry><plane/></geometry></collision>
      </link>
    </model>
    <include><uri>https://fuel.gazebosim.org/1.0/OpenRobotics/models/Sun</uri></include>
  </world>
</sdf>
""",
}


@pytest.fixture
def world(tmp_path: Path) -> Path:
    """The world of a right package."""
    return written(tmp_path / "room", FILES) / WORLD


def problems(world: Path) -> list[tuple[str, str, int | None]]:
    found = check(world.parents[1])
    return [
        (p.code, p.severity, p.line) for p in found if p.code != "package-without-model"
    ]


@pytest.mark.parametrize(
    ("right", "wrong", "code", "severity"),
    [
        (SYSTEM, SYSTEM.replace("filename", "x").replace("name", "filename"), "", ""),
        ("-9.8<", "9.8<", "world-value", "warning"),
        ("-9.8<", "1.6<", "world-value", "info"),
        ("0.001<", "1<", "world-value", "warning"),
        ("0.001<", "0,001<", "world-value", "warning"),
        ("0 0 2.5 0 0 0", "0 0 2,5 0 0 0", "world-value", "warning"),
        ("      <static>true</static>\n", "", "world-value", "warning"),
        ("<static>true", "<static>false", "world-value", "warning"),
        ("<static>true", "<static>treu", "world-value", "warning"),
        ("0.1 0 -1<", "0.1 0 1<", "world-value", "warning"),
        (
            "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Sun",
            "model://sun",
            "world-model",
            "warning",
        ),
    ],
)
def test_a_mistake_in_a_world_is_undone_by_its_edit(
    world: Path, right: str, wrong: str, code: str, severity: str
) -> None:
    text = FILES[WORLD]
    if not code:
        # The values of the two attributes are exchanged.
        wrong = wrong.replace("x=", "name=")
        code, severity = "gazebo-plugin", "warning"
    assert problems(world) == []
    world.write_text(text.replace(right, wrong))
    place = text[: text.index(right)].count("\n") + 1
    if "static" in right and not wrong:
        place -= 1
    assert problems(world) == [(code, severity, place)]
    (problem,) = (p for p in check(world.parents[1]) if p.code == code)
    world.write_bytes(edited_files(problem.edits)[str(world)])
    assert problems(world) == []
    assert "1.6" in wrong or world.read_text() == text or "filename" in wrong


@pytest.mark.parametrize(
    ("right", "other"),
    [
        # The Moon, a plane that something holds, and a model of the package.
        ("-9.8<", "-1.62<"),
        ("      <static>true</static>\n", "<joint name='j' type='fixed'/>"),
        ('<light type="point"', '<light type="spot"'),
        # A turned sun, and a second one that lights what is below.
        ("<direction>0.1 0 -1", "<pose>0 0 9 3.14 0 0</pose><direction>0 0 1"),
        (
            "<model name=",
            '<light type="directional" name="b"><direction>0 0 1</direction></light>'
            "<model name=",
        ),
    ],
)
def test_other_worlds_are_right_too(world: Path, right: str, other: str) -> None:
    world.write_text(FILES[WORLD].replace(right, other))
    assert problems(world) == []


def test_a_model_that_the_package_has_is_found(world: Path) -> None:
    uri = "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Sun"
    world.write_text(FILES[WORLD].replace(uri, "model://sun"))
    config = world.parents[1] / "models/sun/model.config"
    config.parent.mkdir(parents=True)
    config.write_text("<model/>")
    assert problems(world) == []


SPAWN = """
from launch_ros.actions import Node


def generate_launch_description():
    world = os.path.join(get_package_share_directory("room"), "worlds", "room.sdf")
    spawn = Node(package="ros_gz_sim", executable="create",
                 arguments=["-x", "{}", "-y", "0", "-z", "0.6"])
    return LaunchDescription([ExecuteProcess(cmd=["gz", "sim", world]), spawn])
"""


@pytest.mark.parametrize(
    ("shape", "inside", "beside"),
    [
        ("<box><size>1 1 1</size></box>", "2.4", "2.6"),
        ("<cylinder><radius>0.5</radius><length>1</length></cylinder>", "1.6", "1.4"),
        ("<sphere><radius>0.5</radius></sphere>", "2", "2.6"),
        ("<plane><normal>0 0 1</normal></plane>", "", "2"),
    ],
)
def test_a_robot_is_spawned_beside_what_stands_there(
    world: Path, shape: str, inside: str, beside: str
) -> None:
    model = (
        '<model name="crate"><static>true</static>\n<pose>2 0 0.5 0 0 0</pose>'
        f'<link name="l"><collision name="c"><geometry>{shape}</geometry></collision>'
        "</link></model>\n  </world>"
    )
    world.write_text(FILES[WORLD].replace("</world>", model), "utf-8")
    head = FILES["launch/sim.launch.py"].split("\n\n\ndef")[0]
    launch = world.parents[1] / "launch/sim.launch.py"
    for x, said in ((inside, ["world-value"]), (beside, [])):
        if x:
            launch.write_text(head + SPAWN.format(x), "utf-8")
            found = [p for p in check(world.parents[1]) if p.code == "world-value"]
            assert [p.code for p in found] == said
            assert all("crate" in p.message for p in found)

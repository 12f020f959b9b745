"""The two ends of a topic meet: at controllers, relays, bridges and filters."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits
from sambot_viz.errors import Problem

Copied = Callable[[str], Path]
MODEL, LAUNCH = "urdf/cart.urdf.xacro", "launch/display.launch.py"
EKF, AT = "config/ekf.yaml", "            bridge,\n"
RELAY = (
    'Node(package="topic_tools", executable="relay", name="again",\n'
    '                arguments=["{}", "{}"]),\n'
)
IMAGES = 'Node(package="ros_gz_image", executable="image_bridge", arguments=["{}"]),\n'


def changed(package: Path, file: str, right: str, wrong: str) -> list[Problem]:
    text = (package / file).read_text("utf-8")
    assert right in text
    (package / file).write_text(text.replace(right, wrong, 1), "utf-8")
    return check(package / MODEL)


def mended(package: Path, problem: Problem) -> list[Problem]:
    file = Path(problem.file or "")
    file.write_text(apply_edits(problem.edits, file.read_text("utf-8")), "utf-8")
    return check(package / MODEL)


def test_a_filter_that_reads_its_own_topic(copied: Copied) -> None:
    package = copied("gz")
    (problem,) = changed(package, EKF, "demo/odom", "odometry/filtered")

    assert "publishes its own Odometry there" in problem.message
    assert problem.hint == "write /demo/odom"
    assert mended(package, problem) == []


def test_a_renamed_topic_may_be_its_own(copied: Copied) -> None:
    package = copied("gz")
    name = 'name="ekf_filter_node",\n'
    more = 'remappings=[("odometry/filtered", "demo/odom")],\n'
    found = changed(package, LAUNCH, name, f"{name}        {more}")

    assert any("for odometry/filtered" in problem.message for problem in found)


def test_a_relay_from_the_bridge_is_right(copied: Copied) -> None:
    relay = RELAY.format("scan", "front/scan")
    assert changed(copied("gz"), LAUNCH, AT, f"{AT}            {relay}") == []


def test_a_relay_with_exchanged_topics(copied: Copied) -> None:
    package = copied("gz")
    relay = RELAY.format("front/scan", "scan")
    (problem,) = changed(package, LAUNCH, AT, f"{AT}            {relay}")

    assert "the two are exchanged" in problem.message
    assert mended(package, problem) == []
    assert RELAY.format("scan", "front/scan") in (package / LAUNCH).read_text("utf-8")


CAMERA = """\
  <gazebo reference="base_link">
    <sensor name="eye" type="camera"><topic>eye/image</topic></sensor>
  </gazebo>
</robot>"""


@pytest.mark.parametrize(
    ("topic", "hints"),
    [
        ("/eye/image", []),
        ("eye/image", []),
        ("/eye/image_raw", ["write /eye/image"]),
        ("eye", ["write eye/image"]),
    ],
)
def test_a_bridge_for_images_carries_the_topic_of_the_camera(
    copied: Copied, topic: str, hints: list[str]
) -> None:
    package = copied("gz")
    bridge = IMAGES.format(topic)
    changed(package, MODEL, "</robot>", CAMERA)
    found = changed(package, LAUNCH, AT, f"{AT}            {bridge}")

    codes = ("bridge-topic",)
    assert [p.hint for p in found if p.code in codes] == hints


CONTROL = """\
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(package="controller_manager", executable="spawner",
             arguments=["wheels"]),
        Node(package="twist_mux", executable="twist_mux",
             remappings=[("cmd_vel_out", "TOPIC")]),
    ])
"""
WHEELS = """\
controller_manager:
  ros__parameters:
    wheels:
      type: diff_drive_controller/DiffDriveController
wheels:
  ros__parameters:
    use_stamped_vel: false
    left_wheel_names: [left]
    right_wheel_names: [right]
"""


@pytest.mark.parametrize(
    ("topic", "hints"),
    [
        ("/wheels/cmd_vel_unstamped", []),
        ("/cmd_vel", []),
        ("/wheels/cmd_vel", ["write /wheels/cmd_vel_unstamped"]),
        ("/weels/cmd_vel_unstamped", ["write /wheels/cmd_vel_unstamped"]),
        ("/wheels/cmd", ["write /wheels/cmd_vel_unstamped"]),
    ],
)
def test_commands_reach_the_controller(
    tmp_path: Path, topic: str, hints: list[str]
) -> None:
    for name, text in (
        ("package.xml", "<package><name>r</name></package>"),
        ("r.urdf", '<robot name="r"><link name="base_link"/></robot>'),
        ("launch/r.launch.py", CONTROL.replace("TOPIC", topic)),
        ("config/wheels.yaml", WHEELS),
    ):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, "utf-8")

    assert [p.hint for p in check(tmp_path / "r.urdf")] == hints


def test_a_filter_in_the_map_beside_a_node_that_localizes(copied: Copied) -> None:
    package = copied("gz")
    amcl = 'Node(package="nav2_amcl", executable="amcl"),\n'
    changed(package, LAUNCH, AT, f"{AT}            {amcl}")
    found = changed(package, EKF, "world_frame: odom", "world_frame: map")
    (problem,) = [p for p in found if p.code == "odometry-unpublished"]

    assert "but amcl (display.launch.py line" in problem.message
    assert problem.hint == "write odom"

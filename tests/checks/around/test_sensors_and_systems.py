"""Sensors and plugins that Gazebo leaves out or reads otherwise than was meant."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.cli import main

Copied = Callable[[str], Path]

DRIVE = 'filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"'
LIDAR = '<sensor name="lidar" type="gpu_lidar">'
TURN = "<ray><scan><horizontal><max_angle>6.28</max_angle></horizontal></scan></ray>"
SCAN = LIDAR + "<ray><range><min>0.12</min><max>3.5</max></range></ray>"


@pytest.mark.parametrize(
    ("right", "wrong", "said", "hint"),
    [
        (
            DRIVE,
            'filename="libgazebo_ros_diff_drive.so" name="diff_drive"',
            "such as gz-sim-joint-state-publisher-system (line ",
            f"write {DRIVE}, and the elements that it reads",
        ),
        (
            DRIVE,
            'filename="gz-sim-diff-drive-system" name="diff_drive"',
            "has no class diff_drive",
            'write name="gz::sim::systems::DiffDrive"',
        ),
        (
            DRIVE,
            'filename="libignition-gazebo6-diff-drive-system.so" name="Drive"',
            "has no class Drive",
            'write name="ignition::gazebo::systems::DiffDrive"',
        ),
        (
            DRIVE,
            DRIVE.replace("gz::", "ignition::"),
            "has no class ignition::sim::systems::DiffDrive",
            f"write {DRIVE.partition(' ')[2]}",
        ),
        (
            "<wheel_separation>0.4<",
            "<publish_tf>ture</publish_tf><wheel_separation>0.4<",
            "<publish_tf>ture</publish_tf> of gz-sim-diff-drive-system is neither",
            "write true",
        ),
        (
            "<wheel_separation>0.4<",
            "<wheel_separation>0,4<",
            "0,4 is no number",
            "write 0.4",
        ),
        (
            "<wheel_separation>0.4<",
            "<wheel_separation>40 cm<",
            "40 cm is no number",
            "write a number alone",
        ),
        (
            '<gazebo reference="lidar_link">',
            "<gazebo>",
            "the sensor lidar (line ",
            'write <gazebo reference="lidar_link">',
        ),
        (
            '<gazebo reference="imu_link">',
            '<gazebo reference="imu_joint">',
            "imu_joint is a joint (line ",
            'write reference="imu_link", the link of that joint',
        ),
        (LIDAR, LIDAR.replace("gpu_", ""), "for Gazebo Classic", 'type="gpu_lidar"'),
        (
            LIDAR,
            LIDAR + TURN.replace("6.28", "360"),
            "360 is more than a full turn",
            "write 6.2832",
        ),
        (
            SCAN.replace("0.12", "a").replace("3.5", "0.12").replace("a<", "3.5<"),
            "",
            "<min> of the sensor lidar is 3.5 m",
            "exchange 3.5 and 0.12",
        ),
        (
            LIDAR,
            LIDAR + TURN.replace("6.28", "-1570.8"),
            "-1570.8 is more than a full turn",
            "write the angle in radians",
        ),
        (
            SCAN.replace("0.12", "12"),
            "",
            "<min> of the sensor lidar is 12 m",
            "write less than 3.5 for <min>",
        ),
        (
            "<gz_frame_id>lidar_link<",
            "<gz_frame_id>imu_link<",
            "its frame here is imu_link, which carries imu (line ",
            "write lidar_link",
        ),
    ],
)
def test_what_gazebo_leaves_out_or_misreads(
    copied: Copied, right: str, wrong: str, said: str, hint: str
) -> None:
    model = copied("gz") / "urdf" / "cart.urdf.xacro"
    text = model.read_text()
    if not wrong:
        right, wrong = LIDAR, right
    assert right in text
    model.write_text(text.replace(right, wrong))

    (problem,) = (p for p in check(model) if p.severity != "info")

    assert said in problem.message
    assert hint in problem.hint
    assert problem.line


def test_a_class_that_another_file_has_gets_that_file(copied: Copied) -> None:
    model = copied("gz") / "urdf" / "cart.urdf.xacro"
    text = model.read_text()
    wrong = DRIVE.replace("diff-drive", "joint-state-publisher")
    model.write_text(text.replace(DRIVE, wrong))
    assert main(["check", "--fix", "--yes", str(model)]) == 0
    assert model.read_text() == text


@pytest.mark.parametrize("text", [LIDAR + TURN, SCAN])
def test_values_that_are_possible_are_not_reported(copied: Copied, text: str) -> None:
    model = copied("gz") / "urdf" / "cart.urdf.xacro"
    model.write_text(model.read_text().replace(LIDAR, text))

    assert [p for p in check(model) if p.severity != "info"] == []


IMU = """\
<robot name="r"><link name="imu_link"/>
<gazebo reference="imu_link">
<sensor name="imu" type="imu"><gz_frame_id>imu_link</gz_frame_id>
<plugin name="imu" filename="libgazebo_ros_imu_sensor.so"/></sensor>
</gazebo>
<gazebo reference="imu_link"><material>Gazebo/Red</material></gazebo>
</robot>
"""


@pytest.mark.parametrize(
    ("right", "wrong", "code", "line"),
    [
        ("libgazebo_ros_imu_sensor.so", "libgazebo_ros_camera.so", "gazebo-sensor", 4),
        (
            'type="imu"><gz_frame_id>imu_link</gz_frame_id>',
            'type="camera"><imu/>',
            "gazebo-sensor",
            3,
        ),
        ('<plugin name="imu"', "<plugin", "gazebo-plugin", 4),
        ("id>imu_link<", "id>ium_link<", "frame-unknown", 3),
        ('imu" type="imu">', 'imu" tpye="imu">', "gazebo-sensor", 3),
        ("Gazebo/Red", "Gazebo/Rd", "sdf-value", 6),
        (
            "<material>Gazebo/Red</material>",
            '<sensor name="imu" type="imu"/>',
            "gazebo-sensor",
            6,
        ),
        (
            '"imu_link"><material',
            '"imulink"><material',
            "gazebo-reference",
            6,
        ),
    ],
)
def test_a_sensor_of_classic_and_its_plugin_belong_together(
    right: str, wrong: str, code: str, line: int, tmp_path: Path
) -> None:
    model = tmp_path / "robot.urdf"
    model.write_text(IMU)
    assert check(model) == []
    model.write_text(IMU.replace(right, wrong))

    (problem,) = check(model)

    assert (problem.code, problem.line) == (code, line)
    assert problem.edits or "twice" in problem.message


def test_a_sensor_of_ros2_control_needs_no_link(copied: Copied) -> None:
    model = copied("gz") / "urdf" / "cart.urdf.xacro"
    control = '<ros2_control name="c" type="sensor"><sensor name="f"/></ros2_control>'
    model.write_text(model.read_text().replace("</robot>", f"{control}\n</robot>"))

    assert [p for p in check(model) if p.severity != "info"] == []


def test_the_optical_frame_of_a_camera_is_a_link(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text("<package><name>r</name></package>")
    model = tmp_path / "robot.urdf"
    text = """<robot name="r"><link name="camera_link"/><link name="camera_optical"/>
<joint name="j" type="fixed"><parent link="camera_link"/><child link="camera_optical"/>
<origin rpy="-1.5708 0 -1.5708"/></joint>
<gazebo reference="camera_link"><sensor name="c" type="camera"><camera>
<optical_frame_id>camera_optcal</optical_frame_id></camera></sensor></gazebo></robot>
"""
    model.write_text(text)

    (problem,) = (p for p in check(model) if p.code == "frame-unknown")
    assert (problem.line, problem.hint) == (5, "write camera_optical")
    model.write_text(text.replace("optcal", "optical"))
    assert not any(p.code == "frame-unknown" for p in check(model))

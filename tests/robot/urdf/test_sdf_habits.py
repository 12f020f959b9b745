"""Elements of SDF in a URDF are named, and what they say can be written as URDF."""

from __future__ import annotations

import re

import numpy as np
import pytest

from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import load_robot

URDF = """<robot name="r">
  <link name="base">
    <visual>
      <origin xyz="0 0 0.1" rpy="0 0 0"/>
      <geometry><box size="1 1 1"/></geometry>
    </visual>
    <collision>
      <origin xyz="0 0 0.2" rpy="0 0 0"/>
      <geometry><box size="1 1 1"/></geometry>
    </collision>
  </link>
  <link name="arm"/>
  <joint name="j" type="fixed">
    <parent link="base"/>
    <child link="arm"/>
    <origin xyz="0 0 0.3" rpy="0 0 1"/>
  </joint>
</robot>
"""
ORIGIN = re.compile(r'<origin xyz="([^"]*)" rpy="([^"]*)"/>')


def found(text: str) -> tuple[Problem, ...]:
    try:
        return load_robot(text).problems
    except RobotError as error:
        return error.problems


@pytest.mark.parametrize("number", [0, 1, 2])
def test_a_pose_is_answered_with_the_origin_to_write(number: int) -> None:
    right = list(ORIGIN.finditer(URDF))[number]
    pose = f"<pose>{right[1]} {right[2]}</pose>"
    text = URDF.replace(right[0], pose)

    (problem,) = found(text)

    assert (problem.code, problem.severity) == ("urdf-sdf-habit", "warning")
    assert problem.line == text[: text.index(pose)].count("\n") + 1
    assert text.replace(pose, problem.hint.removeprefix("write ")) == URDF


@pytest.mark.parametrize("tag", ["position", "offset", "translation"])
def test_another_name_for_origin_is_answered_with_it(tag: str) -> None:
    problems = found(URDF.replace("<origin", f"<{tag}"))

    assert [problem.hint for problem in problems] == ["write <origin …/>"] * 3


def test_a_pose_in_a_link_goes_into_its_joint() -> None:
    text = URDF.replace(
        '<link name="arm"/>', '<link name="arm"><pose>1 2 3 0 0 0</pose></link>'
    )

    (problem,) = found(text)

    assert 'xyz="1 2 3"' in problem.hint
    assert problem.hint.endswith("into joint j")


@pytest.mark.parametrize(
    "element",
    [
        '<plugin name="p" filename="p.so"/>',
        "<static>true</static>",
        '<sensor name="lidar" type="gpu_lidar"/>',
    ],
)
def test_what_is_for_gazebo_is_sent_into_a_gazebo_element(element: str) -> None:
    (problem,) = found(
        URDF.replace('<link name="arm"/>', f'{element}<link name="arm"/>')
    )

    before, after = re.findall(r"</?gazebo>", problem.hint)
    assert not found(URDF.replace("</robot>", f"{before}{element}{after}</robot>"))


def test_a_sensor_in_a_link_is_sent_into_a_gazebo_element_of_the_link() -> None:
    sensor = '<sensor name="lidar" type="gpu_lidar"/>'
    (problem,) = found(URDF.replace("</link>", f"{sensor}</link>"))

    (before,) = re.findall(r"<gazebo.*?>", problem.hint)
    assert before == '<gazebo reference="base">'
    assert not found(URDF.replace("</robot>", f"{before}{sensor}</gazebo></robot>"))


@pytest.mark.parametrize(
    ("kind", "parent"),
    [
        ("", '<parent link="base"/>'),
        ('type="accelerometer"', '<parent link="base"/>'),
        ('type="force_torque"', '<parent joint="j"/>'),
    ],
)
def test_a_sensor_of_urdf_is_left_alone(kind: str, parent: str) -> None:
    """iDynTree reads such sensors, with and without a type."""
    sensor = f'<sensor name="s" {kind}>{parent}</sensor>'
    assert not found(URDF.replace("</robot>", f"{sensor}</robot>"))


def test_a_pose_is_not_taken_for_an_origin() -> None:
    text = URDF.replace(
        '<origin xyz="0 0 0.3" rpy="0 0 1"/>', "<pose>0 0 0.3 0 0 1</pose>"
    )
    origin = load_robot(text).joints["j"].origin
    assert np.array_equal(origin.matrix, np.eye(4))


def test_a_box_of_three_lengths_is_answered_with_its_size() -> None:
    text = '<link name="a"><visual><geometry><box {}/></geometry></visual></link>'
    lengths = text.format('length="0.4" width="0.3" height="0.2"')

    (problem,) = found(f'<robot name="r">{lengths}</robot>')

    assert problem.hint == 'write size="0.4 0.3 0.2"'


def test_a_missing_moment_of_inertia_is_a_possible_one() -> None:
    inertia = '<inertia ixx="0.01" iyy="0.5" ixy="0" ixz="0"/>'
    inertial = f'<inertial><mass value="1"/>{inertia}</inertial>'

    (problem,) = found(f'<robot name="r"><link name="a">{inertial}</link></robot>')

    assert problem.hint == 'add iyz="0" izz="0.5"'

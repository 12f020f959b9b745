"""A cylinder with its two lengths the other way round in one place is found."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.errors import Problem

MODEL = """\
<robot name="r">
  <link name="base_link"/>
  <joint name="j" type="fixed"><parent link="base_link"/><child link="wheel"/></joint>
  <link name="wheel">
    <visual>
      <geometry><cylinder radius="0.1" length="0.05"/></geometry>
    </visual>
    <collision>
      <geometry><cylinder radius="0.1" length="0.05"/></geometry>
    </collision>
    <inertial>
      <mass value="2"/>
      <inertia ixx="0.005416667" iyy="0.005416667" izz="0.01" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
</robot>
"""
RIGHT = '<cylinder radius="0.1" length="0.05"/>'
EXCHANGED = '<cylinder radius="0.05" length="0.1"/>'
INERTIA = 'ixx="0.005416667" iyy="0.005416667" izz="0.01"'


def found(tmp_path: Path, text: str) -> list[Problem]:
    model = tmp_path / "robot.urdf"
    model.write_text(text)
    return [p for p in check(model) if p.code == "cylinder-exchanged"]


def test_the_shape_that_does_not_fit_the_inertia_is_the_wrong_one(
    tmp_path: Path,
) -> None:
    assert found(tmp_path, MODEL) == []
    (problem,) = found(tmp_path, MODEL.replace(RIGHT, EXCHANGED, 1))
    assert problem.line == 6
    assert problem.hint == 'write radius="0.1" length="0.05", as the inertia has it'


def test_moments_of_the_exchanged_cylinder_are_found(tmp_path: Path) -> None:
    moments = 'ixx="0.002916667" iyy="0.002916667" izz="0.0025"'
    (problem,) = found(tmp_path, MODEL.replace(INERTIA, moments))
    assert problem.line == 11
    assert "radius 0.05 and the length 0.1" in problem.message


@pytest.mark.parametrize(
    "moments",
    [
        'ixx="0.01" iyy="0.01" izz="0.01"',
        'ixx="0.0054" iyy="0.0054" izz="0.0101"',
    ],
)
def test_other_moments_are_left_alone(tmp_path: Path, moments: str) -> None:
    assert found(tmp_path, MODEL.replace(INERTIA, moments)) == []

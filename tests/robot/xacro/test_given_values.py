"""A value that is no number is named where it is given, and its advice is enough."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from sambot_viz import check
from sambot_viz.edits import apply_edits

MODEL = """<?xml version="1.0"?>
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="height" default="0.5"/>
  <xacro:property name="radius" value="0.1"/>
  <xacro:property name="tyre" value="${radius}"/>
  <xacro:property name="at" value="0.1 0 0.2"/>
  <xacro:include filename="wheel.xacro"/>
  <link name="base">
    <visual>
      <origin xyz="${at}"/>
      <geometry>
        <cylinder radius="${tyre}" length="$(arg height)"/>
      </geometry>
    </visual>
  </link>
  <xacro:wheel side="left" y="0.2"/>
  <xacro:wheel side="right" y="-0.2"/>
</robot>
"""
WHEEL = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="wheel" params="side y width:=0.04">
    <link name="${side}_wheel">
      <visual>
        <geometry><cylinder radius="${radius}" length="${width}"/></geometry>
      </visual>
      <collision>
        <geometry><cylinder radius="${radius}" length="${width}"/></geometry>
      </collision>
    </link>
    <joint name="${side}_joint" type="fixed">
      <parent link="base"/>
      <child link="${side}_wheel"/>
      <origin xyz="0 ${y} 0"/>
    </joint>
  </xacro:macro>
</robot>
"""
SDF = """<?xml version="1.0"?>
<sdf version="1.8" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="radius" value="0.1"/>
  <model name="r">
    <link name="base">
      <visual name="a"><geometry><sphere>
        <radius>${radius}</radius>
      </sphere></geometry></visual>
      <collision name="a"><geometry><sphere>
        <radius>${radius}</radius>
      </sphere></geometry></collision>
    </link>
  </model>
</sdf>
"""


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ('"radius" value="0.1"', '"radius" value="0,1"'),
        ('default="0.5"', 'default="0,5"'),
        ('value="0.1 0 0.2"', 'value="0,1 0 0,2"'),
        ('value="0.1 0 0.2"', 'value="0.1, 0, 0.2"'),
        ('y="0.2"', 'y="0,2"'),
        ("width:=0.04", "width:=0,04"),
    ],
)
def test_a_wrong_value_is_one_problem_where_it_is_given(
    tmp_path: Path, right: str, wrong: str
) -> None:
    model, wheel = tmp_path / "r.urdf.xacro", tmp_path / "wheel.xacro"
    model.write_text(MODEL.replace(right, wrong))
    wheel.write_text(WHEEL.replace(right, wrong))

    (problem,) = check(model)

    file = Path(problem.file or "")
    lines = file.read_text().splitlines()
    number = next(n for n, line in enumerate(lines) if wrong in line)
    assert (problem.line, problem.severity) == (number + 1, "error")
    fix = problem.hint.removeprefix("write ")
    before = re.split('["=]', fix)[0]
    value = re.escape(before) + r'[:=]+("[^"]*"|[^"\s]+)'
    lines[number] = re.sub(value, fix, lines[number], count=1)
    file.write_text("\n".join(lines))
    assert check(model) == []


def test_a_unit_is_named_at_the_property(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf.xacro"
    model.write_text(MODEL.replace('"radius" value="0.1"', '"radius" value="10cm"'))
    (tmp_path / "wheel.xacro").write_text(WHEEL)

    (problem,) = check(model)

    assert problem.line == 4
    assert "unit" in problem.message


def test_a_wrong_number_beside_good_values_stays_where_it_is(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf.xacro"
    model.write_text(MODEL.replace('xyz="${at}"', 'xyz="${at}" rpy="0 0 x"'))
    (tmp_path / "wheel.xacro").write_text(WHEEL)

    (problem,) = check(model)

    assert (problem.code, problem.line) == ("number-malformed", 10)


def test_a_decimal_comma_in_sdf_is_named_at_the_property(tmp_path: Path) -> None:
    model = tmp_path / "r.sdf"
    model.write_text(SDF.replace('value="0.1"', 'value="1,5"'))

    (problem,) = check(model)

    assert (problem.line, problem.hint) == (3, 'write value="1.5"')


def test_a_minus_before_a_negative_property_is_named_at_the_property(
    tmp_path: Path,
) -> None:
    file = tmp_path / "robot.urdf.xacro"
    text = MODEL.replace('"${at}"', '"-${radius} 0 0"')
    (tmp_path / "wheel.xacro").write_text(WHEEL)
    file.write_text(text.replace('radius" value="0.1"', 'radius" value="-0.1"'))

    (problem,) = (p for p in check(file) if p.code == "number-malformed")

    assert problem.line == 4
    assert problem.hint.startswith('write value="0.1"; or, if it has to be negative')


def test_a_minus_before_a_negative_sum_goes_into_the_expression(tmp_path: Path) -> None:
    wrong = '"-${radius - 1} 0 0"'
    file = tmp_path / "robot.urdf.xacro"
    (tmp_path / "wheel.xacro").write_text(WHEEL)
    file.write_text(MODEL.replace('"${at}"', wrong))

    (problem,) = (p for p in check(file) if p.code == "number-malformed")

    assert problem.hint == "write ${-(radius - 1)} for -${radius - 1}"


@pytest.mark.parametrize("value", ["-0.1", "-${1/10}"])
def test_a_minus_before_a_negative_property_that_others_use_as_it_is_is_one_too_many(
    value: str, tmp_path: Path
) -> None:
    file = tmp_path / "robot.urdf.xacro"
    wrong = f"""<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:property name="low" value="{value}"/>
<link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="d" type="fixed"><parent link="a"/><child link="d"/>
<origin xyz="0.2 0 ${{low}}"/></joint>
<joint name="b" type="fixed"><parent link="a"/><child link="b"/>
<origin xyz="0 0.2 ${{low}}"/></joint>
<joint name="c" type="fixed"><parent link="a"/><child link="c"/>
<origin xyz="0 -0.2 -${{low}}"/></joint></robot>
"""
    file.write_text(wrong)

    (problem,) = (p for p in check(file) if p.code == "number-malformed")

    assert (problem.line, problem.hint) == (9, "write ${low} for -${low}")
    assert f"property low is {value} already" in problem.message
    right = wrong.replace("-${low}", "${low}")
    assert apply_edits(problem.edits, wrong) == right

"""Wheels whose joint is turned as well as their shape lie flat."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.errors import Problem

WHEEL = """
<link name="{0}_wheel">
  <collision>
    <origin rpy="1.5708 0 0"/>
    <geometry><cylinder radius="0.1" length="0.05"/></geometry>
  </collision>
</link>
<joint name="{0}_joint" type="continuous">
  <parent link="base_link"/> <child link="{0}_wheel"/>
  <origin xyz="0 {1} 0" rpy="{2}"/>
  <axis xyz="0 1 0"/>
</joint>
"""


def found(tmp_path: Path, *wheels: str) -> list[Problem]:
    model = tmp_path / "robot.urdf"
    model.write_text(
        f'<robot name="r"><link name="base_link"/>{"".join(wheels)}</robot>'
    )
    return [p for p in check(model) if p.code == "wheel-lies-flat"]


def test_two_flat_wheels_are_one_finding(tmp_path: Path) -> None:
    wheels = [WHEEL.format(f"w{y}", y, "1.5708 0 0") for y in (0.2, -0.2)]
    (problem,) = found(tmp_path, *wheels)
    assert problem.line == 10
    assert problem.hint == 'write rpy="0 0 0" in the <origin> of joint w0.2_joint'
    right = (wheel.replace('0" rpy="1.5708', '0" rpy="0') for wheel in wheels)
    assert found(tmp_path, *right) == []


@pytest.mark.parametrize(
    ("name", "rpy"),
    [("caster{}", "1.5708 0 0"), ("w{}", "0 0 1.5708"), ("w{}", "0 0 0")],
)
def test_casters_and_upright_wheels_are_right(
    name: str, rpy: str, tmp_path: Path
) -> None:
    wheels = [WHEEL.format(name.format(y), y, rpy) for y in (0.2, -0.2)]
    assert found(tmp_path, *wheels) == []

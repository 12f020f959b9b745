"""What the first problem of an SDF file says to write leaves no problem."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz import check
from sambot_viz.errors import Problem

MODEL = """<?xml version="1.0"?>
<sdf version="1.8">
  <model name="bot">
    <link name="base">
      <visual name="v">
        <geometry>
          <box><size>0.4 0.3 0.15</size></box>
        </geometry>
      </visual>
    </link>
    <link name="arm">
      <pose relative_to="arm_joint"/>
    </link>
    <joint name="arm_joint" type="fixed">
      <parent>base</parent>
      <child>arm</child>
      <pose relative_to="base">0.15 0 0.1 0 0 0</pose>
    </joint>
  </model>
</sdf>
"""
ORIGIN = '<origin xyz="0.15 0 0.1" rpy="0 0 0"/>'
POSE = '<pose relative_to="base">0.15 0 0.1 0 0 0</pose>'

Checked = Callable[[str], list[Problem]]


@pytest.fixture
def checked(tmp_path: Path) -> Checked:
    """Checks a text as a file."""

    def run(text: str) -> list[Problem]:
        model = tmp_path / "bot.sdf"
        model.write_text(text)
        return check(model)

    return run


def test_the_model_of_these_tests_is_good(checked: Checked) -> None:
    assert checked(MODEL) == []


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("0.4 0.3 0.15", "0,4 0,3 0,15"),
        ("0.4 0.3 0.15", "0,4, 0,3, 0,15"),
        ("0.4 0.3 0.15", "0.4, 0.3, 0.15"),
        (POSE, ORIGIN),
        (
            "<box><size>0.4 0.3 0.15</size></box>",
            '<box length="0.4" width="0.3" height="0.15"/>',
        ),
        ('relative_to="arm_joint"', 'relativ_to="arm_joint"'),
        ('relative_to="arm_joint"', 'relative-to="arm_joint"'),
        ('relative_to="base"', 'relativ_to="base"'),
        ('relative_to="base"', 'frame="base"'),
        ('relative_to="arm_joint"', 'frame="arm_joint"'),
    ],
)
def test_one_problem_says_what_to_write(
    checked: Checked, right: str, wrong: str
) -> None:
    text = MODEL.replace(right, wrong)

    (problem,) = checked(text)

    assert problem.line == text[: text.index(wrong)].count("\n") + 1
    assert text.replace(wrong, problem.hint.removeprefix("write ")) == MODEL


@pytest.mark.parametrize(
    ("right", "wrong"), [("base", "bsae"), ("arm_joint", "armjoint")]
)
def test_an_unknown_frame_is_no_ring(checked: Checked, right: str, wrong: str) -> None:
    text = MODEL.replace(f'relative_to="{right}"', f'relative_to="{wrong}"')

    (problem,) = checked(text)

    assert problem.code == "sdf-frame-unknown"
    assert text.replace(wrong, problem.hint.removeprefix("write ")) == MODEL


def test_the_frame_of_an_old_version_is_left_alone(checked: Checked) -> None:
    text = MODEL.replace("1.8", "1.6").replace('relative_to="base"', 'frame="base"')

    assert checked(text) == []


def test_a_sensor_beside_the_links_is_sent_into_a_link(checked: Checked) -> None:
    sensor = '<sensor name="lidar" type="gpu_lidar"/>'

    (problem,) = checked(MODEL.replace("  </model>", f"{sensor}</model>"))

    assert (problem.severity, problem.hint) == ("warning", "move it into a <link>")
    inside = checked(MODEL.replace("    </link>", f"{sensor}</link>", 1))
    assert [problem.severity for problem in inside] == ["info"]


def test_a_mesh_that_is_named_as_in_urdf_is_one_problem(checked: Checked) -> None:
    mesh = '<mesh filename="package://bot/arm.stl"/>'
    box = "<box><size>0.4 0.3 0.15</size></box>"

    (problem,) = checked(MODEL.replace(box, mesh))

    assert problem.hint == "write <mesh><uri>package://bot/arm.stl</uri></mesh>"

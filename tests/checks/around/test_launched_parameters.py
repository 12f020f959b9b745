"""Parameters that a launch file itself gives to a node are compared with the table."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

MANIFEST = '<package format="3"><name>robot</name></package>'
PYTHON = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(
            package="joint_state_publisher",
            executable="joint_state_publisher",
            parameters=[{"rate": 30, "use_mimic_tags": True, "x": 1}],
        ),
    ])
"""
XML = """\
<launch>
  <node pkg="joint_state_publisher" exec="joint_state_publisher">
    <param name="delta" value="0.5"/>
    <param name="rate" value="$(env RATE)"/>
  </node>
</launch>
"""
CODES = {"parameter-type", "parameter-unknown"}


@pytest.mark.parametrize(
    ("name", "text", "right", "wrong", "cause"),
    [
        ("a.launch.py", PYTHON, '"rate": 30', '"rate": 30.0', "needs a whole number"),
        ("a.launch.py", PYTHON, "True", "'true'", "needs true or false"),
        ("a.launch.py", PYTHON, '"rate"', '"rates"', "no parameter rates, but rate"),
        ("a.launch.xml", XML, '"0.5"', '"0.5 m"', "needs a number with a decimal"),
        ("a.launch.xml", XML, '"delta"', '"delt"', "no parameter delt, but delta"),
    ],
)
def test_a_parameter_of_another_name_or_type(
    tmp_path: Path, name: str, text: str, right: str, wrong: str, cause: str
) -> None:
    (tmp_path / "package.xml").write_text(MANIFEST)
    launch = tmp_path / name
    launch.write_text(text)
    assert CODES.isdisjoint(problem.code for problem in check(tmp_path))
    launch.write_text(text.replace(right, wrong, 1))

    (problem,) = (p for p in check(tmp_path) if p.code in CODES)

    assert cause in problem.message
    assert apply_edits(problem.edits, launch.read_text()) == text

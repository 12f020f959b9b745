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
            package="joy",
            executable="joy_node",
            parameters=[{"device_id": 30, "sticky_buttons": True, "x": 1}],
        ),
    ])
"""
XML = """\
<launch>
  <node pkg="joy" exec="joy_node">
    <param name="deadzone" value="0.5"/>
    <param name="device_id" value="$(env RATE)"/>
  </node>
</launch>
"""
CODES = {"parameter-type", "parameter-unknown"}


@pytest.mark.parametrize(
    ("name", "text", "right", "wrong", "cause"),
    [
        (
            "a.launch.py",
            PYTHON,
            '"device_id": 30',
            '"device_id": 30.0',
            "needs a whole number",
        ),
        ("a.launch.py", PYTHON, "True", "'true'", "needs true or false"),
        (
            "a.launch.py",
            PYTHON,
            '"device_id"',
            '"device_ids"',
            "no parameter device_ids, but device_id",
        ),
        ("a.launch.xml", XML, '"0.5"', '"0.5 m"', "needs a number with a decimal"),
        (
            "a.launch.xml",
            XML,
            '"deadzone"',
            '"deadzon"',
            "no parameter deadzon, but deadzone",
        ),
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

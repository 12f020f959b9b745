"""Texts, conditions and expressions of launch files that launch cannot take."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files
from manifests import manifest, written

from sambot_viz.checks import check

PYTHON, XML, YAML = "launch/a.launch.py", "launch/b.launch.xml", "launch/c.launch.yaml"
FILES = {
    "package.xml": manifest("launch", "rviz2"),
    PYTHON: """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node


def generate_launch_description():
    gui = LaunchConfiguration('gui')
    flag = True
    return LaunchDescription([
        DeclareLaunchArgument('gui', default_value='true'),
        DeclareLaunchArgument('mode', default_value='slam'),
        Node(
            package='rviz2',
            executable='rviz2',
            name='rviz',
            condition=IfCondition(gui),
        ),
    ])
""",
    XML: """\
<launch>
  <arg name="gui" default="true"/>
  <arg name="mode" default="slam"/>
  <node pkg="rviz2" exec="rviz2" if="$(var gui)"/>
</launch>
""",
    YAML: """\
launch:
- arg: {name: gui, default: "true"}
- node:
    pkg: rviz2
    exec: rviz2
    if: $(var gui)
""",
}
MODE = "PythonExpression([\"'\", LaunchConfiguration('mode'), \"' == 'slam'\"])"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package with right launch files in each form."""
    return written(tmp_path / "robot", FILES)


def test_right_texts_have_no_problem(package: Path) -> None:
    assert [p for p in check(package) if p.severity != "info"] == []


@pytest.mark.parametrize(
    ("file", "right", "wrong", "cause"),
    [
        (PYTHON, "'true')", "True)", "default_value is True, and launch takes only"),
        (PYTHON, "'true')", "flag)", "default_value is True (line 10)"),
        (PYTHON, "IfCondition(gui)", "IfCondition([gui, ' == true'])", "puts texts"),
        (PYTHON, "IfCondition(gui)", "gui", "takes an IfCondition"),
        (
            PYTHON,
            f"IfCondition({MODE})",
            "IfCondition([LaunchConfiguration('mode'), ' == slam'])",
            "launch computes nothing",
        ),
        (
            PYTHON,
            "UnlessCondition(gui)",
            "IfCondition(['not ', gui])",
            "launch computes nothing",
        ),
        (
            PYTHON,
            f"IfCondition({MODE})",
            "IfCondition(PythonExpression("
            "[LaunchConfiguration('mode'), \" == 'slam'\"]))",
            "Python knows no name slam",
        ),
        (XML, '"$(var gui)"', '"$(var gui) == true"', "launch computes nothing"),
        (YAML, "if: $(var gui)", 'if: "$(var gui) == true"', "computes nothing"),
    ],
)
def test_a_text_that_launch_cannot_take_is_mended_by_its_edit(
    package: Path, file: str, right: str, wrong: str, cause: str
) -> None:
    path = package / file
    text = path.read_text()
    good = text if right in text else text.replace("IfCondition(gui)", right)
    path.write_text(good.replace(right, wrong, 1))
    (problem,) = [p for p in check(package) if p.severity != "info"]
    assert (problem.code, problem.severity) == ("launch-code", "error")
    assert cause in problem.message
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert [p for p in check(package) if p.severity != "info"] == []


@pytest.mark.parametrize(
    ("wrong", "severity", "cause"),
    [
        ("name='a_' + gui", "error", "Python cannot add a text to it"),
        ("name=f'a_{gui}'", "warning", "the name of a Python object"),
        ("name=str(gui)", "warning", "the name of a Python object"),
    ],
)
def test_python_does_not_know_the_text_of_a_substitution(
    package: Path, wrong: str, severity: str, cause: str
) -> None:
    path = package / PYTHON
    path.write_text(FILES[PYTHON].replace("name='rviz'", wrong))
    (problem,) = [p for p in check(package) if p.severity != "info"]
    assert (problem.code, problem.severity) == ("launch-code", severity)
    assert cause in problem.message
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert [p for p in check(package) if p.severity != "info"] == []

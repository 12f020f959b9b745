"""A launch argument without a declaration is found once, and is declared by an edit."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from edited import edited_files

from sambot_viz.checks import check

LAUNCH = "launch/display.launch.py"
DECLARED = """\
            DeclareLaunchArgument("use_sim_time", default_value="True"),
"""
SECOND = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument


def generate_launch_description():
    description = LaunchDescription()
    description.add_action({})
    return description
"""
XML = """\
<launch>
  <node pkg="joint_state_publisher" exec="joint_state_publisher">
    <param name="rate" value="$(var {})"/>
  </node>
</launch>
"""
Copied = Callable[[str], Path]


@pytest.fixture
def package(copied: Copied) -> Path:
    """The package "gz" without the declaration of use_sim_time."""
    folder = copied("gz")
    text = (folder / LAUNCH).read_text()
    assert DECLARED in text
    (folder / LAUNCH).write_text(text.replace(DECLARED, ""))
    return folder


@pytest.mark.parametrize("default", ["", "false"], ids=["", "default elsewhere"])
def test_the_first_launch_file_declares_its_arguments(
    package: Path, default: str
) -> None:
    if default:
        made = f"DeclareLaunchArgument('use_sim_time', default_value='{default}')"
        (package / "launch/second.launch.py").write_text(SECOND.format(made))
    (problem,) = check(package)
    assert (problem.code, problem.severity) == ("launch-argument-unknown", "warning")
    right = "DeclareLaunchArgument('use_sim_time', default_value='true'"
    assert problem.hint == f"add {right}) to the LaunchDescription"
    path = package / LAUNCH
    made = edited_files(problem.edits)[str(path)].decode()
    assert f"            {right}),\n            ExecuteProcess" in made
    path.write_text(made)
    assert check(package) == []


def test_several_uses_are_one_finding(package: Path) -> None:
    path = package / LAUNCH
    text = path.read_text()
    use = 'LaunchConfiguration("use_sim_time")'
    here = '"use_sim_time": use_sim_time'
    path.write_text(text.replace(here, f'"use_sim_time": {use}'))
    (problem,) = check(package)
    assert "is not declared (line 41 too)" in problem.message


def test_an_unused_variable_asks_for_no_argument(package: Path) -> None:
    path = package / LAUNCH
    text = path.read_text().replace("use_sim_time = L", "unused = L")
    path.write_text(text.replace(": use_sim_time", ": True"))
    assert "launch-argument-unknown" not in {p.code for p in check(package)}


def test_another_file_may_set_the_argument(package: Path) -> None:
    other = "IncludeLaunchDescription('display.launch.py')"
    text = SECOND.replace("import Declare", "import IncludeLaunchDescription, Declare")
    (package / "launch/second.launch.py").write_text(text.format(other))
    (problem,) = check(package)
    assert (problem.code, problem.severity) == ("launch-argument-unknown", "info")


def test_a_declaration_in_xml_and_in_statements(package: Path) -> None:
    rate = "DeclareLaunchArgument('rate', default_value='30')"
    (package / "launch/second.launch.py").write_text(SECOND.format(rate))
    (package / "launch/rates.launch.xml").write_text(XML.format("rate"))
    found = [p for p in check(package) if "rate is not" in p.message]
    (problem,) = found
    assert problem.hint == 'add <arg name="rate" default="30"/> to <launch>'
    made = edited_files(problem.edits)[str(package / "launch/rates.launch.xml")]
    assert made.decode().startswith('<launch>\n  <arg name="rate" default="30"/>\n  <')

"""robot_state_publisher reads the joint states that something publishes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from edited import edited_files

from sambot_viz.checks import check

Copied = Callable[[str], Path]
MODEL, BRIDGE = "urdf/cart.urdf.xacro", "config/bridge_config.yaml"
LAUNCH = "launch/display.launch.py"
READER = '        executable="robot_state_publisher",\n'
REMAPPED = '        remappings=[("joint_states", "cart/joint_states")],\n'
OTHER = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package="{0}", executable="{0}", {1}),
{2}    ])
"""
DESCRIBED = """\
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            parameters=[{"robot_description": "<robot/>"}],
        ),
"""


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def test_a_bridge_publishes_them_under_another_name(copied: Copied) -> None:
    package = copied("gz")
    right = (package / BRIDGE).read_text()
    edit(package / BRIDGE, 'name: "/joint_states"', 'name: "/joint_state"')

    (problem,) = check(package / MODEL)

    assert (problem.code, problem.severity) == ("launch-no-joint-states", "warning")
    assert problem.file == str(package / BRIDGE)
    assert "reads /joint_states, but the bridge publishes" in problem.message
    assert problem.hint == "write /joint_states"
    path = package / BRIDGE
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert path.read_text() == right


def test_a_remapping_of_the_reader_is_odd(copied: Copied) -> None:
    package = copied("gz")
    edit(package / LAUNCH, READER, READER + REMAPPED)

    (problem,) = check(package / MODEL)

    assert problem.file == str(package / LAUNCH)
    assert "reads /cart/joint_states, but the bridge" in problem.message
    assert problem.hint == "delete the remapping, or write one for the bridge too"


@pytest.mark.parametrize("remapped", ["joint_states", "/joint_states"])
def test_a_remapping_of_the_publisher_is_odd(copied: Copied, remapped: str) -> None:
    package = copied("gz")
    names = f'remappings=[("{remapped}", "wheels")]'
    text = OTHER.format("joint_state_publisher", names, DESCRIBED)
    (package / "launch" / "view.launch.py").write_text(text)

    (problem,) = check(package / MODEL)

    assert (problem.file or "").endswith("view.launch.py")
    assert "but joint_state_publisher (line 7) publishes" in problem.message
    assert "as /wheels: wheels and other joints" in problem.message


def test_another_launch_file_may_read_them(copied: Copied) -> None:
    package = copied("gz")
    names = REMAPPED.strip()
    described = DESCRIBED.replace("parameters=", f"{names} parameters=")
    text = OTHER.format("joint_state_publisher", "", described)
    (package / "launch" / "view.launch.py").write_text(text)

    (problem,) = check(package / MODEL)

    assert (problem.file or "").endswith("view.launch.py")
    hint = "delete the remapping, or write one for joint_state_publisher too"
    assert problem.hint == hint


SILENT = [
    ("joint_state_publisher", "", ""),
    (
        "joint_state_publisher",
        'parameters=[{"source_list": ["joint_state"]}]',
        DESCRIBED,
    ),
    ("wheel_driver", "", ""),
    ("joint_state_publisher", "**{}", DESCRIBED + "        *others(),\n"),
    ("controller_manager", "arguments=['a']", ""),
]


@pytest.mark.parametrize(("program", "given", "after"), SILENT)
def test_something_else_may_publish_them(
    copied: Copied, program: str, given: str, after: str
) -> None:
    package = copied("gz")
    edit(package / BRIDGE, 'name: "/joint_states"', 'name: "/joint_state"')
    text = OTHER.format(program, given, after)
    (package / "launch" / "other.launch.py").write_text(text)
    codes = {problem.code for problem in check(package / MODEL)}
    assert "launch-no-joint-states" not in codes


def test_a_program_of_the_package_may_publish_them(copied: Copied) -> None:
    package = copied("gz")
    edit(package / BRIDGE, 'name: "/joint_states"', 'name: "/joint_state"')
    text = "from sensor_msgs.msg import JointState\n"
    (package / "wheels.py").write_text(text)
    codes = {problem.code for problem in check(package / MODEL)}
    assert "launch-no-joint-states" not in codes

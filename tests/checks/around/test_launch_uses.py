"""What a launch file builds, names or hands on wrongly is found, and mended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from edited import edited_files

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
LAUNCH = "launch/display.launch.py"
EKF = 'os.path.join(share, "config/ekf.yaml")'
GZ_BRIDGE = """\
    bridge = RosGzBridge(
        bridge_name="ros_gz_bridge",
        config_file=os.path.join(share, "config", "bridge_config.yaml"),
    )
"""
AS_PARAMETERS = """\
    topics = os.path.join(share, "config", "bridge_config.yaml")
    bridge = Node(
        package="ros_gz_bridge", executable="parameter_bridge", parameters=[topics]
    )
"""

Copied = Callable[[str], Path]
Edits = list[tuple[str, str]]


def edit(file: Path, edits: Edits) -> None:
    text = file.read_text()
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new, 1)
    file.write_text(text)


@pytest.mark.parametrize(
    ("code", "made", "line", "cause", "hint", "fixed"),
    [
        (
            "launch-node-unused",
            [("            robot_localization,\n", "")],
            35,
            "robot_localization is built here, but it is not in the LaunchDescription "
            "(line 59): it does not start",
            "add robot_localization to that list",
            [
                (
                    "            bridge,",
                    "            bridge,\n            robot_localization,",
                )
            ],
        ),
        (
            "launch-node-unused",
            [
                (
                    "    return LaunchDescription(",
                    '    gui = DeclareLaunchArgument("gui")\n'
                    "    return LaunchDescription(",
                )
            ],
            59,
            "the argument does not exist",
            "add gui to that list",
            [("            bridge,", "            bridge,\n            gui,")],
        ),
        (
            "launch-argument-unknown",
            [
                (
                    'LaunchConfiguration("use_sim_time")',
                    'LaunchConfiguration("sim_time")',
                )
            ],
            24,
            "the launch argument sim_time is not declared; use_sim_time is (line 61)",
            "write LaunchConfiguration('use_sim_time')",
            [
                (
                    'LaunchConfiguration("sim_time")',
                    "LaunchConfiguration('use_sim_time')",
                )
            ],
        ),
        (
            "launch-program-unknown",
            [('executable="ekf_node"', 'executable="ekf_filter_node"')],
            37,
            "the package robot_localization has no program ekf_filter_node",
            "write ekf_node",
            [('executable="ekf_filter_node"', 'executable="ekf_node"')],
        ),
        (
            "launch-bridge-config",
            [(GZ_BRIDGE, AS_PARAMETERS)],
            47,
            "config/bridge_config.yaml is a list of topics and no parameters",
            "write {'config_file': topics}",
            [("parameters=[topics]", "parameters=[{'config_file': topics}]")],
        ),
        (
            "launch-command",
            [('"xacro "', '"xacro"')],
            25,
            "xacro and the name of the model become one word",
            "write 'xacro ', with a blank at the end",
            [('"xacro"', "'xacro '")],
        ),
        (
            "launch-time-text",
            [('{"use_sim_time": use_sim_time}', '{"use_sim_time": "true"}')],
            32,
            "use_sim_time is the text 'true'",
            "write True",
            [('"use_sim_time": "true"', '"use_sim_time": True')],
        ),
        (
            "launch-spawn-topic",
            [('"/robot_description"', '"/robot_descriptions"')],
            55,
            "robot_state_publisher (line 27) publishes it as /robot_description",
            "write /robot_description",
            [('"/robot_descriptions"', '"/robot_description"')],
        ),
        (
            "launch-file-missing",
            [("config/ekf.yaml", "config/robot_localization.yaml")],
            40,
            "the package does not have; it has config/ekf.yaml",
            "write config/ekf.yaml",
            [("config/robot_localization.yaml", "config/ekf.yaml")],
        ),
        (
            "launch-file-missing",
            [('"bridge_config.yaml"', '"bridge_config.yml"')],
            47,
            "it has config/bridge_config.yaml",
            "write config/bridge_config.yaml",
            [('"bridge_config.yml"', '"bridge_config.yaml"')],
        ),
        (
            "launch-file-missing",
            [('"cart.urdf.xacro"', '"cart_robot.urdf"')],
            21,
            "it has urdf/cart.urdf.xacro",
            "write urdf/cart.urdf.xacro",
            [('"cart_robot.urdf"', '"cart.urdf.xacro"')],
        ),
    ],
)
def test_a_mistake_in_what_a_launch_file_uses(
    copied: Copied,
    code: str,
    made: Edits,
    line: int,
    cause: str,
    hint: str,
    fixed: Edits,
) -> None:
    package = copied("gz")
    edit(package / LAUNCH, made)

    (problem,) = check(package / MODEL)

    assert (problem.code, problem.line) == (code, line)
    assert problem.file == str(package / LAUNCH)
    assert cause in problem.message
    assert problem.hint == hint
    edit(package / LAUNCH, fixed)
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    "edits",
    [
        [("            robot_localization,\n", "            # robot_localization,\n")],
        [
            (
                'LaunchConfiguration("use_sim_time")',
                'LaunchConfiguration("sim_time", "a")',
            )
        ],
        [
            ('LaunchConfiguration("use_sim_time")', 'LaunchConfiguration("sim_time")'),
            ('"world": "room",', '"world": "room", "sim_time": "True",'),
        ],
        [('executable="ekf_node"', 'executable="my_filter"')],
        [('["xacro ", model]', '["xacro", " ", model]')],
        [('"use_sim_time": use_sim_time', '"use_sim_time": True')],
        [('"/robot_description"', '"/cart/robot_description"')],
        [("            spawn,\n", "            *[spawn],\n")],
    ],
)
def test_what_may_be_meant_is_not_reported(copied: Copied, edits: Edits) -> None:
    package = copied("gz")
    edit(package / LAUNCH, edits)
    assert check(package / MODEL) == []


def test_what_is_not_started_needs_no_program(copied: Copied) -> None:
    package = copied("gz")
    launch = package / LAUNCH
    spare = '    spare = Node(package="controller_manager", executable="spawn")\n'
    # A name in a comment is left out on purpose.
    edit(
        launch,
        [
            ("    return LaunchDescription(", f"{spare}    return LaunchDescription("),
            ("            spawn,\n", "            spawn,\n            # spare,\n"),
        ],
    )
    assert check(package / MODEL) == []
    edit(launch, [("            # spare,\n", "            spare,\n")])
    assert [p.code for p in check(package / MODEL)] == ["launch-program-unknown"]


def test_the_topics_of_a_bridge_get_their_name_by_an_edit(copied: Copied) -> None:
    package = copied("gz")
    edit(package / LAUNCH, [(GZ_BRIDGE, AS_PARAMETERS)])
    (problem,) = [p for p in check(package) if p.code == "launch-bridge-config"]
    made = edited_files(problem.edits)[str(package / LAUNCH)].decode()
    assert "parameters=[{'config_file': topics}]" in made

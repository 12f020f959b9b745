"""What a launch file gives to a node in a wrong way is found, and mended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.errors import Problem

MODEL = "urdf/cart.urdf.xacro"
LAUNCH = "launch/display.launch.py"
TABLE = '{"robot_description": description}'
JOINTS = """\
    condition = LaunchConfiguration("gui")
    joints = Node(
        package="joint_state_publisher",
        executable="joint_state_publisher",
        condition=UnlessCondition(LaunchConfiguration("gui")),
    )
    sliders = Node(
        package="joint_state_publisher_gui",
        executable="joint_state_publisher_gui",
        condition=IfCondition(LaunchConfiguration("gui")),
    )
"""
Edits = list[tuple[str, str]]
Copied = Callable[[str], Path]


@pytest.fixture
def package(copied: Copied) -> Path:
    """A right package, with two publishers of joint states."""
    folder = copied("gz")
    edit(
        folder,
        [
            ("    rviz = Node", f"{JOINTS}    rviz = Node"),
            ("            rviz,", "            rviz,\n            *[joints, sliders],"),
            (
                '            DeclareLaunchArgument("use',
                '            DeclareLaunchArgument("gui", default_value="True"),\n'
                '            DeclareLaunchArgument("model", default_value=model),\n'
                '            DeclareLaunchArgument("use',
            ),
            (
                "from launch.launch_desc",
                "from launch.conditions import IfCondition, UnlessCondition\n"
                "from launch.launch_desc",
            ),
        ],
    )
    return folder


def edit(folder: Path, edits: Edits) -> None:
    text = (folder / LAUNCH).read_text()
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    (folder / LAUNCH).write_text(text)


def found(folder: Path) -> list[Problem]:
    return check(folder / MODEL)


def test_a_right_launch_file_gives_nothing(package: Path) -> None:
    assert found(package) == []


@pytest.mark.parametrize(
    ("code", "wrong", "cause", "hint", "better"),
    [
        pytest.param(
            "launch-description",
            [("{old}", '{"robot_description": LaunchConfiguration("model")}')],
            "robot_description is the path of cart.urdf.xacro, not the text of the "
            "model: robot_state_publisher stops",
            "write ParameterValue(Command(['xacro ', LaunchConfiguration('model')]), "
            "value_type=str)",
            '{"robot_description": ParameterValue(Command(["xacro ", '
            'LaunchConfiguration("model")]), value_type=str)}',
            id="argument",
        ),
        pytest.param(
            "launch-description",
            [("{old}", '{"robot_description": model}')],
            "robot_description is the path of cart.urdf.xacro",
            "write ParameterValue(Command(['xacro ', model]), value_type=str)",
            '{"robot_description": ParameterValue(Command(["xacro ", model]), '
            "value_type=str)}",
            id="path",
        ),
        pytest.param(
            "launch-description",
            [("{old}", '{"robot_description": open(model)}')],
            "robot_description is a file that is not read",
            "write open(model).read()",
            '{"robot_description": open(model).read()}',
            id="open",
        ),
        pytest.param(
            "launch-description",
            [("{old}", '{"robot_description": open(model).read}')],
            "robot_description is the function read",
            "write open(model).read()",
            '{"robot_description": open(model).read()}',
            id="read",
        ),
        pytest.param(
            "launch-description",
            [("{old}", '{"robot_descripton": description}')],
            "reads the parameter robot_description, but this is robot_descripton",
            "write 'robot_description'",
            TABLE,
            id="name",
        ),
        pytest.param(
            "launch-description",
            [("            {old},\n", "")],
            "robot_state_publisher gets no robot_description: it stops",
            "write parameters=[{'robot_description': Command(['xacro ', MODEL])}], "
            "with the path of the model for MODEL",
            f"            {TABLE},\n",
            id="none",
        ),
        pytest.param(
            "launch-no-list",
            [('arguments=["-d", config]', 'arguments="-d cart.rviz"')],
            "arguments of a node is a list, but this is a text",
            "write arguments=['-d', 'cart.rviz']",
            "arguments=['-d', 'cart.rviz']",
            id="text",
        ),
        pytest.param(
            "launch-no-list",
            [(', arguments=["-d"', ', remappings={"a": "b"}, arguments=["-d"')],
            "remappings of a node is a list, but this is a dict: ros2 launch stops",
            "write remappings=[('a', 'b')]",
            ", remappings=[('a', 'b')], arguments=[\"-d\"",
            id="remappings",
        ),
        pytest.param(
            "launch-rviz-config",
            [('["-d", config]', "[config]")],
            "rviz2 reads a config only after -d: cart.rviz is not opened",
            "write '-d', config",
            "['-d', config]",
            id="rviz",
        ),
        pytest.param(
            "launch-parameters-missing",
            [('            os.path.join(share, "config/ekf.yaml"),\n', "")],
            "no node is given the parameters for ekf_filter_node (ekf.yaml line 3)",
            "add os.path.join(share, 'config/ekf.yaml') to its parameters",
            "            os.path.join(share, 'config/ekf.yaml'),\n",
            id="parameters",
        ),
        pytest.param(
            "launch-no-joint-states",
            [("IfCondition(Lau", "UnlessCondition(Lau")],
            "joint_state_publisher_gui has the same condition as joint_state_publisher",
            "write condition=IfCondition(LaunchConfiguration('gui'))",
            "IfCondition(Lau",
            id="conditions",
        ),
        pytest.param(
            "launch-namespace",
            [
                (
                    '="robot_state_publisher",\n    ',
                    '="robot_state_publisher", namespace="a",\n    ',
                )
            ],
            "robot_state_publisher reads /a/joint_states, but joint_state_publisher",
            "delete the namespace here, or write it for joint_state_publisher too",
            None,
            id="namespace",
        ),
    ],
)
def test_a_mistake_is_found_and_its_fix_leaves_nothing(
    package: Path, code: str, wrong: Edits, cause: str, hint: str, better: str | None
) -> None:
    before = (package / LAUNCH).read_text()
    edits = [(old.replace("{old}", TABLE), new) for old, new in wrong]
    edit(package, edits)
    problems = [p for p in found(package) if p.code == code]
    assert len(problems) == 1, found(package)
    assert cause in problems[0].message
    assert problems[0].hint == hint
    (package / LAUNCH).write_text(before)
    if better is not None:
        edit(package, [(edits[0][0], better)])
    assert found(package) == []


@pytest.mark.parametrize(
    "edits",
    [
        [(TABLE, '{"robot_description": other.text(model)}')],
        [(TABLE, "*others")],
        [(TABLE, "{**others}")],
        [(TABLE, "os.path.join(share, 'config/nav2_params.yaml')")],
        [(f"            {TABLE},\n", ""), ('ble="robot_state_', 'ble="my_state_')],
        [('["-d", config]', '["--display-config", config]')],
        [('["-d", config]', '["--display-config=" + config]')],
        [('["-d", config]', '["-d" + config]')],
        [('["-d", config]', '["-d", config], remappings={"a": "b"}.items()')],
        [('["-d", config]', "other.arguments")],
        [("IfCondition(Lau", "other(Lau"), ("UnlessCondition(Lau", "other(Lau")],
        [('executable="joint', 'namespace=other.name, executable="joint')],
        [
            (
                'executable="joint',
                'remappings=[("joint_states", "/j")], executable="joint',
            )
        ],
    ],
)
def test_what_is_not_understood_is_not_judged(package: Path, edits: Edits) -> None:
    text = (package / LAUNCH).read_text()
    for old, new in edits:
        text = text.replace(old, new)
    (package / LAUNCH).write_text(f"from other import other, others\n{text}")
    codes = {problem.code for problem in found(package)}
    assert codes.isdisjoint(
        {
            "launch-description",
            "launch-no-list",
            "launch-rviz-config",
            "launch-no-joint-states",
            "launch-namespace",
        }
    )

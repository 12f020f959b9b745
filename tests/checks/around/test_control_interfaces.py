"""Joints and interfaces of <ros2_control> are those that controllers need."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

LINK = """
<link name="{0}"><inertial><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="{0}_joint" type="continuous"><parent link="base_link"/>
<child link="{0}"/><axis xyz="0 1 0"/></joint>"""
CONTROL = """
<ros2_control name="all" type="system">
<hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
<joint name="left_joint">
<command_interface name="velocity"/>
</joint>
<joint name="right_joint">
<command_interface name="velocity"/>
</joint>
<joint name="arm_joint">
<command_interface name="position"/>
<state_interface name="position"/>
</joint>
</ros2_control>
<gazebo><plugin filename="gz_ros2_control-system" name="control"/></gazebo>
"""
LINKS = "".join(map(LINK.format, ("left", "right", "arm")))
MODEL = f'<robot name="r"><link name="base_link"/>{LINKS}{CONTROL}</robot>'
YAML = """\
controller_manager:
  ros__parameters:
    states:
      type: joint_state_broadcaster/JointStateBroadcaster
    drive:
      type: diff_drive_controller/DiffDriveController
    arm_controller:
      type: joint_trajectory_controller/JointTrajectoryController
drive:
  ros__parameters:
    left_wheel_names: [left_joint]
    right_wheel_names: [right_joint]
    publish_rate: 50.0
arm_controller:
  ros__parameters:
    joints:
      - arm_joint
    command_interfaces: [position]
    state_interfaces: [position]
"""
LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(
            package="controller_manager",
            executable="spawner",
            arguments=["states", "drive", "arm_controller"],
        ),
    ])
"""
FILES = {
    "package.xml": "<package><name>r</name></package>",
    "r.urdf": MODEL,
    "control.yaml": YAML,
    "r.launch.py": LAUNCH,
}
CODES = {"control-interface", "controller-unknown", "gazebo-generation"}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, "utf-8")
    return tmp_path


def test_interfaces_that_fit_are_right(package: Path) -> None:
    assert CODES.isdisjoint(problem.code for problem in check(package / "r.urdf"))


@pytest.mark.parametrize(
    ("file", "right", "wrong", "cause"),
    [
        ("r.urdf", "velocity", "position", "interface velocity of left_joint, which"),
        (
            "r.urdf",
            'command_interface name="position',
            'command_interface name="effort',
            "needs the command interface position of arm_joint, which has effort",
        ),
        (
            "control.yaml",
            "command_interfaces: [position",
            "command_interfaces: [effort",
            "needs the command interface effort, but arm_joint has position",
        ),
        ("control.yaml", "- arm_joint", "- arms_joint", "names the joint arms_joint"),
        (
            "control.yaml",
            "drive:\n  ros",
            "cart:\n  ros",
            "no controller is called cart",
        ),
        (
            "r.launch.py",
            '"drive"',
            '"drive_base"',
            "asks for the controller drive_base",
        ),
        (
            "control.yaml",
            "joint_state_broadcaster/JointStateBroadcaster",
            "joint_state_controller/JointStateController",
            "has no controller",
        ),
        (
            "r.urdf",
            "gz_ros2_control/GazeboSimSystem",
            "gazebo_ros2_control/GazeboSystem",
            "is for Gazebo Classic, but the plugin",
        ),
    ],
)
def test_what_a_controller_does_not_get(
    package: Path, file: str, right: str, wrong: str, cause: str
) -> None:
    path = package / file
    assert right in FILES[file]
    path.write_text(FILES[file].replace(right, wrong, 1))

    (problem,) = (p for p in check(package / "r.urdf") if p.code in CODES)

    assert cause in problem.message
    assert apply_edits(problem.edits, path.read_text()) == FILES[file]


def test_a_state_interface_that_is_missing(package: Path) -> None:
    model = package / "r.urdf"
    state = '\n<state_interface name="position"/>'
    model.write_text(MODEL.replace(state, ""))
    (problem,) = (p for p in check(model) if p.code in CODES)
    assert problem.hint == 'add <state_interface name="position"/> to the joint'
    model.write_text(apply_edits(problem.edits, model.read_text()))
    assert CODES.isdisjoint(found.code for found in check(model))


def test_a_joint_that_is_in_ros2_control_already_is_not_meant_again(
    package: Path,
) -> None:
    model = package / "r.urdf"
    renamed = MODEL.replace("right_joint", "second_joint", 1)
    for text, hint, edits in (
        (renamed, "write second_joint", 1),
        (
            renamed.replace("</robot>", f"{LINK.format('lamp')}</robot>"),
            "write the joint that is meant",
            0,
        ),
    ):
        model.write_text(text)
        found = [p for p in check(model) if p.file == str(model)]
        assert [(p.hint, len(p.edits)) for p in found if p.code == "gazebo-joint"] == [
            (hint, edits)
        ]


ALIKE = [("command_interface", "velocity"), ("state_interface", "position")]


def _controlled(*interfaces: list[tuple[str, str]]) -> str:
    joints = "".join(
        f'<joint name="{name}_joint">'
        + "".join(f'<{tag} name="{said}"/>' for tag, said in own)
        + "</joint>"
        for name, own in zip(("left", "right", "arm"), interfaces, strict=True)
    )
    hardware = CONTROL[: CONTROL.index("<joint")]
    return f'<robot name="r"><link name="base_link"/>{LINKS}{hardware}{joints}' + (
        "</ros2_control></robot>"
    )


@pytest.mark.parametrize(
    ("own", "severity", "hint"),
    [
        (ALIKE[1:], "info", 'add <command_interface name="velocity"/> to the joint'),
        ([*ALIKE, ALIKE[1]], "warning", "delete one, or write another one"),
        ([*ALIKE, ("state_interface", "velocity")], None, ""),
    ],
)
def test_a_joint_that_is_unlike_all_others_is_named(
    own: list[tuple[str, str]], severity: str | None, hint: str, tmp_path: Path
) -> None:
    model = tmp_path / "robot.urdf"
    model.write_text(_controlled(ALIKE, ALIKE, own))

    problems = check(model)

    assert [p.severity for p in problems] == ([severity] if severity else [])
    assert all(hint in p.hint for p in problems)


def test_a_joint_that_mimics_another_has_no_command(tmp_path: Path) -> None:
    model = tmp_path / "robot.urdf"
    text = _controlled(ALIKE, ALIKE, ALIKE[1:])
    model.write_text(text)
    assert "command_interface" in check(model)[0].hint
    at = text.rindex("</joint>", 0, text.index("<ros2_control"))
    first = text[text.index('<joint name="') + 13 :].partition('"')[0]
    model.write_text(f'{text[:at]}<mimic joint="{first}"/>{text[at:]}')
    assert check(model) == []


def test_an_interface_twice_was_meant_to_be_the_one_that_others_have(
    tmp_path: Path,
) -> None:
    model = tmp_path / "robot.urdf"
    both = [ALIKE[1], ("state_interface", "velocity")]
    model.write_text(_controlled(both, both, [ALIKE[1], ALIKE[1]]))

    (problem,) = (p for p in check(model) if p.severity == "warning")

    assert problem.hint == 'write name="velocity"'
    fixed = apply_edits(problem.edits, model.read_text())
    assert fixed == _controlled(both, both, both)


INTERFACES = '<command_interface name="position"/><state_interface name="position"/>'


@pytest.mark.parametrize(("sides", "found"), [("LR", 0), ("L", 2)])
def test_controllers_of_one_robot_are_not_for_a_model_with_two(
    package: Path, sides: str, found: int
) -> None:
    joints = "".join(
        f'<joint name="{side}_{name}">{INTERFACES}</joint>'
        for side in sides
        for name in ("shoulder", "elbow")
    )
    arms = f'<ros2_control name="arms" type="system">{joints}</ros2_control></robot>'
    (package / "r.urdf").write_text(MODEL.replace("</robot>", arms))
    mine = YAML.replace("      - arm_joint", "      - shoulder\n      - elbow")
    (package / "control.yaml").write_text(mine)
    codes = [problem.code for problem in check(package / "r.urdf")]
    assert codes.count("control-interface") == found


@pytest.mark.parametrize(("joint", "found"), [("lift", 0), ("arms_joint", 1)])
def test_controllers_may_be_for_another_robot_of_the_package(
    package: Path, joint: str, found: int
) -> None:
    wrong = YAML.replace("- arm_joint", f"- {joint}")
    (package / "control.yaml").rename(package / "truck_control.yaml")
    (package / "truck_control.yaml").write_text(wrong)
    codes = [p.code for p in check(package / "r.urdf")]
    assert codes.count("control-interface") == 1
    (package / "truck.urdf").write_text(MODEL.replace('"r"', '"truck"'))
    codes = [p.code for p in check(package / "r.urdf")]
    assert codes.count("control-interface") == found


def test_a_word_that_launch_replaces_is_not_judged(package: Path) -> None:
    yaml = YAML.replace("- arm_joint", "- <robot_namespace>arm_joint")
    (package / "control.yaml").write_text(yaml)
    assert CODES.isdisjoint(problem.code for problem in check(package / "r.urdf"))

"""What was copied, moved or left out in one of two parts that should be alike."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits
from sambot_viz.errors import Problem

HEAD = """<robot name="r"><link name="base_link"><visual><geometry>
<box size="0.4 0.3 0.1"/></geometry></visual></link>
"""
PART = """<link name="{0}"><visual><geometry><box size="0.1 0.02 0.02"/></geometry>
</visual></link>
<joint name="{0}_joint" type="{1}"><parent link="base_link"/><child link="{0}"/>
<origin xyz="0.2 {2} 0"/><axis xyz="{3}"/>
<limit lower="0" upper="0.5" effort="1" velocity="1"/></joint>
"""
CAMERA = PART.format("camera", "fixed", "0", "0 0 1")
SENSOR = """<gazebo reference="camera">
<sensor name="eye" type="{}">
{}</sensor>
{}</gazebo>
"""
CLASSIC = '<plugin name="c" filename="libgazebo_ros_camera.so"/>\n'
FRAME = "<gz_frame_id>camera</gz_frame_id>\n"
STATES = """<gazebo><plugin name="s" filename="libgazebo_ros_joint_state_publisher.so">
<joint_name>{}</joint_name>
<joint_name>{}</joint_name>
</plugin></gazebo>
"""
CONTROL = """<ros2_control name="all" type="system"><hardware>
<plugin>mock_components/GenericSystem</plugin></hardware>
<joint name="left_joint"><command_interface name="position"/>
<state_interface name="position"/></joint>
<joint name="right_joint"><command_interface name="position"/>
{}</joint></ros2_control>
"""
STATE = '<state_interface name="position"/>'
FULL = CONTROL.format("").replace('right_joint">', f'right_joint">{STATE}')
TRANSMISSION = """<transmission><plugin>t/Simple</plugin>
<joint name="{}" role="r"/></transmission>
"""
DRIVE = """<gazebo><plugin filename="libgazebo_ros_diff_drive.so"
name="d"/>
</gazebo>"""
PLUGIN = """<gazebo><plugin name="p" filename="libgazebo_ros_p3d.so">
<body_name>{}</body_name><ros><remapping>{}</remapping></ros></plugin></gazebo>"""


def transmissions(second: str) -> str:
    inner = TRANSMISSION.format("left_joint") + TRANSMISSION.format(second)
    return FULL.replace("</ros2_control>", f"{inner}</ros2_control>")


def hardware(second: str) -> str:
    inner = "".join(
        f'<param name="wheel_{number}">{name}</param>'
        for number, name in enumerate(("left_joint", second))
    )
    return FULL.replace("</hardware>", f"{inner}</hardware>")


def sides(y: str = "-0.1", axis: str = "0 0 1", kind: str = "revolute") -> str:
    left = PART.format("left", kind, "0.1", "0 0 1")
    return left + PART.format("right", kind, y, axis)


def found(tmp_path: Path, text: str, code: str) -> tuple[list[Problem], Path]:
    model = tmp_path / "r.urdf"
    model.write_text(f"{HEAD}{text}</robot>\n")
    return [p for p in check(model) if p.code == code], model


@pytest.mark.parametrize(
    ("wrong", "right", "code"),
    [
        (
            CAMERA + SENSOR.format("camera", "", CLASSIC),
            CAMERA + SENSOR.format("camera", CLASSIC, ""),
            "gazebo-plugin",
        ),
        (
            CAMERA + SENSOR.format("rgbd_camera", "", FRAME),
            CAMERA + SENSOR.format("rgbd_camera", FRAME, ""),
            "element-misplaced",
        ),
        (
            sides() + STATES.format("left_joint", "left_joint"),
            sides() + STATES.format("left_joint", "right_joint"),
            "gazebo-joint",
        ),
        (
            sides() + CONTROL.format(""),
            sides() + FULL,
            "control-interface",
        ),
        (
            sides() + transmissions("left_joint"),
            sides() + transmissions("right_joint"),
            "control-interface",
        ),
        (
            sides() + hardware("left_joint"),
            sides() + hardware("right_joint"),
            "control-interface",
        ),
        (
            sides() + FULL + '<ros2_control name="all" type="system"/>',
            sides() + FULL + '<ros2_control name="all2" type="system"/>',
            "control-interface",
        ),
        (
            CAMERA + DRIVE.replace("<gazebo>", '<gazebo reference="camera">'),
            CAMERA + DRIVE,
            "gazebo-plugin",
        ),
        (
            CAMERA + PLUGIN.format("camera_link", "odom:=truth"),
            CAMERA + PLUGIN.format("camera", "odom:=truth"),
            "gazebo-plugin",
        ),
        (
            CAMERA + PLUGIN.format("camera", "odom=truth"),
            CAMERA + PLUGIN.format("camera", "odom:=truth"),
            "gazebo-plugin",
        ),
    ],
    ids=(
        "plugin of a sensor,frame of a sensor,joint twice,no state,transmission,"
        "hardware,two systems,plugin of a model,link of a plugin,remapping"
    ).split(","),
)
def test_it_is_moved_or_written_where_it_belongs(
    wrong: str, right: str, code: str, tmp_path: Path
) -> None:
    problems, model = found(tmp_path, wrong, code)
    (problem,) = problems
    assert problem.severity == "warning"
    better = apply_edits(problem.edits, model.read_text())
    assert "".join(better.split()) == "".join(f"{HEAD}{right}</robot>".split())
    assert not found(tmp_path, right, code)[0]


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (("left_arm", "left_arm"), True),
        (("left_arm", "right_arm"), False),
        (("right_arm", "left_arm"), False),
        (("arm", "arm"), False),
    ],
)
def test_a_link_shows_its_own_mesh(
    tmp_path: Path, names: tuple[str, str], said: bool
) -> None:
    for name in ("left_arm", "right_arm", "arm"):
        (tmp_path / f"{name}.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    mesh = '<visual><geometry><mesh filename="{}.obj"/></geometry></visual>'
    text = sides()
    for number, name in enumerate(("left", "right")):
        link = f'<link name="{name}">'
        text = text.replace(link, link + mesh.format(names[number]))
    problems, model = found(tmp_path, text, "mesh-copied")
    assert len(problems) == said
    for problem in problems:
        right = f"{HEAD}{text}</robot>\n"[::-1]
        right = right.replace("left_arm.obj"[::-1], "right_arm.obj"[::-1], 1)[::-1]
        assert apply_edits(problem.edits, model.read_text()) == right


def test_the_call_of_a_macro_gets_the_other_side(tmp_path: Path) -> None:
    text = (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '<link name="base"/>\n<xacro:macro name="wheel" params="prefix y">\n'
        '<link name="${prefix}_link"><collision><geometry>'
        '<sphere radius="0.1"/></geometry></collision></link>\n'
        '<joint name="${prefix}_joint" type="continuous"><parent link="base"/>'
        '<child link="${prefix}_link"/><origin xyz="0 ${y * 0.2} 0"/>'
        '<axis xyz="0 1 0"/></joint>\n</xacro:macro>\n'
        '<xacro:wheel prefix="drive_l" y="1"/>\n'
        '<xacro:wheel prefix="drive_r" y="-1"/>\n</robot>'
    )
    file = tmp_path / "r.urdf.xacro"
    wrong = text.replace('y="-1"', 'y="1"')
    file.write_text(wrong, "utf-8")
    (problem,) = [p for p in check(file) if p.code == "wheels-in-one-place"]
    assert (problem.line, problem.hint) == (
        8,
        'write y="-1" in the call for drive_r_link',
    )
    assert apply_edits(problem.edits, wrong) == text


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (sides(), 0),
        (sides(y="0.1"), 1),
        (sides(y="0.1", kind="fixed"), 1),
        (sides(y="0.1", axis="0 0 -1"), 0),
        (sides(y="0.1").replace("right", "second"), 0),
    ],
    ids=["two sides", "one side", "fixed", "one against the other", "no sides"],
)
def test_parts_of_two_sides_are_not_in_one_place(
    text: str, expected: int, tmp_path: Path
) -> None:
    problems, _ = found(tmp_path, text, "wheels-in-one-place")
    assert len(problems) == expected


@pytest.mark.parametrize(
    "text",
    [
        CAMERA + SENSOR.format("camera", CLASSIC, ""),
        CAMERA + SENSOR.format("camera", "", "<turnGravityOff>true</turnGravityOff>"),
        sides() + CAMERA + STATES.format("left_joint", "camera_joint"),
        sides() + CONTROL.format("").replace(STATE, ""),
    ],
)
def test_what_is_right_is_left_alone(text: str, tmp_path: Path) -> None:
    codes = ("gazebo-plugin", "element-misplaced", "gazebo-joint", "control-interface")
    assert not [p for code in codes for p in found(tmp_path, text, code)[0]]

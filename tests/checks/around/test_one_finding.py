"""A mistake in a model is one finding, at its line, and its advice leaves nothing.

The mistakes are those that students make with the model of the Nav2 guide.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from sambot_viz.checks import check
from sambot_viz.errors import Problem
from sambot_viz.robot.packages.package_model import ModelWalk, models_in

SDF = Path(__file__).parents[2] / "data" / "around" / "cart.sdf"
MODELS = {"urdf": "urdf/cart.urdf.xacro", "sdf": "src/description/cart.sdf"}

Copied = Callable[[str], Path]


class Slip(NamedTuple):
    """A mistake in the model, and its remedy.

    Attributes:
        language: of the model.
        code: of the only finding.
        old: text of the model.
        new: what is written instead.
        line: part of the line of the finding.
        advice: what the finding says to do.
        better: what is then in place of `new`.
    """

    language: str
    code: str
    old: str
    new: str
    line: str
    advice: str
    better: str


def model_in(copied: Copied, language: str) -> Path:
    """The correct package with the model in one language."""
    folder = copied("gz")
    model = folder / MODELS[language]
    if language == "sdf":
        shutil.rmtree(folder / "urdf")
        model.parent.mkdir(parents=True)
        shutil.copy(SDF, model)
        edit(folder / "launch/display.launch.py", '"urdf"', '"src", "description"')
        edit(folder / "launch/display.launch.py", "cart.urdf.xacro", "cart.sdf")
        edit(folder / "CMakeLists.txt", "urdf", "src")
    return model


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def found(model: Path) -> list[Problem]:
    """What is wrong, without the notes that need nothing to be done."""
    return [p for p in check(model) if p.severity != "info"]


SLIPS = [
    Slip(
        "urdf",
        "number-malformed",
        '<mass value="0.5"/>',
        '<mass value="0,5"/>',
        '<mass value="0,5"/>',
        'write "0.5"',
        '<mass value="0.5"/>',
    ),
    Slip(
        "urdf",
        "number-malformed",
        'rpy="${pi/2} 0 0"',
        'rpy="${pi/2}"',
        'rpy="${pi/2}"',
        'write rpy="${pi/2} 0 0"',
        'rpy="${pi/2} 0 0"',
    ),
    Slip(
        "sdf",
        "rpy-in-degrees",
        '<pose relative_to="base_link">0 0 0.12 0 0 0</pose>',
        '<pose relative_to="base_link">0 0 0.12 0 0 180</pose>',
        "0 0 0.12 0 0 180",
        'write <pose relative_to="base_link" degrees="true">',
        '<pose relative_to="base_link" degrees="true">0 0 0.12 0 0 180</pose>',
    ),
    Slip(
        "urdf",
        "xacro-parameter-unknown",
        'name="wheel" params="prefix side"',
        'name="wheel"',
        '<xacro:macro name="wheel"',
        'add params="prefix side"',
        'name="wheel" params="prefix side"',
    ),
    Slip(
        "sdf",
        "xacro-parameter-unknown",
        '<xacro:wheel prefix="left_wheel"',
        '<xacro:wheel name="left_wheel"',
        '<xacro:wheel name="left_wheel"',
        'write prefix="left_wheel"',
        '<xacro:wheel prefix="left_wheel"',
    ),
    Slip(
        "urdf",
        "xacro-parameter-unknown",
        '  <link name="base_footprint"/>',
        '  <xacro:macro name="wheel" params="of"/>\n  <link name="base_footprint"/>',
        '<xacro:macro name="wheel" params="of"',
        "give one of the two another name",
        '  <xacro:macro name="other" params="of"/>\n  <xacro:other of="1"/>\n  '
        '<link name="base_footprint"/>',
    ),
    Slip(
        "urdf",
        "gazebo-joint",
        "<left_joint>left_wheel_joint<",
        "<left_joint>right_drive_joint<",
        "<left_joint>",
        "write left_wheel_joint",
        "<left_joint>left_wheel_joint<",
    ),
    Slip(
        "urdf",
        "gazebo-joint",
        "<right_joint>right_wheel_joint<",
        "<right_joint>base_joint<",
        "<right_joint>",
        "write right_wheel_joint",
        "<right_joint>right_wheel_joint<",
    ),
    Slip(
        "urdf",
        "drive-sides",
        "<right_joint>right_wheel_joint<",
        "<right_joint>left_wheel_joint<",
        "<right_joint>",
        "write right_wheel_joint",
        "<right_joint>right_wheel_joint<",
    ),
    Slip(
        "urdf",
        "drive-sides",
        "<left_joint>left_wheel_joint<",
        "<left_joint>right_wheel_joint<",
        "<left_joint>",
        "write left_wheel_joint",
        "<left_joint>left_wheel_joint<",
    ),
    Slip(
        "sdf",
        "gazebo-joint",
        "<left_joint>left_wheel_joint<",
        "<left_joint>right_drive_joint<",
        "<left_joint>",
        "write left_wheel_joint",
        "<left_joint>left_wheel_joint<",
    ),
    Slip(
        "sdf",
        "gazebo-joint",
        "<right_joint>right_wheel_joint<",
        "<right_joint>base_joint<",
        "<right_joint>",
        "write right_wheel_joint",
        "<right_joint>right_wheel_joint<",
    ),
    Slip(
        "sdf",
        "drive-sides",
        "<right_joint>right_wheel_joint<",
        "<right_joint>left_wheel_joint<",
        "<right_joint>",
        "write right_wheel_joint",
        "<right_joint>right_wheel_joint<",
    ),
    Slip(
        "sdf",
        "drive-sides",
        "<left_joint>left_wheel_joint<",
        "<left_joint>right_wheel_joint<",
        "<left_joint>",
        "write left_wheel_joint",
        "<left_joint>left_wheel_joint<",
    ),
    Slip(
        "urdf",
        "xacro-prefix-missing",
        '<xacro:wheel prefix="left_wheel"',
        '<wheel prefix="left_wheel"',
        "<wheel",
        "write <xacro:wheel>",
        '<xacro:wheel prefix="left_wheel"',
    ),
    Slip(
        "urdf",
        "gazebo-reference",
        '<gazebo reference="lidar_link"',
        '<gazebo reference="laser_link"',
        "<gazebo reference=",
        "write lidar_link",
        '<gazebo reference="lidar_link"',
    ),
    Slip(
        "urdf",
        "link-two-parents",
        '<child link="imu_link"/>',
        '<child link="lidar_link" />',
        '<child link="lidar_link" />',
        'write <child link="imu_link"/>',
        '<child link="imu_link"/>',
    ),
    Slip(
        "sdf",
        "link-two-parents",
        "<child>lidar_link</child>",
        "<child> imu_link</child>",
        "<child> imu_link</child>",
        "write <child>lidar_link</child> for lidar_joint",
        "<child>lidar_link</child>",
    ),
    Slip(
        "urdf",
        "joint-duplicate",
        '<joint name="${prefix}_joint" type="continuous"',
        '<joint name="drive_joint" type="continuous"',
        '<joint name="drive_joint"',
        'write name="${prefix}_joint"',
        '<joint name="${prefix}_joint" type="continuous"',
    ),
    Slip(
        "urdf",
        "link-duplicate",
        '<link name="${prefix}_link"',
        '<link name="{prefix}_link"',
        '<link name="{prefix}_link"',
        'write name="${prefix}_link"',
        '<link name="${prefix}_link"',
    ),
    Slip(
        "sdf",
        "sdf-name-taken",
        '<link name="${prefix}_link"',
        '<link name="drive_link"',
        '<link name="drive_link"',
        'write name="${prefix}_link"',
        '<link name="${prefix}_link"',
    ),
    Slip(
        "sdf",
        "sdf-frame-unknown",
        '<pose relative_to="${prefix}_joint"/>',
        '<pose relative_to="wheel_joint"/>',
        '<pose relative_to="wheel_joint"/>',
        "write ${prefix}_joint",
        '<pose relative_to="${prefix}_joint"/>',
    ),
    Slip(
        "urdf",
        "element-misplaced",
        '<link name="lidar_link"/>\n  <joint name="lidar_joint" type="fixed">\n    '
        '<parent link="base_link"/>\n    <child link="lidar_link"/>\n    '
        '<origin xyz="0 0 0.12"/>',
        '<link name="lidar_link"><origin xyz="0 0 0.12"/><visual><geometry><sphere '
        'radius="0.02"/></geometry></visual></link>\n  <joint name="lidar_joint" '
        'type="fixed">\n    <parent link="base_link"/>\n    '
        '<child link="lidar_link"/>',
        "<origin xyz",
        'move <origin> into <joint name="lidar_joint">',
        '<link name="lidar_link"><visual><geometry><sphere radius="0.02"/></geometry>'
        '</visual></link>\n  <joint name="lidar_joint" type="fixed">\n    '
        '<parent link="base_link"/>\n    <child link="lidar_link"/>\n    '
        '<origin xyz="0 0 0.12"/>',
    ),
    Slip(
        "urdf",
        "xacro-expression-value",
        '<xacro:wheel prefix="left_wheel" side="1"/>',
        '<xacro:property name="on_left" value="1m"/>\n  '
        '<xacro:wheel prefix="left_wheel" side="${on_left}"/>',
        "<xacro:property",
        'write value="1"',
        '<xacro:property name="on_left" value="1"/>\n  '
        '<xacro:wheel prefix="left_wheel" side="${on_left}"/>',
    ),
    Slip(
        "sdf",
        "xacro-expression-value",
        '<xacro:wheel prefix="left_wheel" side="1"/>',
        '<xacro:property name="on_left" value="1"/>\n    '
        '<xacro:wheel prefix="left_wheel" side="on_left"/>',
        "<xacro:wheel",
        'write side="${on_left}"',
        '<xacro:property name="on_left" value="1"/>\n    '
        '<xacro:wheel prefix="left_wheel" side="${on_left}"/>',
    ),
    Slip(
        "urdf",
        "gazebo-joint",
        '<joint name="${prefix}_joint" type="continuous"',
        '<joint name="${prefix}_joint" type="fixed"',
        "<left_joint>",
        'write type="continuous" for that joint',
        '<joint name="${prefix}_joint" type="continuous"',
    ),
    Slip(
        "sdf",
        "rpy-in-degrees",
        "<pose>0 0 0 ${pi/2} 0 0</pose>",
        "<pose>0 0 0 90 0 0</pose>",
        "<pose>0 0 0 90 0 0</pose>",
        'write <pose degrees="true">',
        '<pose degrees="true">0 0 0 90 0 0</pose>',
    ),
    Slip(
        "urdf",
        "rpy-in-degrees",
        '<origin rpy="${pi/2} 0 0"/>',
        '<origin rpy="90 0 0"/>',
        '<origin rpy="90 0 0"/>',
        'write rpy="1.5708 0 0"',
        '<origin rpy="1.5708 0 0"/>',
    ),
    Slip(
        "urdf",
        "limit-in-degrees",
        'type="continuous">',
        'type="revolute"><limit lower="-180" upper="180" effort="1" velocity="1"/>',
        "<limit",
        'write lower="-3.1416" upper="3.1416"',
        'type="revolute"><limit lower="-3.1416" upper="3.1416" effort="1" '
        'velocity="1"/>',
    ),
    Slip(
        "sdf",
        "sdf-urdf-habit",
        '<pose relative_to="${prefix}_joint"/>',
        '<pose relative_to="${prefix}_joint"/><inertial>\n'
        '<mass value="${0.5+side/1000}"/>'
        "<inertia><ixx>0.0013</ixx><iyy>0.0013</iyy><izz>0.0025</izz></inertia>"
        "</inertial>",
        "<mass value=",
        "write <mass>${0.5+side/1000}</mass>",
        '<pose relative_to="${prefix}_joint"/><inertial>\n'
        "<mass>${0.5+side/1000}</mass>"
        "<inertia><ixx>0.0013</ixx><iyy>0.0013</iyy><izz>0.0025</izz></inertia>"
        "</inertial>",
    ),
]


@pytest.mark.parametrize("slip", SLIPS, ids=lambda slip: f"{slip.code}: {slip.new}")
def test_a_mistake_is_one_finding_and_its_advice_leaves_nothing(
    slip: Slip, copied: Copied
) -> None:
    model = model_in(copied, slip.language)
    edit(model, slip.old, slip.new)
    (problem,) = found(model)

    assert problem.code == slip.code
    assert problem.line is not None
    assert slip.line in model.read_text().splitlines()[problem.line - 1]
    assert slip.advice in problem.hint
    edit(model, slip.new, slip.better)
    assert found(model) == []


@pytest.mark.parametrize("language", MODELS)
def test_a_correct_model_has_no_findings(language: str, copied: Copied) -> None:
    assert found(model_in(copied, language)) == []


def test_degrees_in_a_macro_are_told_once_and_their_pose_keeps_its_attributes(
    tmp_path: Path,
) -> None:
    model = tmp_path / "cart.sdf"
    shutil.copy(SDF, model)
    pose = '<pose relative_to="${prefix}_link">0 0 0 90 0 0</pose>'
    edit(model, "<pose>0 0 0 ${pi/2} 0 0</pose>", pose)
    (problem,) = found(model)

    assert problem.message.endswith("from the macro call on line 37")
    assert 'write degrees="true" into <pose>, beside relative_to' in problem.hint
    edit(model, '_link">0 0 0 90', '_link" degrees="true">0 0 0 90')
    assert found(model) == []


INERTIAL = """<inertial>
        <mass value="0.5"/>
        <inertia ixx="0.0013" ixy="0" ixz="0" iyy="0.0013" iyz="0" izz="0.0025"/>
      </inertial>"""


def test_a_macro_of_inertia_that_is_not_called_is_told_at_the_link_without_mass(
    copied: Copied,
) -> None:
    model = model_in(copied, "urdf")
    macro = f'<xacro:macro name="wheel_inertia" params="m">{INERTIAL}</xacro:macro>'
    edit(model, INERTIAL, '<xacro:wheel_inertia m="0.5"/>')
    edit(
        model, '  <xacro:macro name="wheel"', f'  {macro}\n  <xacro:macro name="wheel"'
    )
    lidar = (
        '<link name="lidar_link"><collision><geometry><sphere radius="0.05"/>'
        f"</geometry></collision>{INERTIAL}</link>"
    )
    edit(model, '<link name="lidar_link"/>', lidar)
    assert found(model) == []
    edit(model, '<xacro:wheel_inertia m="0.5"/>', "")
    (problem,) = found(model)

    assert problem.code == "inertia-missing"
    line = model.read_text().splitlines()[(problem.line or 0) - 1]
    assert '<link name="${prefix}_link">' in line
    assert problem.hint == 'add <xacro:wheel_inertia m="…"/>'
    assert "wheel_inertia (line 5) is never called" in problem.message


@pytest.mark.parametrize(
    ("language", "code", "bare", "shape", "right", "wrong"),
    [
        (
            "urdf",
            "joint-exchanged",
            '<link name="lidar_link"/>',
            '<link name="lidar_link"><visual><geometry><sphere radius="0.02"/>'
            "</geometry></visual></link>",
            '<parent link="base_link"/>\n    <child link="lidar_link"/>',
            '<parent link="lidar_link"/>\n    <child link="base_link"/>',
        ),
        (
            "sdf",
            "sdf-root-not-canonical",
            '<link name="lidar_link">',
            '<link name="lidar_link"><visual name="v"><geometry><sphere><radius>0.02'
            "</radius></sphere></geometry></visual>",
            "<parent>base_link</parent>\n      <child>lidar_link</child>",
            "<parent>lidar_link</parent>\n      <child>base_link</child>",
        ),
    ],
)
def test_exchanged_ends_of_a_joint_are_told_at_the_joint(
    language: str,
    code: str,
    bare: str,
    shape: str,
    right: str,
    wrong: str,
    copied: Copied,
) -> None:
    model = model_in(copied, language)
    edit(model, bare, shape)
    assert found(model) == []
    edit(model, right, wrong)
    (problem,) = found(model)

    assert problem.code == code
    line = model.read_text().splitlines()[(problem.line or 0) - 1]
    assert '<joint name="lidar_joint"' in line
    assert (
        problem.hint == f"write {' and '.join(p.strip() for p in right.splitlines())}"
    )
    edit(model, wrong, right)
    assert found(model) == []


@pytest.mark.parametrize(
    ("height", "code", "line"),
    [
        ("-0.15", "xacro-prefix-undeclared", 3),
        ("${-0.15}", "xml-prefix-undeclared", 2),
    ],
)
def test_a_urdf_without_the_declaration_of_xacro_is_one_finding(
    height: str, code: str, line: int, copied: Copied
) -> None:
    source = model_in(copied, "urdf")
    model = source.with_name("cart.urdf")
    source.rename(model)
    launch = source.parents[1] / "launch/display.launch.py"
    edit(launch, "cart.urdf.xacro", "cart.urdf")
    edit(model, ' xmlns:xacro="http://ros.org/wiki/xacro"', "")
    edit(model, "0 0 -0.15", f"0 0 {height}")
    (problem,) = found(model)

    assert (problem.code, problem.line) == (code, line)
    declared = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    assert problem.hint == f"add {declared} to <robot> on line 2"
    edit(model, "<robot ", f"<robot {declared} ")
    assert found(model) == []


def test_a_mesh_of_the_package_with_half_its_name_is_told_the_whole(
    copied: Copied,
) -> None:
    model = model_in(copied, "urdf")
    # Packages of other tests are no neighbours of it.
    (model.parents[2] / ".git").mkdir()
    mesh = model.parents[1] / "meshes/lidar.stl"
    mesh.parent.mkdir()
    mesh.write_text(
        "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0.1 0 0\n"
        "vertex 0 0.1 0\nendloop\nendfacet\nendsolid s\n"
    )
    edit(model.parents[1] / "CMakeLists.txt", "urdf", "urdf meshes")
    edit(
        model,
        '<link name="lidar_link"/>',
        '<link name="lidar_link"><visual><geometry>'
        '<mesh filename="package://cart/meshes/lidar.stl"/></geometry></visual></link>',
    )
    (problem,) = found(model)

    assert problem.code == "file-by-path-only"
    assert problem.hint == "write package://cart_description/meshes/lidar.stl"
    edit(model, "package://cart/", "package://cart_description/")
    assert found(model) == []


def test_the_folder_of_a_robot_inside_a_world_is_answered_with_what_to_delete(
    copied: Copied,
) -> None:
    model = model_in(copied, "sdf")
    edit(model, '<model name="cart"', '<world name="w"><model name="cart"')
    edit(model, "</model>", "</model></world>")
    folder = model.parents[2]
    (only,) = models_in(folder, ModelWalk())

    assert only == model
    (problem,) = found(only)
    assert problem.code == "sdf-world"
    edit(model, '<world name="w">', "")
    edit(model, "</world>", "")
    assert found(model) == []


def test_a_shape_without_mass_is_one_body_with_what_it_is_fixed_to(
    tmp_path: Path,
) -> None:
    shape = '<collision><geometry><sphere radius="0.05"/></geometry></collision>'
    joint = '<joint name="{0}" type="{1}"><parent link="{2}"/><child link="{3}"/>'
    links = f'<link name="f"/><link name="a">{INERTIAL}</link><link name="b">{shape}'
    model = tmp_path / "r.urdf"
    for kind, codes in (("fixed", []), ("continuous", ["inertia-missing"])):
        joints = (("i", "fixed", "f", "a"), ("j", kind, "a", "b"))
        tree = "</joint>".join(joint.format(*each) for each in joints)
        model.write_text(f'<robot name="r">{links}</link>{tree}</joint></robot>')
        assert [problem.code for problem in check(model)] == codes

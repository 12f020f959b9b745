"""Calls of macros whose values are exchanged, found in the source."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
WHEEL = """\
<link name="base"/>
<xacro:macro name="wheel" params="side y">
<link name="${side}_wheel"/>
<joint name="${side}_joint" type="fixed"><parent link="base"/>
<child link="${side}_wheel"/><origin xyz="0 ${y} 0"/></joint>
</xacro:macro>
<xacro:wheel side="left" y="0.1"/>
"""
BODY = """\
<xacro:property name="wheel_mass" value="1"/>
<xacro:property name="wheel_width" value="0.02"/>
<xacro:macro name="body" params="mass width">
<link name="base"><inertial><mass value="${mass}"/>
<inertia ixx="${width}" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
</xacro:macro>
"""


@pytest.mark.parametrize(
    ("text", "wrong", "right"),
    [
        (
            WHEEL,
            '<xacro:wheel side="-0.1" y="right"/>',
            '<xacro:wheel side="right" y="-0.1"/>',
        ),
        (
            WHEEL.replace("${y}", "${2*y}"),
            '<xacro:wheel side="${-0.1*2}" y="right"/>',
            '<xacro:wheel side="right" y="${-0.1*2}"/>',
        ),
        (
            BODY,
            '<xacro:body mass="${wheel_width}" width="${wheel_mass}"/>',
            '<xacro:body mass="${wheel_mass}" width="${wheel_width}"/>',
        ),
    ],
)
def test_the_call_is_named_and_its_edit_exchanges_the_values(
    text: str, wrong: str, right: str, tmp_path: Path
) -> None:
    model = tmp_path / "robot.urdf.xacro"
    model.write_text(f"{HEAD}{text}{wrong}\n</robot>\n")

    problems = [p for p in check(model) if p.severity != "info"]

    assert [p.code for p in problems] == ["xacro-arguments-exchanged"]
    assert problems[0].line == text.count("\n") + 2
    fixed = apply_edits(problems[0].edits, model.read_text())
    assert fixed == f"{HEAD}{text}{right}\n</robot>\n"


@pytest.mark.parametrize(
    "call",
    [
        '<xacro:wheel side="right" y="-0.1"/>',
        '<xacro:wheel side="2" y="${left}"/>',
    ],
)
def test_other_calls_are_left_alone(call: str, tmp_path: Path) -> None:
    model = tmp_path / "robot.urdf.xacro"
    left = '<xacro:property name="left" value="1"/>'
    model.write_text(f"{HEAD}{left}{WHEEL}{call}\n</robot>\n")

    assert not check(model)


def test_a_macro_may_name_the_sides_of_a_box_otherwise(tmp_path: Path) -> None:
    model = tmp_path / "robot.urdf.xacro"
    sizes = "".join(
        f'<xacro:property name="body_{name}" value="{value}"/>\n'
        for name, value in (("length", "0.4"), ("width", "0.2"))
    )
    macro = (
        '<xacro:macro name="box" params="width depth"><link name="base"><visual>'
        '<geometry><box size="${width} ${depth} 0.1"/></geometry></visual></link>'
        "</xacro:macro>\n"
    )
    call = '<xacro:box width="${body_length}" depth="${body_width}"/>\n'
    model.write_text(f"{HEAD}{sizes}{macro}{call}</robot>\n")
    assert "xacro-arguments-exchanged" not in {p.code for p in check(model)}

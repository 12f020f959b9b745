"""A finding in a macro is told, and mended, where its cause is."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits
from sambot_viz.errors import Problem

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
BASE = """<link name="base_link"><visual><geometry><box size="0.4 0.3 0.1"/></geometry>
</visual></link>
"""
WHEEL = """<xacro:macro name="wheel" params="prefix y:=0.1">
<link name="${prefix}_link"><visual><geometry><sphere radius="0.05"/></geometry>
</visual></link>
<joint name="${prefix}_joint" type="continuous"><parent link="base_link"/>
<child link="CHILD"/><origin xyz="0 ${y} 0"/><axis xyz="0 1 0"/></joint>
</xacro:macro>
"""
CALLS = """<xacro:wheel prefix="left"/>
<xacro:wheel prefix="right" y="-0.1"/>
"""
LASER = """<xacro:macro name="laser" params="end">
<link name="laser"/><joint name="laser_joint" type="fixed"><parent link="base_link"/>
<child link="laser"/></joint><gazebo reference="laser"><sensor name="s" type="ray">
<ray><scan><horizontal><samples>360</samples><min_angle>0</min_angle>
<max_angle>${end}</max_angle></horizontal></scan></ray></sensor></gazebo>
</xacro:macro>
"""


def found(tmp_path: Path, text: str, code: str) -> tuple[list[Problem], Path]:
    model = tmp_path / "r.urdf.xacro"
    model.write_text(f"{HEAD}{text}</robot>\n")
    return [p for p in check(model) if p.code == code], model


def mended(problem: Problem, model: Path) -> str:
    assert problem.edits
    return apply_edits(problem.edits, model.read_text())


@pytest.mark.parametrize("child", ["left_link", "right_link"])
def test_a_name_of_one_call_is_written_as_the_parameter(
    child: str, tmp_path: Path
) -> None:
    text = BASE + WHEEL.replace("CHILD", child) + CALLS
    problems, model = found(tmp_path, text, "link-two-parents")
    (problem,) = problems
    assert problem.hint == 'write <child link="${prefix}_link"/>'
    assert 'child link="${prefix}_link"' in mended(problem, model)


@pytest.mark.parametrize(
    ("macro", "call", "right"),
    [
        (LASER, '<xacro:laser end="360"/>', '<xacro:laser end="6.2832"/>'),
        (
            LASER,
            '<xacro:property name="e" value="360"/><xacro:laser end="${e}"/>',
            None,
        ),
        (LASER.replace("end", "end:=360", 1), "<xacro:laser/>", "end:=6.2832"),
        (
            LASER + '<xacro:macro name="both" params="to"><xacro:laser end="${to}"/>'
            "</xacro:macro>",
            '<xacro:both to="360"/>',
            '<xacro:both to="6.2832"/>',
        ),
        (
            LASER + '<!-- <xacro:laser end="1"/> -->',
            '<xacro:laser end="360"/>',
            '\n<xacro:laser end="6.2832"/>',
        ),
    ],
    ids=["literal", "property", "default", "two macros", "a call in a comment"],
)
def test_a_wrong_value_of_a_parameter_is_found_in_its_call(
    macro: str, call: str, right: str | None, tmp_path: Path
) -> None:
    text = f"{BASE}{macro}\n{call}\n"
    problems, model = found(tmp_path, text, "gazebo-sensor")
    (problem,) = problems
    lines = model.read_text().split("\n")
    line = lines[(problem.line or 0) - 1]
    assert "xacro:" in line and "360" in line
    if right is None:
        assert not problem.edits
    else:
        assert right in mended(problem, model)


def test_the_call_in_another_file_is_named_with_the_line_of_the_macro(
    tmp_path: Path,
) -> None:
    (tmp_path / "laser.xacro").write_text(f"{HEAD}{LASER}</robot>")
    text = BASE + '<xacro:include filename="laser.xacro"/>\n<xacro:laser end="360"/>\n'
    problems, model = found(tmp_path, text, "gazebo-sensor")
    (problem,) = problems
    assert problem.file == str(model)
    assert problem.message.endswith("in this call of laser (laser.xacro line 6)")


def test_of_two_calls_the_one_with_the_wrong_value_is_meant(tmp_path: Path) -> None:
    macro = LASER.replace('params="', 'params="name ').replace('"laser"', '"${name}"')
    macro = macro.replace('macro name="${name}"', 'macro name="laser"')
    macro = macro.replace("laser_joint", "${name}_joint")
    calls = (
        '<xacro:laser name="front" end="3"/>\n<xacro:laser name="back" end="360"/>\n'
    )
    problems, model = found(tmp_path, f"{BASE}{macro}{calls}", "gazebo-sensor")
    (problem,) = problems
    assert 'name="back" end="6.2832"' in mended(problem, model)


def test_an_edit_after_which_another_warning_comes_is_not_offered(
    tmp_path: Path,
) -> None:
    """The link of one wheel for both calls would be wrong for the other one."""
    text = BASE + WHEEL.replace("CHILD", "left_link").replace("_link", "_lnk", 1)
    problems, model = found(tmp_path, text + CALLS, "link-two-parents")
    for problem in problems:
        assert not problem.edits or "right_link" not in mended(problem, model)


def test_a_renamed_parameter_is_written_wherever_the_old_name_is(
    tmp_path: Path,
) -> None:
    text = BASE + WHEEL.replace("CHILD", "${prefix}_link") + CALLS
    wrong = text.replace('params="prefix', 'params="name').replace("wheel p", "wheel n")
    wrong = wrong.replace("nrefix", "name")
    problems, model = found(tmp_path, wrong, "xacro-undefined-name")
    (problem,) = problems
    assert problem.hint.startswith("write name for prefix at all 3 places")
    model.write_text(mended(problem, model))
    assert not [p for p in check(model) if p.severity == "error"]


def test_degrees_of_one_call_with_a_namespace_are_named_in_this_call(
    tmp_path: Path,
) -> None:
    part = """<xacro:macro name="eye" params="at rpy"><link name="${at}"/>
<joint name="${at}_joint" type="fixed"><parent link="base_link"/>
<child link="${at}"/><origin xyz="0 0 0.1" rpy="${rpy}"/></joint></xacro:macro>"""
    (tmp_path / "eye.xacro").write_text(f"{HEAD}{part}</robot>")
    calls = """<xacro:include filename="eye.xacro" ns="sensor"/>
<xacro:sensor.eye at="a" rpy="0.0 0.0 12.5"/>
<xacro:sensor.eye at="b" rpy="0 0 ${radians(30)}"/>
"""
    problems, model = found(tmp_path, BASE + calls, "rpy-in-degrees")
    (problem,) = problems
    assert problem.file == str(model)
    assert 'at="a" rpy="0 0 0.21817"' in mended(problem, model)
    assert (
        model.read_text()
        .splitlines()[problem.line - 1]
        .startswith('<xacro:sensor.eye at="a"')
    )

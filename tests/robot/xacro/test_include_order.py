"""Names of included files: used too early, or without the namespace of the include."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz import check
from sambot_viz.edits import apply_edits
from sambot_viz.errors import Problem

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
INCLUDE = '<xacro:include filename="part.xacro"/>'
IN_SPACE = '<xacro:include filename="part.xacro" ns="wheel"/>'
WHEELS = """<xacro:property name="radius" value="0.1"/>
<xacro:macro name="wheel" params="side"><link name="${side}_wheel"/></xacro:macro>
<xacro:macro name="caster" params="at"><link name="${at}_caster"/></xacro:macro>"""


def first(folder: Path, part: str, *lines: str) -> tuple[Problem, Path]:
    (folder / "part.xacro").write_text(f"{HEAD}{part}\n</robot>\n")
    model = folder / "r.urdf.xacro"
    model.write_text("\n".join([HEAD.strip(), *lines, "</robot>\n"]))
    return check(model)[0], model


@pytest.mark.parametrize(
    ("part", "lines", "code", "advice"),
    [
        (
            '<link name="$(arg b)"/>',
            [INCLUDE, '<xacro:arg name="b" default="base"/>'],
            "xacro-arg-after-use",
            "move the definition above the include on line 2 of ",
        ),
        (
            '<xacro:arg name="b" default="base"/>',
            ['<link name="$(arg b)"/>', INCLUDE],
            "xacro-arg-after-use",
            "move the include on line 3 above line 2",
        ),
        (
            '<xacro:property name="b" value="base"/>',
            ['<link name="${b}"/>', INCLUDE],
            "xacro-property-after-use",
            "move the include on line 3 above line 2",
        ),
        (
            '<xacro:macro name="m" params=""><link name="base"/></xacro:macro>',
            ["<xacro:m/>", INCLUDE],
            "xacro-macro-after-use",
            "move the include on line 3 above line 2",
        ),
    ],
)
def test_what_is_to_be_moved_is_in_the_file_that_has_both(
    part: str, lines: list[str], code: str, advice: str, tmp_path: Path
) -> None:
    problem, _ = first(tmp_path, part, *lines)

    assert problem.code == code
    assert problem.hint.startswith(advice)


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ('<xacro:wheel side="l"/>', '<xacro:wheel.wheel side="l"/>'),
        ('<xacro:caster at="l"/>', '<xacro:wheel.caster at="l"/>'),
        ('<xacro:wheel at="l"/>', '<xacro:wheel.caster at="l"/>'),
        ('<xacro:weel.wheel side="l"/>', '<xacro:wheel.wheel side="l"/>'),
        ('<link name="w${radius}"/>', '<link name="w${wheel.radius}"/>'),
    ],
)
def test_a_name_lacks_the_namespace_of_its_include(
    wrong: str, right: str, tmp_path: Path
) -> None:
    problem, model = first(tmp_path, WHEELS, IN_SPACE, wrong)

    assert problem.line == 3
    text = apply_edits(problem.edits, model.read_text())
    assert text.splitlines()[2] == right
    model.write_text(text)
    assert not [p for p in check(model) if p.code.startswith("xacro-")]


def test_an_argument_that_is_declared_in_no_way_to_its_use(tmp_path: Path) -> None:
    lines = ['<xacro:if value="false"><xacro:arg name="b" default="c"/></xacro:if>']
    problem, _ = first(tmp_path, "", *lines, '<link name="$(arg b)"/>')

    assert problem.code == "xacro-argument-missing"
    assert "move it before all macros and conditions" in problem.hint


@pytest.mark.parametrize(
    ("written", "advice"),
    [
        ("$(env SAMBOT_NOT_SET base)", "write $(optenv SAMBOT_NOT_SET base)"),
        ("$(find no_such_package a.xacro)", "write $(find no_such_package)/a.xacro"),
        ("$(find)", "add it: $(find NAME)"),
        (
            "$(arg b base)",
            'write $(arg b), and before it <xacro:arg name="b" default="base"/>',
        ),
        ("$(arg a)", "write ${a}"),
    ],
)
def test_a_substitution_with_other_words_than_it_takes(
    written: str, advice: str, tmp_path: Path
) -> None:
    lines = ['<xacro:property name="a" value="b"/>', f'<link name="{written}"/>']
    problem, _ = first(tmp_path, "", *lines)

    assert (problem.line, problem.hint) == (3, advice)


@pytest.mark.parametrize(
    ("others", "advice"),
    [
        ('<xacro:property name="pos_z" value="1"/>${pos_z}', 'write name="pos_y"'),
        ("", 'write name="pos_y" on line 2: wheel_y is used nowhere'),
    ],
)
def test_half_a_rename_is_a_property_that_nothing_uses(
    tmp_path: Path, others: str, advice: str
) -> None:
    used = '<link name="l${wheel_pos_y}"/><link name="r${wheel_pos_y}"/>'
    lines = ['<xacro:property name="wheel_y" value="1"/>', others, used]
    lines = [line.replace("pos_z", "wheel_pos_z") for line in lines]
    problem, model = first(tmp_path, "", *lines)
    assert advice.replace("pos_y", "wheel_pos_y") in problem.hint
    text = apply_edits(problem.edits, model.read_text())
    assert '<xacro:property name="wheel_pos_y" value="1"/>' in text


def test_a_command_in_braces_is_a_substitution(tmp_path: Path) -> None:
    lines = ['<xacro:arg name="b" default="base"/>', '<link name="${arg b}"/>']
    problem, model = first(tmp_path, "", *lines)
    assert (problem.code, problem.hint) == ("xacro-expression-syntax", "write $(arg b)")
    right = apply_edits(problem.edits, model.read_text())
    assert '<link name="$(arg b)"/>' in right
    model.write_text(right)
    assert check(model) == []


@pytest.mark.parametrize(
    ("name", "values", "right"),
    [
        ("at", ["${h}"], "${h}"),
        ("at", ["${h}", "${h}"], "${h}"),
        ("at", ["${h}", "${-h}"], "…"),
        ("at", ["1"], "…"),
        ("y", ["${h}"], "…"),
    ],
)
def test_a_missing_value_is_that_of_the_other_calls(
    tmp_path: Path, name: str, values: list[str], right: str
) -> None:
    macro = f'<xacro:macro name="part" params="on {name}"><link name="${{on}}"/>'
    calls = [f'<xacro:part on="l{n}" {name}="{v}"/>' for n, v in enumerate(values)]
    height = '<xacro:property name="h" value="1"/>'
    lines = [height, f"{macro}</xacro:macro>", *calls, '<xacro:part on="r"/>']
    problem, _ = first(tmp_path, "", *lines)
    assert problem.code == "xacro-parameter-missing"
    assert problem.hint.startswith(f'add {name}="{right}", or give a default')

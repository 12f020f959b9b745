"""What stops xacro carries the edit that repairs it."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
PROPERTY = '<xacro:property name="radius" value="0.2"/>\n'
BALL = (
    '<link name="a"><visual><geometry><sphere radius="{}"/></geometry></visual></link>'
)
MACRO = '<xacro:macro name="part" params="{}">\n{}\n</xacro:macro>\n'
NAMED = BALL.replace('"a"', '"${{name}}"')
SHIFTED = (
    MACRO.replace("{}\n</xacro", "{{}}\n</xacro").replace(
        "{{}}",
        '<link name="${{name}}"><visual><xacro:insert_block name="origin"/>'
        '<geometry><sphere radius="1"/></geometry></visual></link>',
    )
    + "{}"
)
BLOCK = '<xacro:part name="a"><origin xyz="0 0 0" rpy="0 0 0"/></xacro:part>'
INERTIA = (
    '<link name="a"><inertial><mass value="1"/><inertia ixx="${{0.4*0.5}}" ixy="0" '
    'ixz="0" iyy="{}" iyz="0" izz="0.2"/></inertial></link>'
)


def macro(params: str, radius: str, call: str) -> str:
    """A macro for a link, and its call."""
    return MACRO.format(params, NAMED.format(radius)) + f"<xacro:part {call}/>"


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        (
            macro("name", "${r}", 'name="a" r="1"'),
            macro("name r", "${r}", 'name="a" r="1"'),
        ),
        (
            macro("name r", "${R*R}", 'name="a" r="1"'),
            macro("name r", "${r*r}", 'name="a" r="1"'),
        ),
        (
            macro("name r", "${radius}", 'name="a" r="1"'),
            macro("name r", "${r}", 'name="a" r="1"'),
        ),
        (
            macro("name r", "${r}", 'nam="a" r="1"'),
            macro("name r", "${r}", 'name="a" r="1"'),
        ),
        (
            macro("name r", "r", 'name="a" r="1"'),
            macro("name r", "${r}", 'name="a" r="1"'),
        ),
        (
            '<xacro:property name="radius">0.2</xacro:property>\n'
            + BALL.format("${radius}"),
            PROPERTY + BALL.format("${radius}"),
        ),
        (PROPERTY + BALL.format("radius"), PROPERTY + BALL.format("${radius}")),
        (PROPERTY + BALL.format("${raduis}"), PROPERTY + BALL.format("${radius}")),
        (PROPERTY + BALL.format("${radius^2}"), PROPERTY + BALL.format("${radius**2}")),
        (PROPERTY + BALL.format("${2*radius"), PROPERTY + BALL.format("${2*radius}")),
        (
            PROPERTY + BALL.format("${2*(radius}"),
            PROPERTY + BALL.format("${2*(radius)}"),
        ),
        (PROPERTY + BALL.format("${2*radius)}"), PROPERTY + BALL.format("${2*radius}")),
        (PROPERTY + BALL.format("${2radius}"), PROPERTY + BALL.format("${2*radius}")),
        (BALL.format("${PI/2}"), BALL.format("${pi/2}")),
        (BALL.format("pi/10"), BALL.format("${pi/10}")),
        (
            PROPERTY + BALL.format("radius/2"),
            PROPERTY + BALL.format("${radius/2}"),
        ),
        (
            BALL.replace("<geometry>", '<origin rpy="pi 0 -pi/2"/><geometry>').format(
                1
            ),
            BALL.replace(
                "<geometry>", '<origin rpy="${{pi}} 0 ${{-pi/2}}"/><geometry>'
            ).format(1),
        ),
        (INERTIA.format("${ixx}"), INERTIA.format("${(0.4*0.5)}")),
        (
            '<xacro:arg name="r" default="1"/>\n' + BALL.format("${r}"),
            '<xacro:arg name="r" default="1"/>\n' + BALL.format("$(arg r)"),
        ),
        (
            '<xacro:arg name="r" default="1"/>\n<xacro:if value="(arg r)">\n'
            + BALL.format("1")
            + "</xacro:if>",
            '<xacro:arg name="r" default="1"/>\n<xacro:if value="$(arg r)">\n'
            + BALL.format("1")
            + "</xacro:if>",
        ),
        (
            macro("name", "1", 'name="a"').replace('"${name}"', '"$(name)"'),
            macro("name", "1", 'name="a"'),
        ),
        (
            macro("name", "1", 'name="a"').replace('"${name}"', '"${name_link}"'),
            macro("name", "1", 'name="a"').replace('"${name}"', '"${name}_link"'),
        ),
        (
            '<xacro:arg name="r" default="1"/>\n' + BALL.format("$(args r)"),
            '<xacro:arg name="r" default="1"/>\n' + BALL.format("$(arg r)"),
        ),
        (
            SHIFTED.format("name *origin", BLOCK).replace(
                'block name="origin"', 'block name="pose"'
            ),
            SHIFTED.format("name *origin", BLOCK),
        ),
        (
            SHIFTED.format("name origin", BLOCK),
            SHIFTED.format("name *origin", BLOCK),
        ),
        (
            SHIFTED.format("name *origin", '<xacro:part name="a"/>'),
            SHIFTED.format("name *origin", BLOCK),
        ),
        (
            MACRO.format("name", NAMED.format("1")) + '<xacro:prat name="a"/>',
            MACRO.format("name", NAMED.format("1")) + '<xacro:part name="a"/>',
        ),
    ],
)
def test_the_edit_of_what_stops_xacro_makes_the_file_right(
    wrong: str, right: str, tmp_path: Path
) -> None:
    model = tmp_path / "r.urdf.xacro"
    text = f"{HEAD}{wrong}\n</robot>\n"
    model.write_text(text, "utf-8")
    (problem,) = check(model)
    assert apply_edits(problem.edits, text) == f"{HEAD}{right}\n</robot>\n"
    model.write_text(f"{HEAD}{right}\n</robot>\n", "utf-8")
    assert check(model) == []


def test_a_package_that_is_named_without_a_dollar_is_found_in_its_line(
    tmp_path: Path,
) -> None:
    model = tmp_path / "r.urdf.xacro"
    text = f'{HEAD}<xacro:include filename="find arm)/urdf/arm.xacro"/>\n</robot>\n'
    model.write_text(text, "utf-8")
    (problem,) = check(model)
    assert (problem.code, problem.line) == ("xacro-substitution", 2)
    assert 'filename="$(find arm)/urdf/arm.xacro"' in apply_edits(problem.edits, text)


PILLAR = """\
<sdf version="1.8" xmlns:xacro="http://www.ros.org/wiki/xacro"><model name="m">
<xacro:macro name="pillar" params="n">
<link name="${{n}}_link"><pose relative_to="{joint}"/>
<visual name="v"><pose relative_to="{link}">0 0 1 0 0 0</pose>
<geometry><sphere><radius>1</radius></sphere></geometry></visual></link>
<joint name="${{n}}_joint" type="fixed"><parent>base</parent><child>${{n}}_link</child>
<pose relative_to="base"/></joint>
</xacro:macro>
<link name="base"/><xacro:pillar n="one"/><xacro:pillar n="two"/>
</model></sdf>
"""
NAMES = {"joint": "${n}_joint", "link": "${n}_link"}


@pytest.mark.parametrize("wrong", [{"joint": "{n}_joint"}, {"link": "link"}])
def test_a_frame_in_a_macro_is_written_with_its_parameter(
    wrong: dict[str, str], tmp_path: Path
) -> None:
    model = tmp_path / "model.sdf"
    model.write_text(PILLAR.format(**{**NAMES, **wrong}))

    (problem,) = (p for p in check(model) if p.severity == "error")

    assert apply_edits(problem.edits, model.read_text()) == PILLAR.format(**NAMES)


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        (
            macro("name r", "", 'name="a" r="1"').replace(' radius=""', ""),
            macro("name r", "${r}", 'name="a" r="1"'),
        ),
        (
            BALL.format("2").replace(
                "</link>",
                "<collision><geometry><sphere/></geometry></collision></link>",
            ),
            BALL.format("2").replace(
                "</link>",
                '<collision><geometry><sphere radius="2"/></geometry></collision>'
                "</link>",
            ),
        ),
    ],
)
def test_a_value_that_is_missing_is_the_one_that_nothing_else_uses(
    wrong: str, right: str, tmp_path: Path
) -> None:
    model = tmp_path / "robot.urdf.xacro"
    model.write_text(f"{HEAD}{wrong}</robot>")

    (problem,) = (p for p in check(model) if p.code == "attribute-missing")

    assert apply_edits(problem.edits, model.read_text()) == f"{HEAD}{right}</robot>"

"""Numbers with a unit are answered with what they are in metres, radians, kilograms."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz import check
from sambot_viz.errors import Problem

URDF = """<robot name="b">
<link name="base">
<inertial><mass value="1.5"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="0.4 0.3 0.2"/></geometry></visual>
<visual><geometry><sphere radius="0.05"/></geometry></visual>
</link>
<link name="arm"/>
<joint name="j" type="revolute"><parent link="base"/><child link="arm"/>
<origin xyz="0 0 0.12" rpy="1.5708 0 0"/><axis xyz="0 1 0"/>
<limit lower="-0.7854" upper="0.7854" effort="1" velocity="1"/></joint>
</robot>
"""
SDF = """<sdf version="1.8"><model name="b">
<link name="base">
<inertial><mass>1.5</mass>
<inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
<visual name="v"><geometry><box><size>0.4 0.3 0.2</size></box></geometry></visual>
<visual name="w"><geometry><sphere><radius>0.05</radius></sphere></geometry></visual>
</link>
<link name="arm"><pose relative_to="j"/></link>
<joint name="j" type="revolute"><parent>base</parent><child>arm</child>
<pose relative_to="base">0 0 0.12 1.5708 0 0</pose>
<axis><xyz>0 1 0</xyz>
<limit><lower>-0.7854</lower><upper>0.7854</upper></limit></axis>
</joint>
</model></sdf>
"""


def serious(folder: Path, name: str, text: str) -> list[Problem]:
    model = folder / name
    model.write_text(text)
    return [problem for problem in check(model) if problem.severity != "info"]


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("0 0 0.12", "0 0 12cm"),
        ("0 0 0.12", "0 0 120mm"),
        ("0 0 0.12", "0 0 12 cm"),
        ("0 0 0.12", "0, 0, 12cm"),
        ("0 0 0.12", "0m 0m 0.12m"),
        ("0 0 0.12", "0;0;0.12"),
        ("1.5708 0 0", "90deg 0 0"),
        ("1.5708 0 0", "90° 0 0"),
        ("1.5708 0 0", "1.5708rad 0 0"),
        ("-0.7854", "-45deg"),
        ("0.4 0.3 0.2", "40cm 30cm 20cm"),
        ("0.4 0.3 0.2", "40 30 20 cm"),
        ("0.4 0.3 0.2", "400, 300, 200 mm"),
        ("0.05", "5cm"),
        ("0.05", "5 CM"),
        ("0.05", "0,05m"),
        ("0.05", "0,05"),
        ("0.0508", "2in"),
        ("1.5", "1.5kg"),
        ("1.5", "1500 g"),
    ],
)
def test_urdf_says_the_number_in_its_own_unit(
    tmp_path: Path, right: str, wrong: str
) -> None:
    good = URDF.replace('"0.05"', f'"{right}"' if right == "0.0508" else '"0.05"')

    (problem,) = serious(tmp_path, "b.urdf", good.replace(f'"{right}"', f'"{wrong}"'))

    assert problem.hint == f'write "{right}"'
    assert serious(tmp_path, "b.urdf", good) == []


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("0 0 0.12 1.5708 0 0", "0 0 12cm 1.5708 0 0"),
        ("0 0 0.12 1.5708 0 0", "0 0 12 cm 1.5708 0 0"),
        ("0 0 0.12 1.5708 0 0", "0 0 0.12 90deg 0 0"),
        ("0 0 0.12 1.5708 0 0", "0 0 0.12 90 0 0 deg"),
        ("0 0 0.12 1.5708 0 0", "0 0 120mm 90° 0 0"),
        ("0 0 0.12 1.5708 0 0", "0;0;0.12;1.5708;0;0"),
        ("0 0 0.12 1.5708 0 0", "0,0,12cm,1.5708,0,0"),
        ("0.4 0.3 0.2", "40cm 30cm 20cm"),
        ("0.4 0.3 0.2", "40, 30, 20 cm"),
        ("0.4 0.3 0.2", "0.4 0.3 0.2m"),
        ("0.4 0.3 0.2", "400 300 200 mm"),
        ("0.4 0.3 0.2", "0.4 0.3 0.2 0.1"),
        ("0.05", "5cm"),
        ("0.05", "5 cm"),
        ("1.5", "1.5kg"),
        ("1.5", "1500g"),
    ],
)
def test_sdf_says_the_number_in_its_own_unit(
    tmp_path: Path, right: str, wrong: str
) -> None:
    found = serious(tmp_path, "b.sdf", SDF.replace(f">{right}<", f">{wrong}<"))

    # A size in millimetres that counts is larger than a house, too.
    (problem,) = [problem for problem in found if problem.code != "shape-size"]
    assert problem.hint == f"write {right}"
    assert serious(tmp_path, "b.sdf", SDF) == []


def test_degrees_stay_degrees_where_sdf_has_them(tmp_path: Path) -> None:
    pose = '<pose degrees="true" relative_to="base">0 0 12cm 90deg 0 0</pose>'
    right = '<pose relative_to="base">0 0 0.12 1.5708 0 0</pose>'

    (problem,) = serious(tmp_path, "b.sdf", SDF.replace(right, pose))

    assert problem.hint == "write 0 0 0.12 90 0 0"


@pytest.mark.parametrize("number", ["5ft", "5 parsec"])
def test_an_unknown_unit_is_not_guessed(tmp_path: Path, number: str) -> None:
    (problem,) = serious(tmp_path, "b.urdf", URDF.replace("0.05", number))

    assert problem.hint in ("write the bare number", "write a number such as 0.1")


@pytest.mark.parametrize("used", ["0 0 ${h}", "0 0 ${h/1}"])
@pytest.mark.parametrize("value", ["12cm", "12 cm", "120mm", "0,12m"])
def test_a_value_of_xacro_is_converted_where_it_is_given(
    tmp_path: Path, used: str, value: str
) -> None:
    text = URDF.replace("0 0 0.12", used).replace(
        '<robot name="b">',
        '<robot name="b" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        f'<xacro:property name="h" value="{value}"/>',
    )

    (problem,) = serious(tmp_path, "b.urdf.xacro", text)

    assert (problem.line, problem.hint) == (2, 'write value="0.12"')

"""Lengths in millimetres or centimetres are found, and what follows is kept back."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.errors import Problem

AROUND = Path(__file__).parents[1] / "data" / "around"
MODEL = "urdf/cart.urdf.xacro"

CART = """<robot name="cart">
<link name="base_link">
<collision><geometry><box size="{0} {1} {2}"/></geometry></collision>
</link>
<link name="base_footprint"/>
<joint name="base_joint" type="fixed"><parent link="base_link"/>
<child link="base_footprint"/>
<origin xyz="0 0 {3}"/></joint>
<link name="wheel">
<collision><origin rpy="1.5708 0 0"/>
<geometry><cylinder radius="{4}" length="{5}"/></geometry></collision>
</link>
<joint name="wheel_joint" type="continuous"><parent link="base_link"/>
<child link="wheel"/><axis xyz="0 1 0"/>
<origin xyz="{6} {7} {8}"/></joint>
<link name="caster">
<collision><geometry><sphere radius="{9}"/></geometry></collision>
</link>
<joint name="caster_joint" type="fixed"><parent link="base_link"/>
<child link="caster"/>
<origin xyz="{10} 0 {11}"/></joint>
</robot>
"""
METRES = (0.42, 0.31, 0.18, -0.15, 0.1, 0.04, -0.12, 0.18, -0.05, 0.05, 0.14, -0.1)
SIZES = {0, 1, 2, 4, 5, 9}
NUMBER = re.compile(r"-?\d[\d.]*")


def cart(factor: float, only: set[int] | None = None) -> str:
    return CART.format(
        *(
            f"{value * (factor if only is None or at in only else 1):g}"
            for at, value in enumerate(METRES)
        )
    )


def applied(text: str, problems: list[Problem]) -> str:
    """Return a model after everything that was advised."""
    lines = text.splitlines()
    for problem in problems:
        assert problem.line
        if said := re.fullmatch(r"write metres: (.*)", problem.hint):
            lines[problem.line - 1] = written(lines[problem.line - 1], said[1].split())
            continue
        said = re.fullmatch(
            r"divide x, y and z of every <origin> by (\d+)", problem.hint
        )
        assert said
        lines = [divided(line, float(said[1])) for line in lines]
    return "\n".join(lines) + "\n"


def written(line: str, numbers: list[str]) -> str:
    """Put numbers into attributes that are numbers."""
    better = iter(numbers)
    return re.sub(
        r'(?<=")[\d. ]+(?=")',
        lambda old: " ".join(next(better) for _ in old[0].split()),
        line,
    )


def divided(line: str, by: float) -> str:
    return re.sub(
        r'xyz="[^"]*"(?=/></joint>)',
        lambda xyz: NUMBER.sub(lambda n: f"{float(n[0]) / by:g}", xyz[0]),
        line,
    )


def found(tmp_path: Path, text: str) -> list[Problem]:
    file = tmp_path / "cart.urdf"
    file.write_text(text)
    return [p for p in check(file) if p.severity != "info"]


@pytest.mark.parametrize("only", [None, SIZES], ids=["all", "sizes"])
@pytest.mark.parametrize(
    ("factor", "unit"), [(100, "centimetres"), (1000, "millimetres")]
)
def test_lengths_in_another_unit_are_found_and_what_is_advised_is_right(
    tmp_path: Path, factor: float, unit: str, only: set[int] | None
) -> None:
    wrong = cart(factor, only)

    problems = found(tmp_path, wrong)

    assert {problem.code for problem in problems} == {"shape-size"}
    assert all(f"probably given in {unit}" in p.message for p in problems)
    assert applied(wrong, problems) == cart(1)
    assert found(tmp_path, cart(1)) == []


def test_one_size_in_centimetres_among_others_in_metres(tmp_path: Path) -> None:
    (problem,) = found(tmp_path, cart(100, {0, 1, 2}))

    assert problem.hint == "write metres: 0.42 0.31 0.18"


def test_a_mast_beside_a_box_in_millimetres_is_in_metres(tmp_path: Path) -> None:
    mast = '<link name="caster">\n<visual><geometry><box size="0.02 0.02 1.5"/>'
    text = cart(1000, {0, 1, 2}).replace(
        '<link name="caster">', f"{mast}</geometry></visual>"
    )

    (problem,) = found(tmp_path, text)

    assert problem.hint == "write metres: 0.42 0.31 0.18"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    return shutil.copytree(AROUND / "gz", tmp_path / "cart_description")


@pytest.mark.parametrize(
    ("value", "wrong"),
    [("0.42 0.31 0.18", "42 31 18"), ("0.42 0.31 0.18", "40 30 20")],
)
def test_nothing_around_the_model_is_to_be_made_as_large(
    package: Path, value: str, wrong: str
) -> None:
    model = package / MODEL
    right = model.read_text()
    assert value in right
    wheel = right.replace('"${wheel_radius}" length="0.04"', '"10" length="4"')
    assert wheel != right
    model.write_text(wheel.replace(value, wrong))

    problems = check(model)

    assert {problem.code for problem in problems} == {"shape-size"}


def test_a_footprint_that_is_wrong_anyway_waits_until_the_size_is_right(
    package: Path,
) -> None:
    model, nav2 = package / MODEL, package / "config/nav2_params.yaml"
    nav2.write_text(nav2.read_text().replace("robot_radius: 0.3", "robot_radius: 0.1"))
    (right,) = check(model)
    model.write_text(model.read_text().replace("0.42 0.31 0.18", "42 31 18"))

    (first,) = check(model)

    assert (first.code, first.hint) == ("shape-size", "write metres: 0.42 0.31 0.18")
    model.write_text(model.read_text().replace("42 31 18", "0.42 0.31 0.18"))
    assert check(model) == [right]


def test_one_property_in_another_unit_is_named_and_nothing_that_rests_on_it(
    package: Path,
) -> None:
    model = package / MODEL
    right = model.read_text()
    model.write_text(
        right.replace('"wheel_radius" value="0.10"', '"wheel_radius" value="10"')
    )

    (problem,) = check(model)

    assert (problem.line, problem.hint) == (3, 'write metres: value="0.1"')
    assert "the property wheel_radius is 10 m" in problem.message
    assert "given in centimetres" in problem.message


LIDAR = """<link name="lidar"><visual><geometry>
<cylinder radius="{}" length="{}"/></geometry></visual></link>
<joint name="lidar_joint" type="fixed"><parent link="base_link"/>
<child link="lidar"/><origin xyz="0 0 {}"/></joint>
</robot>"""


@pytest.mark.parametrize(
    ("wrong", "hint"),
    [
        (("0.0508", "0.055", "12"), "0 0 0.12 in xyz"),
        (("0.0508", "0.055", "120"), "0 0 0.12 in xyz"),
        (("50.8", "55", "0.12"), "0.0508 0.055"),
    ],
)
def test_one_part_in_another_unit_is_found_beside_parts_in_metres(
    tmp_path: Path, wrong: tuple[str, str, str], hint: str
) -> None:
    text = cart(1).replace("</robot>", LIDAR.format(*wrong))

    (problem,) = found(tmp_path, text)

    assert problem.hint == f"write metres: {hint}"


def test_a_ground_below_a_robot_may_be_large(tmp_path: Path) -> None:
    ground = '<link name="caster">\n<visual><geometry><box size="5 5 {}"/>'
    ground += "</geometry></visual>"
    text = cart(1).replace('<link name="caster">', ground)
    assert found(tmp_path, text.format(0.001)) == []
    assert found(tmp_path, text.format(0.3)) != []


def test_a_property_that_may_be_in_two_units_has_no_edit(tmp_path: Path) -> None:
    text = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="width" value="{}"/>
  <link name="a"><visual><geometry><box size="0.4 0.3 0.02"/></geometry></visual>
    <visual><geometry><box size="0.05 0.1 0.06"/></geometry></visual></link>
  <link name="b"><visual><geometry><cylinder radius="0.03" length="${{width}}"/>
    </geometry></visual></link>
  <joint name="j" type="fixed"><parent link="a"/><child link="b"/>
    <origin xyz="0.1 0 0"/></joint>
</robot>"""
    model = tmp_path / "r.urdf.xacro"
    for value, number_of_edits in (("26", 0), ("250", 1)):
        model.write_text(text.format(value))
        (problem,) = (p for p in check(model) if p.code == "shape-size")
        assert len(problem.edits) == number_of_edits, problem

"""Wheels that do not drive the robot as is meant; each advice is followed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits
from sambot_viz.errors import Problem

Copied = Callable[[str], Path]

ORIGIN = '<origin xyz="-0.12 ${side * 0.18} -0.05"/>'
AXIS = '<axis xyz="0 1 0"/>'


@pytest.fixture
def model(copied: Copied) -> Path:
    return copied("gz") / "urdf" / "cart.urdf.xacro"


def edited(file: Path, old: str, new: str) -> list[Problem]:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))
    return [problem for problem in check(file) if problem.severity != "info"]


def test_wheels_that_both_turn_backwards_are_given_the_other_axis(model: Path) -> None:
    (problem,) = edited(model, AXIS, '<axis xyz="0 -1 0"/>')

    assert problem.code == "drive-sides"
    assert "moves the robot backwards" in problem.message
    assert problem.hint == f"write {AXIS} for left_wheel_joint and right_wheel_joint"
    assert edited(model, '<axis xyz="0 -1 0"/>', AXIS) == []


def test_driven_wheels_without_a_collision_get_that_of_their_visual(
    model: Path,
) -> None:
    wheel = model.read_text().partition("</collision>")[0] + "</collision>"
    shape = wheel[wheel.index("<collision>") :]
    visual = shape.replace("collision>", "visual>")
    assert edited(model, shape, f"{visual}\n      {shape}") == []

    (problem,) = edited(model, f"\n      {shape}", "")

    assert problem.code == "wheel-not-on-ground"
    assert "left_wheel_link and right_wheel_link have no" in problem.message
    model.write_text(apply_edits(problem.edits, model.read_text()))
    assert f"{visual}\n      {shape}" in model.read_text()


def test_a_wheel_that_turns_against_the_other_one_is_named(model: Path) -> None:
    (problem,) = edited(model, AXIS, '<axis xyz="0 ${side} 0"/>')

    assert "right_wheel_joint turns about -y" in problem.message
    assert "turns the robot where straight on is meant" in problem.message
    assert problem.hint == f"write {AXIS}"


def test_wheels_of_which_one_is_in_front_are_not_on_one_axle(model: Path) -> None:
    wrong = ORIGIN.replace("-0.12", "${-0.12 * side}")

    (problem,) = edited(model, ORIGIN, wrong)

    assert "x = -0.12 m and 0.12 m" in problem.message
    assert problem.hint == "give right_wheel_joint the x of the other wheel, -0.12"
    assert edited(model, wrong, ORIGIN) == []


def test_a_driven_wheel_that_others_mimic_has_several_axles(model: Path) -> None:
    edited(model, ORIGIN, ORIGIN.replace("-0.12", "${-0.12 * side}"))
    follower = """<link name="second"/>
  <joint name="second_joint" type="continuous">
    <parent link="base_link"/><child link="second"/><axis xyz="0 1 0"/>
    <mimic joint="left_wheel_joint"/>
  </joint>
</robot>"""

    found = edited(model, "</robot>", follower)

    assert "drive-sides" not in {problem.code for problem in found}


def test_a_macro_that_forgets_the_side_puts_both_wheels_in_one_place(
    model: Path,
) -> None:
    wrong = ORIGIN.replace("side * ", "")

    (problem,) = edited(model, ORIGIN, wrong)

    assert problem.code == "wheels-in-one-place"
    assert "in the same place of base_link, at -0.12 0.18 -0.05" in problem.message
    assert "-0.12 -0.18 -0.05 in its <origin>" in problem.hint
    assert edited(model, wrong, ORIGIN) == []


def test_a_wheel_of_another_name_whose_axis_is_upright_is_found_too(
    model: Path,
) -> None:
    assert edited(model, "_wheel", "_whl") == []

    (problem,) = edited(model, AXIS, '<axis xyz="0 0 1"/>')

    assert (problem.code, problem.hint) == (
        "wheel-across-axle",
        f"write {AXIS}",
    )


def test_a_footprint_waits_until_the_wheels_no_longer_lie_flat(model: Path) -> None:
    nav2 = model.parents[1] / "config" / "nav2_params.yaml"
    nav2.write_text(nav2.read_text().replace("robot_radius: 0.3", "robot_radius: 0.27"))
    upright = '<origin rpy="${pi/2} 0 0"/>'
    assert edited(model, upright, upright) == []

    problems = edited(model, upright, "")

    assert [problem.code for problem in problems] == ["wheel-across-axle"]
    model.write_text(apply_edits(problems[0].edits, model.read_text()))
    assert check(model) == []


def test_the_width_of_the_body_is_not_the_separation_of_the_wheels(
    model: Path,
) -> None:
    sizes = "<wheel_separation>{}</wheel_separation>"
    assert edited(model, sizes.format("0.4"), sizes.format("0.34")) == []
    assert edited(model, ORIGIN, ORIGIN.replace("0.18", "0.165")) == []

    (problem,) = edited(model, sizes.format("0.34"), sizes.format("0.31"))

    assert problem.code == "drive-wheel-separation"
    assert problem.hint == "write 0.33"


def test_wheels_within_the_body_are_moved_to_where_the_drive_has_them(
    model: Path,
) -> None:
    (problem,) = edited(model, ORIGIN, ORIGIN.replace("0.18", "0.13"))

    assert problem.code == "drive-wheel-separation"
    assert "0.26 m apart, inside of the body, which is 0.31 m wide" in problem.message
    assert problem.hint == "write 0.2 and its negative for y in their <origin>"

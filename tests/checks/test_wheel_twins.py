"""A wheel that differs from its twin in one thing, and joints the wrong way round."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

WHEEL = (
    '<link name="{0}_wheel"><visual><geometry>\n'
    '<cylinder radius="0.1" length="0.04"/>\n'
    "</geometry></visual></link>\n"
    '<joint name="{0}_wheel_joint" type="continuous">\n'
    '<parent link="base_link"/>\n<child link="{0}_wheel"/>\n'
    '<origin xyz="0.05 {1} 0.02" rpy="-1.5708 0 0"/>\n<axis xyz="0 0 1"/>\n</joint>\n'
)
BASE = (
    '<link name="base_link"><visual><geometry>\n<box size="0.4 0.3 0.1"/>\n'
    "</geometry></visual></link>\n"
)
CAMERA = (
    '<link name="camera_link"><visual><geometry>\n<box size="0.1 0.1 0.1"/>\n'
    '</geometry></visual></link>\n<link name="lens"/>\n'
    '<joint name="camera_joint" type="fixed">\n'
    '<parent link="base_link"/>\n<child link="camera_link"/>\n</joint>\n'
    '<joint name="lens_joint" type="fixed">\n'
    '<parent link="camera_link"/>\n<child link="lens"/>\n</joint>\n'
)
LEFT, RIGHT = WHEEL.format("left", "0.2"), WHEEL.format("right", "-0.2")
RIGHT_MODEL = f'<robot name="r">\n{BASE}{LEFT}{RIGHT}{CAMERA}</robot>\n'


def mended(tmp_path: Path, text: str, code: str) -> str:
    """Check a model, and return what the edits of its only finding make of it."""
    model = tmp_path / "r.urdf"
    model.write_text(text)
    (problem,) = (p for p in check(model) if p.severity != "info" or code == p.code)
    assert problem.code == code
    return apply_edits(problem.edits, text)


def test_a_right_robot_has_no_finding(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf"
    model.write_text(RIGHT_MODEL)
    assert check(model) == []


@pytest.mark.parametrize("side", [LEFT, RIGHT])
@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ('type="continuous"', 'type="fixed"'),
        ('<axis xyz="0 0 1"/>', '<axis xyz="0 1 0"/>'),
    ],
)
def test_a_wheel_turns_as_its_twin(
    side: str, right: str, wrong: str, tmp_path: Path
) -> None:
    text = RIGHT_MODEL.replace(side, side.replace(right, wrong))

    assert mended(tmp_path, text, "wheel-unlike-twin") == RIGHT_MODEL


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("-0.2 0.02", "-0.2 0.2"),
        ("-0.2 0.02", "-0.02 0.02"),
        ("0.05 -0.2", "0.5 -0.2"),
        ('rpy="-1.5708 0 0"', 'rpy="0 -1.5708 0"'),
        ('radius="0.1"', 'radius="0.01"'),
    ],
)
def test_a_wheel_is_placed_and_made_as_its_twin(
    right: str, wrong: str, tmp_path: Path
) -> None:
    text = RIGHT_MODEL.replace(RIGHT, RIGHT.replace(right, wrong))

    assert mended(tmp_path, text, "wheel-unlike-twin") == RIGHT_MODEL


def test_axes_against_each_other_are_a_note(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf"
    wrong = RIGHT.replace('<axis xyz="0 0 1"/>', '<axis xyz="0 0 -1"/>')
    model.write_text(RIGHT_MODEL.replace(RIGHT, wrong))
    (problem,) = check(model)

    assert (problem.code, problem.severity) == ("wheel-unlike-twin", "info")


def test_a_wheel_on_the_side_of_its_twin_is_put_on_its_own(tmp_path: Path) -> None:
    text = RIGHT_MODEL.replace("-0.2 0.02", "0.2 0.02")

    assert mended(tmp_path, text, "wheels-in-one-place") == RIGHT_MODEL


def test_a_wheel_that_is_turned_round_on_the_side_of_its_twin_is_put_on_its_own(
    tmp_path: Path,
) -> None:
    right = RIGHT.replace('rpy="-1.5708', 'rpy="1.5708').replace("0 0 1", "0 0 -1")
    wrong = right.replace("-0.2 0.02", "0.2 0.02")
    text = RIGHT_MODEL.replace(RIGHT, wrong)

    assert mended(tmp_path, text, "wheels-in-one-place") == text.replace(wrong, right)


def test_a_wheel_without_limits_turns_without_end(tmp_path: Path) -> None:
    text = RIGHT_MODEL.replace(
        '"left_wheel_joint" type="continuous"', '"left_wheel_joint" type="revolute"'
    )

    assert mended(tmp_path, text, "limit-missing") == RIGHT_MODEL


@pytest.mark.parametrize(
    ("right", "wrong", "code"),
    [
        (
            '<parent link="base_link"/>\n<child link="left_wheel"/>',
            '<parent link="left_wheel"/>\n<child link="base_link"/>',
            "joint-exchanged",
        ),
        (
            '<parent link="camera_link"/>\n<child link="lens"/>',
            '<parent link="lens"/>\n<child link="camera_link"/>',
            "link-two-parents",
        ),
        ('<child link="lens"/>', '<child link="camera_link"/>', "joint-to-itself"),
        (
            '<child link="right_wheel"/>',
            '<child link="left_wheel"/>',
            "link-two-parents",
        ),
    ],
)
def test_the_ends_of_a_joint_are_exchanged_again(
    right: str, wrong: str, code: str, tmp_path: Path
) -> None:
    text = RIGHT_MODEL.replace(right, wrong)

    assert mended(tmp_path, text, code) == RIGHT_MODEL


MIRRORED = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:property name="half" value="0.1"/>
<link name="base_link"><visual><geometry><box size="0.4 0.2 0.1"/></geometry>
</visual></link>
<xacro:macro name="wheel" params="side y"><link name="${side}_wheel"><visual>
<geometry><sphere radius="0.05"/></geometry></visual></link>
<joint name="${side}_joint" type="continuous"><origin xyz="0 ${y} 0"/>
<parent link="base_link"/><child link="${side}_wheel"/><axis xyz="0 1 0"/></joint>
</xacro:macro>
<xacro:wheel side="left" y="LEFT"/>
<xacro:wheel side="right" y="RIGHT"/>
</robot>
"""


@pytest.mark.parametrize(
    ("left", "wrong", "right"),
    [
        ("${half + 0.03}", "${-half + 0.03}", "${-(half + 0.03)}"),
        ("${half/2 - 0.01}", "${-half/2 - 0.01}", "${-(half/2 - 0.01)}"),
        ("${half}", "${half}", "${-half}"),
        ("${half + 0.03}", "${half + 0.03}", "${-(half + 0.03)}"),
        ("0.12", "0.12", "-0.12"),
    ],
)
def test_a_call_for_the_other_side_has_all_of_its_sign(
    left: str, wrong: str, right: str, tmp_path: Path
) -> None:
    text, model = MIRRORED.replace("LEFT", left), tmp_path / "r.urdf.xacro"
    model.write_text(text.replace("RIGHT", right))
    codes = ("wheel-unlike-twin", "wheels-in-one-place")
    assert not [p for p in check(model) if p.code in codes]
    model.write_text(text.replace("RIGHT", wrong))

    (problem,) = (p for p in check(model) if p.code in codes)

    assert problem.line == 11
    mended = apply_edits(problem.edits, model.read_text())
    assert mended == text.replace("RIGHT", right)

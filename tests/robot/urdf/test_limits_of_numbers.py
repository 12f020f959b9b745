"""Extreme numbers and names give a robot that can be shown, or a Problem."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from sambot_viz.errors import RobotError
from sambot_viz.robot.kinematics import Kinematics
from sambot_viz.robot.model import load_robot
from sambot_viz.robot.parts import Box
from sambot_viz.robot.urdf.attributes import LARGEST

LIMIT = '<limit lower="{0}" upper="{1}" effort="1" velocity="1"/>'


def two_links(inside: str = "", joint: str = "", kind: str = "fixed") -> str:
    return (
        f'<robot name="r"><link name="a"/><link name="b">{inside}</link>'
        f'<joint name="j" type="{kind}"><parent link="a"/><child link="b"/>{joint}'
        "</joint></robot>"
    )


def test_an_extreme_size_is_clamped_with_a_warning() -> None:
    visual = '<visual><geometry><box size="1 1e308 -1e39"/></geometry></visual>'
    robot = load_robot(two_links(visual))
    box = robot.links["b"].visuals[0].geometry
    assert box == Box((1.0, LARGEST, -LARGEST))
    assert [p.code for p in robot.problems] == ["number-too-large"]
    assert "box" in robot.problems[0].message
    assert robot.problems[0].line == 1


@pytest.mark.parametrize("number", ["1e308", "-1e308", "1e39", "1e-320", "0"])
@pytest.mark.parametrize("kind", ["prismatic", "revolute"])
def test_poses_stay_finite_whatever_the_limits_and_origins(
    number: str, kind: str
) -> None:
    joint = f'<origin xyz="{number} 0 {number}" rpy="{number} 0 1"/>'
    joint += f'<axis xyz="{number} 1 0"/>' + LIMIT.format(number, number)
    robot = load_robot(two_links(joint=joint, kind=kind))
    assert all(math.isfinite(v) for v in robot.joints["j"].range)
    assert math.isfinite(robot.joints["j"].start)
    for T_root_link in robot.forward_kinematics().values():
        assert np.isfinite(T_root_link).all()
        assert np.isfinite(np.vdot(T_root_link, T_root_link))


def test_limits_as_real_files_have_them_stay_as_they_are() -> None:
    joint = LIMIT.format("-1e+16", "1e+16").replace('effort="1"', 'effort="1e+30"')
    robot = load_robot(two_links(joint=joint, kind="revolute"))
    limit = robot.joints["j"].limit
    assert limit is not None
    assert (limit.lower, limit.upper) == (-1e16, 1e16)
    assert robot.joints["j"].range == (-math.pi, math.pi)
    assert robot.problems == ()


def test_a_chain_of_mimic_joints_with_huge_factors_stays_finite() -> None:
    count = 30
    links = "".join(f'<link name="l{i}"/>' for i in range(count + 1))
    joints = "".join(
        f'<joint name="j{i}" type="prismatic"><parent link="l{i}"/>'
        f'<child link="l{i + 1}"/>{LIMIT.format(-1, 1)}'
        + (f'<mimic joint="j{i - 1}" multiplier="-1e18" offset="1"/>' if i else "")
        + "</joint>"
        for i in range(count)
    )
    robot = load_robot(f'<robot name="r">{links}{joints}</robot>')
    kinematics = Kinematics(robot)
    positions = kinematics.positions({"j0": 1.0})
    assert all(math.isfinite(position) for position in positions.values())
    assert np.isfinite(kinematics.poses({"j0": 1.0})).all()


@pytest.mark.parametrize("name", ["/", "//b"])
def test_a_link_name_that_cannot_be_a_frame_rejects_the_model(name: str) -> None:
    with pytest.raises(RobotError) as caught:
        load_robot(two_links().replace('"b"', f'"{name}"'))
    assert caught.value.problems[0].code == "link-name-slashes"


def test_links_that_differ_in_a_leading_slash_only_reject_the_model() -> None:
    with pytest.raises(RobotError) as caught:
        load_robot(two_links().replace('"b"', '"/a"'))
    assert [p.code for p in caught.value.problems if p.severity == "error"] == [
        "link-name-twin"
    ]


@pytest.mark.parametrize("name", ["x" * 1_000_000, "package://" + "a/" * 5000, "%00"])
def test_a_file_name_that_no_system_can_hold_is_a_missing_file(
    name: str, tmp_path: Path
) -> None:
    model = tmp_path / "m.urdf"
    mesh = f'<visual><geometry><mesh filename="{name}"/></geometry></visual>'
    model.write_text(two_links(mesh))
    robot = load_robot(model)
    assert [p.code for p in robot.problems] == ["mesh-not-found"]
    assert len(robot.problems[0].message) < 3000


def test_a_chain_of_two_thousand_links_needs_no_recursion() -> None:
    count = 2000
    links = "".join(f'<link name="l{i}"/>' for i in range(count + 1))
    joints = "".join(
        f'<joint name="j{i}" type="fixed"><parent link="l{i}"/>'
        f'<child link="l{i + 1}"/><origin xyz="0 0 1"/></joint>'
        for i in range(count)
    )
    robot = load_robot(f'<robot name="r">{links}{joints}</robot>')
    assert robot.forward_kinematics()[f"l{count}"][2, 3] == count
    assert [p.code for p in robot.problems] == ["chain-too-long"]

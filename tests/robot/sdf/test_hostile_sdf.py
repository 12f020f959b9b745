"""Whatever is in a file: a robot that can be drawn, or errors that say why not."""

from __future__ import annotations

import math
import random
import re
from pathlib import Path

import numpy as np
import pytest

from sambot_viz import Robot, RobotError, load_robot
from sambot_viz.robot.parts import Box, Cylinder, MeshFile, Sphere
from sambot_viz.robot.sdf.values import BadValue, read_number, read_pose, read_vector

OURS = Path(__file__).parents[2] / "data" / "sdf" / "ours"

HOSTILE = (
    "nan",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "1e999",
    "1e-999",
    "0x1p4",
    "0",
    "",
    "  ",
    "1 2",
    "1,5",
    "1 2 3 4 5 6 7 8",
    "${x}",
    "__model__",
    "world",
    "a::b",
    "é",
    "٣",
    "\u00a01",
    "true",
    "x" * 5000,
)


def assert_drawable(robot: Robot) -> None:
    """All that is drawn is finite; a limit may be infinite, its slider is not."""
    for joint in robot.joints.values():
        assert np.isfinite(joint.origin.matrix).all()
        assert math.hypot(*joint.axis) == pytest.approx(1.0)
        assert all(map(math.isfinite, (*joint.range, joint.start)))
    for link in robot.links.values():
        for shape in (*link.visuals, *link.collisions):
            assert np.isfinite(shape.origin.matrix).all()
            match shape.geometry:
                case Box(numbers) | MeshFile(_, numbers):
                    sizes = numbers
                case Sphere(radius):
                    sizes = (radius,)
                case Cylinder(radius, length):
                    sizes = (radius, length)
                case _:
                    raise AssertionError(shape)
            assert all(map(math.isfinite, sizes))
            if shape.material is not None and shape.material.rgba is not None:
                assert all(0.0 <= part <= 1.0 for part in shape.material.rgba)
    assert np.isfinite(list(robot.forward_kinematics().values())).all()
    load_robot(robot.urdf)


@pytest.mark.parametrize("name", ["mbot_frames", "mbot_classic", "mbot_gripper"])
@pytest.mark.parametrize("value", HOSTILE, ids=lambda value: repr(value[:12]))
def test_a_hostile_value_anywhere_is_drawn_or_refused(name: str, value: str) -> None:
    text = (OURS / f"{name}.sdf").read_text()
    spans = [m.span(1) for m in re.finditer(r'>([^<>\n]+)<|="([^"]*)"', text)]
    spans = [span for span in spans if span != (-1, -1)]
    for start, end in random.Random(value).sample(spans, 12):
        try:
            robot = load_robot(text[:start] + value + text[end:])
        except RobotError as error:
            assert all(p.message and p.severity for p in error.problems)
        else:
            assert_drawable(robot)


@pytest.mark.parametrize("name", ["mbot_frames", "mbot_classic", "mbot_gripper"])
def test_a_lost_or_doubled_line_is_drawn_or_refused(name: str) -> None:
    lines = (OURS / f"{name}.sdf").read_text().splitlines()
    for number in range(len(lines)):
        for changed in (
            [*lines[:number], *lines[number + 1 :]],
            [*lines[: number + 1], *lines[number:]],
        ):
            try:
                robot = load_robot("\n".join(changed))
            except RobotError as error:
                assert error.problems
            else:
                assert_drawable(robot)


def test_a_number_is_the_longest_start_that_is_one() -> None:
    digits = random.Random(1)
    for _ in range(2000):
        value = digits.uniform(-1e3, 1e3) * 10.0 ** digits.randint(-30, 30)
        behind = digits.choice(("", "m", ",5", " 3", "..", "e", "x1"))
        number = read_number(f" {value!r}{behind} ")
        assert number.value == value
        assert number.ignored == behind.rstrip()


@pytest.mark.parametrize("text", ["", ".", "+", "e5", "--1", "pi", "０", "_1"])
def test_a_text_that_begins_with_no_number_is_none(text: str) -> None:
    with pytest.raises(BadValue):
        read_number(text)
    with pytest.raises(BadValue):
        read_vector(f"{text} 1 2", 4)


def test_poses_in_degrees_and_as_quaternions_are_the_same_rotations() -> None:
    angles = random.Random(2)
    for _ in range(200):
        r, p, y = (angles.uniform(-180, 180) for _ in range(3))
        degrees = read_pose(f"1 2 3 {r} {p} {y}", True, "euler_rpy").matrix
        half = [math.radians(angle) / 2 for angle in (r, p, y)]
        (cr, cp, cy), (sr, sp, sy) = map(math.cos, half), map(math.sin, half)
        xyzw = (
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy,
        )
        text = " ".join(map(str, (1, 2, 3, *xyzw)))
        np.testing.assert_allclose(
            read_pose(text, False, "quat_xyzw").matrix, degrees, atol=1e-12
        )


def test_a_deep_nesting_and_a_long_chain_of_poses_end() -> None:
    deep = 3000
    nested = '<model name="m"><link name="x"/>' * deep + "</model>" * deep
    chain = "".join(
        f'<frame name="f{n}"><pose relative_to="f{n - 1}">0 0 1 0 0 0</pose></frame>'
        for n in range(1, deep)
    )
    frames = f'<frame name="f0"/>{chain}'
    link = f'<link name="b"><pose relative_to="f{deep - 1}"/></link>'
    joint = '<joint name="j" type="fixed"><parent>a</parent><child>b</child></joint>'
    body = f'<link name="a"/>{link}{joint}{frames}{nested}'

    robot = load_robot(f'<sdf version="1.8"><model name="r">{body}</model></sdf>')

    assert robot.joints["j"].origin.xyz == (0.0, 0.0, float(deep - 1))

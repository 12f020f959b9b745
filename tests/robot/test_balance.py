"""Mass, centre of mass, support polygon and tipping angle, against figures by hand."""

from __future__ import annotations

import math
import struct
from pathlib import Path

import numpy as np
import pytest

from sambot_viz import bundled
from sambot_viz.robot.balance.balance import Balance, Tipping, convex_hull
from sambot_viz.robot.model import load_robot


def weighed(text: str, **positions: float) -> Balance:
    found = load_robot(f"<robot name='r'>{text}</robot>").balance(positions)
    assert found is not None
    return found


def link(
    name: str, geometry: str = "", mass: float = 0.0, at: str = "0 0 0", rpy: str = ""
) -> str:
    """A link with one shape, and its mass in the middle of it."""
    origin = f"<origin xyz='{at}' rpy='{rpy or '0 0 0'}'/>"
    shape = f"<visual>{origin}<geometry>{geometry}</geometry></visual>"
    weight = (
        f"<inertial>{origin}<mass value='{mass}'/>"
        "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>"
    )
    return (
        f"<link name='{name}'>{shape if geometry else ''}{weight if mass else ''}"
        "</link>"
    )


def joint(
    child: str, at: str, kind: str = "fixed", axis: str = "0 1 0", parent: str = "base"
) -> str:
    return (
        f"<joint name='{child}_joint' type='{kind}'><parent link='{parent}'/>"
        f"<child link='{child}'/><origin xyz='{at}'/><axis xyz='{axis}'/>"
        "<limit lower='-3' upper='3' effort='1' velocity='1'/></joint>"
    )


def tipping(found: Balance) -> Tipping:
    assert found.tipping is not None
    return found.tipping


def polygon(found: Balance) -> list[list[float]]:
    assert found.support is not None
    return np.round(found.support.polygon, 6).tolist()


def test_sam_bot_stands_on_two_wheels_and_a_caster():
    found = load_robot(bundled.model_path("sam_bot_collision.urdf.xacro")).balance()

    # 15 kg in the middle, 0.5 kg at (-0.12, ±0.18, -0.05) and at (0.14, 0, -0.09).
    assert found is not None and found.support is not None
    assert math.isclose(found.mass, 16.5)
    assert np.allclose(found.center, (-0.05 / 16.5, 0, -0.095 / 16.5))
    assert found.support.height == pytest.approx(-0.15)
    assert found.support.links == ("drivewhl_l_link", "drivewhl_r_link", "front_caster")
    # The wheels are 0.04 wide.
    assert polygon(found) == [[-0.12, -0.2], [0.14, 0.0], [-0.12, 0.2]]
    # From (0.14, 0) to (-0.12, ±0.2): twice the area of the triangle by its base.
    margin = 0.2 * (0.14 + 0.05 / 16.5) / math.hypot(0.26, 0.2)
    height = 0.15 - 0.095 / 16.5
    assert tipping(found).margin == pytest.approx(margin)
    assert tipping(found).angle == pytest.approx(math.atan2(margin, height))
    assert tipping(found).directions == pytest.approx(
        np.array(((0.2, -0.26), (0.2, 0.26))) / math.hypot(0.26, 0.2)
    )


def test_a_joint_that_moves_moves_the_centre_of_mass():
    arm = link("base", "<box size='0.2 0.2 0.1'/>", 1.0) + link("hand", mass=1.0)
    arm += joint("hand", "0 0 0.5", "prismatic", axis="1 0 0")

    assert weighed(arm).center == pytest.approx((0.0, 0.0, 0.25))
    found = weighed(arm, hand_joint=0.6)
    assert found.center == pytest.approx((0.3, 0.0, 0.25))
    assert tipping(found).margin == pytest.approx(-0.2)
    assert math.degrees(tipping(found).angle) == pytest.approx(-33.69, abs=0.01)
    assert tipping(found).directions == pytest.approx(np.array([[1.0, 0.0]]))


def test_on_two_wheels_alone_nothing_keeps_a_robot_upright():
    wheel = "<cylinder radius='0.1' length='0.04'/>"
    text = link("base", "<box size='0.1 0.1 0.1'/>", 1.0)
    for name, side in (("left", 0.2), ("right", -0.2)):
        text += link(name, wheel, 0.1, rpy="1.5707963267948966 0 0")
        text += joint(name, f"0 {side} 0", "continuous")
    found = weighed(text)

    assert polygon(found) == [[0.0, -0.22], [0.0, 0.22]]
    assert found.tipping is None and not found.fixed


@pytest.mark.parametrize("roll", ["1.57", "1.5708", "1.571", "1.5707963267948966"])
def test_a_wheel_that_turns_leaves_the_tipping_angle_as_it_is(roll: str):
    wheel = "<cylinder radius='0.1' length='0.04'/>"
    text = link("base", "<box size='0.4 0.3 0.1'/>", 5.0)
    for name, side in (("left", 0.2), ("right", -0.2)):
        text += link(name, wheel, 0.5, rpy=f"{roll} 0 0")
        text += joint(name, f"-0.12 {side} -0.05", "continuous")
    text += link("caster", "<sphere radius='0.05'/>", 0.1)
    robot = load_robot(
        f"<robot name='r'>{text}{joint('caster', '0.14 0 -0.1')}</robot>"
    )
    for left in np.linspace(-7.0, 7.0, 29):
        for right in np.linspace(-4.0, 4.0, 17):
            found = robot.balance({"left_joint": left, "right_joint": right})
            assert found is not None
            # As by hand: the edge from (0.14, 0) to (-0.12, 0.22).
            assert math.degrees(tipping(found).angle) == pytest.approx(35.95, abs=0.02)


def test_a_line_that_is_wide_by_a_rounding_has_two_ends():
    ends = np.array(((0.0, -0.2), (2e-8, 0.18), (-3e-8, -0.18), (1e-8, 0.2)))
    for turn in (0.0, 0.4, math.pi / 2):
        c, s = math.cos(turn), math.sin(turn)
        found = convex_hull(ends @ np.array(((c, s), (-s, c))))
        assert len(found) == 2
        assert math.dist(*found) == pytest.approx(0.4, abs=1e-6)


def test_a_robot_that_is_fixed_to_the_world_does_not_tip_over():
    text = "<link name='world'/>" + link("base", "<box size='1 1 1'/>", 1.0)
    found = weighed(text + joint("base", "0 0 0", parent="world"))

    assert found.fixed and found.tipping is None
    assert polygon(found) == [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]


@pytest.mark.parametrize(
    ("geometry", "rpy", "corners"),
    [
        ("<sphere radius='0.1'/>", "0 0 0", 1),
        ("<box size='0.2 0.2 0.2'/>", "0 0 0", 4),
        ("<box size='0.2 0.2 0.2'/>", "0.7853981633974483 0 0", 2),
        ("<cylinder radius='0.1' length='0.2'/>", "0 0 0", 32),
        ("<cylinder radius='0.1' length='0.2'/>", "1.5707963267948966 0 0.3", 2),
        ("<cylinder radius='0.1' length='0.2'/>", "1.2 0 0", 1),
    ],
)
def test_a_shape_touches_the_ground_with_its_lowest_points(
    geometry: str, rpy: str, corners: int
):
    found = weighed(link("base", geometry, 1.0, rpy=rpy))
    assert len(polygon(found)) == corners


def test_a_caster_two_millimetres_too_high_counts_and_a_body_does_not():
    text = link("base", "<box size='0.5 0.3 0.1'/>", 1.0, at="0 0 0.0566")
    for name, height in (("front", 0.0), ("left", 0.0), ("right", 0.002)):
        text += link(name, "<sphere radius='0.02'/>")
        at = {"front": "0.2 0", "left": "-0.2 0.1", "right": "-0.2 -0.1"}[name]
        text += joint(name, f"{at} {0.02 + height}")
    found = weighed(text)

    # The body is 6.6 mm above the ground.
    assert found.support is not None
    assert found.support.links == ("front", "left", "right")
    assert found.massless == ("front", "left", "right")


def test_of_a_link_with_collision_shapes_these_touch_the_ground():
    collision = "<collision><geometry><box size='0.1 0.1 0.1'/></geometry></collision>"
    text = link("base", "<box size='1 1 1'/>", 1.0)
    assert polygon(weighed(text.replace("</link>", f"{collision}</link>"))) == [
        [-0.05, -0.05], [0.05, -0.05], [0.05, 0.05], [-0.05, 0.05]
    ]  # fmt: skip


def test_a_mass_that_no_body_has_does_not_count():
    text = link("base", "<box size='1 1 1'/>", 2.0) + link("odd", mass=-5.0)
    text += link("heavy", mass=math.inf) + joint("odd", "1 0 0")
    assert weighed(text + joint("heavy", "1 0 0")).mass == 2.0


def test_a_robot_without_masses_is_not_weighed():
    robot = load_robot(bundled.model_path())
    assert robot.balance() is None


def wheel_mesh(path: Path, sides: int) -> None:
    """Write a wheel about y, of radius 0.1 and width 0.04, as an STL file."""
    around = [2 * math.pi * i / sides for i in range(sides)]
    rim = [(0.1 * math.cos(a), 0.1 * math.sin(a)) for a in around]
    triangles: list[tuple[tuple[float, float, float], ...]] = []
    for (x, z), (u, w) in zip(rim, [*rim[1:], rim[0]], strict=True):
        triangles += [
            ((x, -0.02, z), (u, -0.02, w), (u, 0.02, w)),
            ((x, -0.02, z), (u, 0.02, w), (x, 0.02, z)),
        ]
    with path.open("wb") as file:
        file.write(bytes(80) + struct.pack("<I", len(triangles)))
        for corners in triangles:
            numbers = [0.0] * 3 + [value for corner in corners for value in corner]
            file.write(struct.pack("<12fH", *numbers, 0))


def test_a_wheel_that_is_a_mesh_rolls_on_the_line_below_its_axle(tmp_path: Path):
    wheel_mesh(tmp_path / "wheel.stl", 24)
    text = link("base", mass=1.0) + joint("wheel", "0.3 0.2 0", "continuous")
    text += link("wheel", f"<mesh filename='file://{tmp_path}/wheel.stl'/>")

    for angle in (0.0, 0.05, 0.13, 1.0):
        found = weighed(text, wheel_joint=angle)
        assert polygon(found) == [[0.3, 0.18], [0.3, 0.22]]
        assert found.support is not None
        assert found.support.height == pytest.approx(-0.1, abs=1e-6)


def test_a_mesh_that_is_not_round_touches_the_ground_where_it_is_lowest(
    tmp_path: Path,
):
    wheel_mesh(tmp_path / "box.stl", 4)
    text = link("base", mass=1.0) + joint("arm", "0 0 0", "continuous")
    text += link("arm", f"<mesh filename='file://{tmp_path}/box.stl' scale='2 1 1'/>")

    found = weighed(text, arm_joint=math.pi / 4)
    # Its corners are at (±0.2, 0) and (0, ±0.1), turned by an eighth about y.
    assert polygon(found) == [[0.141421, -0.02], [0.141421, 0.02]]
    assert found.support is not None
    assert found.support.height == pytest.approx(-0.2 * math.sqrt(0.5), abs=1e-6)

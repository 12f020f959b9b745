"""The bundled robots, expanded by the real xacro and read as plain XML."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple, cast
from xml.etree import ElementTree

import numpy as np
import pytest
import xacro  # pyright: ignore[reportMissingTypeStubs]
import yaml

from sambot_viz import bundled, load_robot

COLLISION = "sam_bot_collision.urdf.xacro"


class Joint(NamedTuple):
    """A joint as the file says it."""

    type: str | None
    parent: str | None
    child: str | None
    xyz: list[float]
    rpy: list[float]
    axis: list[float] | None


def expand(path: Path, **arguments: str) -> ElementTree.Element:
    """The robot that the xacro package makes of a file."""
    document = cast(Any, xacro).process_file(str(path), mappings=arguments)
    return ElementTree.fromstring(document.toxml())


def numbers(text: str | None) -> list[float]:
    return [float(word) for word in (text or "").split()]


def materials(robot: ElementTree.Element) -> dict[str, list[float]]:
    """Material name → its colour, wherever in the robot it is given."""
    return {
        material.get("name", ""): numbers(color.get("rgba"))
        for material in robot.iter("material")
        if (color := material.find("color")) is not None
    }


def shape(element: ElementTree.Element) -> dict[str, object]:
    """One <visual> or <collision> without its material."""
    origin = element.find("origin")
    geometry = element.find("geometry")
    assert geometry is not None and len(geometry) == 1
    return {
        "kind": geometry[0].tag,
        "size": {key: numbers(value) for key, value in geometry[0].items()},
        "xyz": numbers("0 0 0" if origin is None else origin.get("xyz")),
        "rpy": numbers("0 0 0" if origin is None else origin.get("rpy")),
    }


def links(robot: ElementTree.Element) -> dict[str, object]:
    """Link name → its visual, with the colour it ends up with."""
    colours = materials(robot)
    found: dict[str, object] = {}
    for link in robot.findall("link"):
        visuals = [
            (shape(visual), material.get("name"), colours[material.get("name", "")])
            for visual in link.findall("visual")
            if (material := visual.find("material")) is not None
        ]
        found[link.get("name", "")] = visuals
    return found


def joints(robot: ElementTree.Element) -> dict[str, Joint]:
    """Joint name → what it says."""
    found: dict[str, Joint] = {}
    for joint in robot.findall("joint"):
        parts = {part.tag: part for part in joint}
        axis = parts.get("axis")
        found[joint.get("name", "")] = Joint(
            joint.get("type"),
            parts["parent"].get("link"),
            parts["child"].get("link"),
            numbers(parts["origin"].get("xyz")),
            numbers(parts["origin"].get("rpy")),
            None if axis is None else numbers(axis.get("xyz")),
        )
    return found


def inertial(robot: ElementTree.Element, link: str) -> tuple[float, list[float]]:
    """The mass [kg] and the diagonal of the inertia [kg m²] of a link."""
    found = robot.find(f"link[@name='{link}']/inertial")
    assert found is not None
    mass, inertia = found.find("mass"), found.find("inertia")
    assert mass is not None and inertia is not None
    assert [inertia.get(key) for key in ("ixy", "ixz", "iyz")] == ["0", "0", "0"]
    diagonal = [float(inertia.get(key, "nan")) for key in ("ixx", "iyy", "izz")]
    return float(mass.get("value", "nan")), diagonal


def test_sam_bot_is_the_robot_of_the_tutorial(shared: Path) -> None:
    ours = expand(bundled.model_path())
    seed = expand(shared / "data" / "seed" / "sam_bot.urdf.xacro")
    assert ours.get("name") == seed.get("name") == "sam_bot"
    assert list(links(ours)) == list(links(seed))
    assert links(ours) == links(seed)
    assert list(joints(ours)) == list(joints(seed))
    assert joints(ours) == joints(seed)
    assert ours.find(".//collision") is None
    assert ours.find(".//inertial") is None


def test_sam_bot_needs_no_file_beside_it(tmp_path: Path) -> None:
    alone = tmp_path / "mine.xacro"
    alone.write_bytes(bundled.model_path().read_bytes())
    assert len(links(expand(alone))) == 5


def test_the_collision_step_is_the_same_robot() -> None:
    first, next_step = map(
        expand, (bundled.model_path(), bundled.model_path(COLLISION))
    )
    assert links(first) == links(next_step)
    assert joints(first) == joints(next_step)


def test_every_collision_shape_equals_the_visual_of_its_link() -> None:
    robot = expand(bundled.model_path(COLLISION))
    compared: list[str] = []
    for link in robot.findall("link"):
        visuals = [shape(element) for element in link.findall("visual")]
        assert [shape(element) for element in link.findall("collision")] == visuals
        compared += [link.get("name", "")] * len(visuals)
    assert compared == [
        "base_link",
        "drivewhl_l_link",
        "drivewhl_r_link",
        "front_caster",
    ]


def test_the_base_has_the_inertia_of_a_box() -> None:
    mass, diagonal = inertial(expand(bundled.model_path(COLLISION)), "base_link")
    x, y, z = 0.42, 0.31, 0.18
    assert mass == 15.0
    assert diagonal == pytest.approx(
        [15 / 12 * (y**2 + z**2), 15 / 12 * (x**2 + z**2), 15 / 12 * (x**2 + y**2)]
    )


@pytest.mark.parametrize("wheel", ["drivewhl_l_link", "drivewhl_r_link"])
def test_a_wheel_has_the_inertia_of_a_cylinder_along_its_axle(wheel: str) -> None:
    robot = expand(bundled.model_path(COLLISION))
    mass, diagonal = inertial(robot, wheel)
    across = 0.5 / 12 * (3 * 0.1**2 + 0.04**2)
    assert mass == 0.5
    assert diagonal == pytest.approx([across, across, 0.5 / 2 * 0.1**2])
    origin = robot.find(f"link[@name='{wheel}']/inertial/origin")
    assert origin is not None
    assert numbers(origin.get("rpy")) == pytest.approx([np.pi / 2, 0, 0])


def test_the_caster_has_the_inertia_of_a_ball() -> None:
    mass, diagonal = inertial(expand(bundled.model_path(COLLISION)), "front_caster")
    assert mass == 0.5
    assert diagonal == pytest.approx([2 / 5 * 0.5 * 0.06**2] * 3)


def test_a_box_inertia_agrees_with_a_box_of_many_small_pieces() -> None:
    _, diagonal = inertial(expand(bundled.model_path(COLLISION)), "base_link")
    axes = [(np.arange(60) + 0.5) / 60 * side - side / 2 for side in (0.42, 0.31, 0.18)]
    x, y, z = np.meshgrid(*axes)
    sums = [np.mean(y**2 + z**2), np.mean(x**2 + z**2), np.mean(x**2 + y**2)]
    assert diagonal == pytest.approx([15 * float(s) for s in sums], rel=1e-3)


def test_the_wheels_of_mbot_touch_the_ground() -> None:
    robot = expand(bundled.model_path("mbot.urdf.xacro"))
    assert robot.get("name") == "mbot"
    assert list(links(robot)) == [
        "base_footprint",
        "base_link",
        "left_wheel_link",
        "right_wheel_link",
        "front_caster_link",
        "back_caster_link",
        "laser_link",
        "camera_link",
    ]
    found = joints(robot)
    moving = [name for name, joint in found.items() if joint.type == "continuous"]
    assert moving == ["left_wheel_joint", "right_wheel_joint"]
    base = found["base_joint"].xyz[2]
    wheel = found["left_wheel_joint"].xyz[2]
    caster = found["front_caster_joint"].xyz[2]
    assert base + wheel == pytest.approx(0.05)
    assert base + caster == pytest.approx(0.0125)


def test_mbot_can_leave_its_sensors_out() -> None:
    path = bundled.model_path("mbot.urdf.xacro")
    robot = expand(path, lidar="false", camera="false")
    assert {"laser_link", "camera_link"}.isdisjoint(links(robot))


def test_every_link_of_mbot_with_a_shape_has_mass() -> None:
    robot = expand(bundled.model_path("mbot.urdf.xacro"))
    for link in robot.findall("link"):
        if link.find("visual") is not None:
            mass, diagonal = inertial(robot, link.get("name", ""))
            assert mass > 0
            a, b, c = sorted(diagonal)
            assert 0 < a and c <= a + b


def test_the_tutorial_config_is_the_one_that_users_have(shared: Path) -> None:
    seed = (shared / "data" / "seed" / "urdf_config.rviz").read_text("utf-8")
    assert yaml.safe_load(bundled.config_path().read_text("utf-8")) == (
        yaml.safe_load(seed)
    )


def test_the_config_of_mbot_starts_at_a_frame_of_mbot() -> None:
    config = yaml.safe_load(bundled.config_path("mbot.rviz").read_text("utf-8"))
    fixed = config["Visualization Manager"]["Global Options"]["Fixed Frame"]
    assert fixed in links(expand(bundled.model_path("mbot.urdf.xacro")))


def test_sam_bot_in_sdf_is_the_sam_bot_of_the_urdf_with_collisions() -> None:
    sdf, urdf = (load_robot(bundled.model_path(n)) for n in ("sam_bot.sdf", COLLISION))

    assert sdf.joint_names == urdf.joint_names
    positions = {"drivewhl_l_joint": 1.0, "drivewhl_r_joint": -2.0}
    poses, expected = (r.forward_kinematics(positions) for r in (sdf, urdf))
    assert poses.keys() == expected.keys()
    for name, T in poses.items():
        np.testing.assert_allclose(T, expected[name], atol=1e-12)
        link, other = sdf.links[name], urdf.links[name]
        for shapes, others in (
            (link.visuals, other.visuals),
            (link.collisions, other.collisions),
        ):
            assert [s.geometry for s in shapes] == [s.geometry for s in others]
        for shape, one in zip(link.visuals, other.visuals, strict=True):
            assert shape.material is not None and one.material is not None
            assert shape.material.rgba == pytest.approx(one.material.rgba)
            np.testing.assert_allclose(shape.origin.matrix, one.origin.matrix)
        if other.inertial is not None:
            assert link.inertial is not None
            for moment in ("mass", "ixx", "iyy", "izz"):
                expected_moment = getattr(other.inertial, moment)
                assert getattr(link.inertial, moment) == pytest.approx(expected_moment)

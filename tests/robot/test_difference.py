"""What differs between two robots is said once for each value."""

from __future__ import annotations

from sambot_viz.robot.difference import Difference, differences
from sambot_viz.robot.model import load_robot

ROBOT = """<robot name="r">
<link name="base"><visual><geometry><box size="1 2 3"/></geometry>
  <material name="m"><color rgba="1 0 0 1"/></material></visual>
  <inertial><mass value="2"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<link name="arm"/>
<link name="hand"/>
<joint name="a" type="revolute"><parent link="base"/><child link="arm"/>
  <origin xyz="0 0 1" rpy="0 0 0"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="5" velocity="2"/></joint>
<joint name="b" type="fixed"><parent link="arm"/><child link="hand"/></joint>
</robot>"""


def changed(*pairs: tuple[str, str]) -> list[Difference]:
    """What differs once texts of the robot are replaced by others."""
    text = ROBOT
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return differences(load_robot(ROBOT), load_robot(text))


def rows(*pairs: tuple[str, str]) -> list[tuple[object, ...]]:
    return [(f.kind, f.name, f.what, f.mine, f.theirs) for f in changed(*pairs)]


def test_a_robot_does_not_differ_from_itself() -> None:
    assert changed() == []
    assert changed(("0 0 1", "0.0 0 1e0"), ("<link name", "<!-- --><link name")) == []


def test_a_colour_that_one_lacks_is_one_difference() -> None:
    colour = '\n  <material name="m"><color rgba="1 0 0 1"/></material>'
    assert rows((colour, "")) == [
        ("link", "base", "visual colour", (1.0, 0.0, 0.0, 1.0), None)
    ]
    texture = colour.replace("</mat", '<texture filename="t.png"/></mat')
    assert rows((colour, texture)) == [
        ("link", "base", "visual texture", None, "t.png")
    ]


def test_a_part_that_was_moved_is_one_difference() -> None:
    (found,) = changed(('xyz="0 0 1" rpy="0 0 0"', 'xyz="0.03 0 1.04" rpy="0 0 0"'))
    assert (found.kind, found.name, found.what) == ("joint", "a", "origin")
    assert (found.mine, found.theirs) == ((0.0, 0.0, 1.0), (0.03, 0.0, 1.04))
    assert found.unit == "m" and found.apart is not None
    assert abs(found.apart - 0.05) < 1e-9
    assert [place and place.line for place in found.places] == [8, 8]


def test_a_rotation_that_is_written_in_another_way_is_the_same() -> None:
    half = ('rpy="0 0 0"', 'rpy="3.141592653589793 3.141592653589793 0"')
    same = half[0], 'rpy="0 0 3.141592653589793"'
    assert [one.theirs for one in changed(half)] != []
    text = ROBOT.replace(*half)
    assert differences(load_robot(text), load_robot(ROBOT.replace(*same))) == []
    (found,) = changed(('rpy="0 0 0"', 'rpy="0 0.5 0"'))
    assert (found.what, found.unit) == ("rotation", "rad")
    assert found.apart is not None and abs(found.apart - 0.5) < 1e-9


def test_each_value_is_one_row() -> None:
    assert rows(
        ('name="r"', 'name="s"'),
        ('size="1 2 3"', 'size="1 2 4"'),
        ("1 0 0 1", "0 1 0 1"),
        ('mass value="2"', 'mass value="3"'),
        ('upper="1"', 'upper="1.5"'),
        ('effort="5"', 'effort="6"'),
        ('axis xyz="0 0 1"', 'axis xyz="0 1 0"'),
    ) == [
        ("robot", "", "name", "r", "s"),
        ("link", "base", "visual size", (1.0, 2.0, 3.0), (1.0, 2.0, 4.0)),
        ("link", "base", "visual colour", (1, 0, 0, 1), (0, 1, 0, 1)),
        ("link", "base", "inertial mass", 2.0, 3.0),
        ("joint", "a", "axis", (0, 0, 1), (0, 1, 0)),
        ("joint", "a", "limit upper", 1.0, 1.5),
        ("joint", "a", "limit effort", 5.0, 6.0),
    ]


def test_a_part_that_is_missing_is_one_row() -> None:
    visual = ROBOT[ROBOT.index("<visual>") : ROBOT.index("</visual>")] + "</visual>"
    assert rows((visual, "")) == [("link", "base", "visual", "box", None)]
    assert rows((visual, visual + visual)) == [
        ("link", "base", "visual 2", None, "box")
    ]
    inertial = ROBOT[ROBOT.index("<inertial>") : ROBOT.index("</inertial>")]
    inertial += "</inertial>"
    assert rows((inertial, "")) == [("link", "base", "inertial", "there", None)]
    end = '<link name="new"/><joint name="n" type="fixed"><parent link="hand"/>'
    end += '<child link="new"/></joint></robot>'
    assert rows(("</robot>", end)) == [
        ("link", "new", "", None, "there"),
        ("joint", "n", "", None, "there"),
    ]


def test_another_shape_has_other_values() -> None:
    assert rows(('<box size="1 2 3"/>', '<sphere radius="2"/>')) == [
        ("link", "base", "visual shape", "box", "sphere"),
        ("link", "base", "visual size", (1.0, 2.0, 3.0), None),
        ("link", "base", "visual radius", None, 2.0),
    ]


def test_another_parent_is_said_of_the_joint() -> None:
    assert rows(('<parent link="arm"/>', '<parent link="base"/>')) == [
        ("joint", "b", "parent", "arm", "base")
    ]

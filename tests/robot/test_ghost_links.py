"""The links of a reference that are drawn beside a robot, and what they hang below."""

from __future__ import annotations

import pytest

from sambot_viz import load_robot
from sambot_viz.robot.ghost_links import GhostLink, ghost_links

BOX = "<visual><geometry><box size='{}'/></geometry>{}</visual>"
PARTS = {
    "base": "<link name='base'>" + BOX.format("1 1 1", "") + "</link>",
    "arm": "<link name='arm'>" + BOX.format("1 1 1", "") + "</link>",
    "hand": "<link name='hand'>" + BOX.format("1 1 1", "") + "</link>",
    "shoulder": "<joint name='shoulder' type='continuous'><parent link='base'/>"
    "<child link='arm'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/></joint>",
    "wrist": "<joint name='wrist' type='fixed'><parent link='arm'/>"
    "<child link='hand'/><origin xyz='1 0 0'/></joint>",
}


def ghosts(**theirs: str) -> list[GhostLink]:
    """Compare the arm with one that has other parts; "" leaves one out."""
    mine, other = (
        load_robot(f"<robot name='r'>{''.join(parts.values())}</robot>")
        for parts in (PARTS, PARTS | theirs)
    )
    return ghost_links(mine, other)


def hung(found: list[GhostLink]) -> list[tuple[str, str, bool, bool]]:
    return [(each.link.name, each.above, each.of_ghost, each.drawn) for each in found]


def test_what_is_the_same_is_not_drawn() -> None:
    assert ghosts() == []


def test_another_shape_hangs_at_the_link_itself_and_a_colour_is_none() -> None:
    blue = "<material name='m'><color rgba='0 0 1 1'/></material>"
    link = "<link name='arm'>{}</link>"
    assert ghosts(arm=link.format(BOX.format("1 1 1", blue))) == []
    (found,) = ghosts(arm=link.format(BOX.format("1 1 2", "")))
    assert hung([found]) == [("arm", "arm", False, True)]
    assert found.joint is None


@pytest.mark.parametrize(
    ("word", "other"),
    [
        ("1 0 0", "1.001 0 0"),
        ("'0 0 1'", "'0 0 -1'"),
        ("name='shoulder'", "name='s'"),
        ("continuous", "fixed"),
    ],
)
def test_a_moved_joint_takes_all_that_is_below_it_along(word: str, other: str) -> None:
    found = ghosts(shoulder=PARTS["shoulder"].replace(word, other))
    assert hung(found) == [("arm", "base", False, True), ("hand", "arm", True, True)]
    assert all(each.joint is not None for each in found)


def test_what_is_drawn_nowhere_only_holds_others() -> None:
    found = ghosts(
        shoulder=PARTS["shoulder"].replace("1 0 0", "2 0 0"), arm="<link name='arm'/>"
    )
    assert hung(found) == [("arm", "base", False, False), ("hand", "arm", True, True)]


def test_another_way_to_the_same_place_is_the_same() -> None:
    plate = (
        "<link name='plate'/><joint name='p' type='fixed'><parent link='arm'/>"
        "<child link='plate'/><origin xyz='0.5 0 0'/></joint>"
    )
    wrist = PARTS["wrist"].replace("'arm'", "'plate'").replace("1 0 0", "0.5 0 0")
    assert ghosts(wrist=plate + wrist) == []


def test_a_root_that_the_robot_lacks_is_below_its_root() -> None:
    foot = (
        "<link name='foot'>" + BOX.format("1 1 1", "") + "</link>"
        "<joint name='f' type='fixed'><parent link='foot'/><child link='base'/>"
        "<origin xyz='0 0 2'/></joint>"
    )
    (found,) = ghosts(base=PARTS["base"] + foot)
    assert hung([found]) == [("foot", "base", False, True)]
    assert found.T_above_link[2, 3] == pytest.approx(-2.0)
    assert ghosts(
        base=PARTS["base"].replace("name='base'", "name='body'"),
        shoulder=PARTS["shoulder"].replace("'base'", "'body'"),
    )[0].above == ("base")

"""Tasks with displays: their properties, boxes, order, names, and undo."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest
from ax_tree import Thing, rows_of
from desk import Desk
from judge import changed, corner, drawn, drawn_around, look_near

from sambot_viz.rviz import DisplayConfig

pytestmark = pytest.mark.browser

AT_ONCE = 12.0
WHEEL = "drivewhl_l_link"
GREY, WHITE = (48, 48, 48), (255, 255, 255)


def row(desk: Desk, *names: str) -> Thing:
    return desk.user.row("Displays", *names)


def tick(desk: Desk, *names: str) -> None:
    desk.user.click_on(row(desk, *names).one("checkbox"))


def displays(desk: Desk) -> list[DisplayConfig]:
    (session,) = desk.viz.server.sessions.all()
    return list(session.document.config.displays)


def names(desk: Desk) -> list[str]:
    """The displays in the order of the program."""
    return [display.name for display in displays(desk)]


def listed(desk: Desk) -> list[str]:
    """The displays in the order of the page."""
    grid = desk.user.see().one("treegrid", "Displays")
    labels = [path[0] for path, _ in rows_of(grid) if len(path) == 1]
    return [label for label in labels if not label.startswith("Global")]


def option(desk: Desk, name: str) -> Any:
    (session,) = desk.viz.server.sessions.all()
    return session.document.config.global_options.get(name)


def add_axes(desk: Desk) -> None:
    """Add an Axes display by the dialog; it is selected and open, and has the keys."""
    desk.user.click("button", "Add", ("region", "Displays"))
    desk.user.click("option", re.compile("^Axes"))
    desk.user.click("button", "Add", ("dialog", "Add Display"))
    desk.user.until(lambda: row(desk, "Axes").state("selected"))
    desk.user.until(lambda: row(desk, "Axes").state("expanded"))
    desk.user.until(lambda: row(desk, "Axes").state("focused"))


@pytest.mark.view
def test_task_21_make_the_robot_half_transparent(s: Desk) -> None:
    look_near(s)
    before = drawn_around(s, "base_link")
    s.user.unfold("Displays", "RobotModel")
    s.user.enter(row(s, "RobotModel", "Alpha").one("textbox"), "0.5")
    s.user.until(lambda: displays(s)[1].get("Alpha") == 0.5)
    s.user.until(lambda: changed(before, drawn_around(s, "base_link")) > 500, AT_ONCE)
    s.user.until(lambda: row(s, "RobotModel", "Alpha").one("textbox").value == "0.5")


TWO_LINKS = """<robot name="r">
<link name="base_link"><visual><geometry><box size="0.3 0.3 0.3"/></geometry></visual>
<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
<link name="bare"><visual><origin xyz="0.4 0 0"/><geometry><sphere radius="0.1"/>
</geometry></visual></link>
<joint name="j" type="fixed"><parent link="base_link"/><child link="bare"/></joint>
</robot>"""


@pytest.mark.view
def test_task_22_show_collision_shapes_and_back(
    make_desk: Callable[[str], Desk],
) -> None:
    desk = make_desk(TWO_LINKS)
    tick(desk, "TF")
    tick(desk, "Grid")
    look_near(desk)
    visuals = desk.user.until(lambda: drawn(desk) > 0.01 and drawn(desk))
    desk.user.unfold("Displays", "RobotModel")
    tick(desk, "RobotModel", "Visual Enabled")
    tick(desk, "RobotModel", "Collision Enabled")
    desk.user.until(lambda: 0.0005 < drawn(desk) < 0.2 * visuals, AT_ONCE)
    desk.user.reads("Without a collision shape: bare")
    tick(desk, "RobotModel", "Collision Enabled")
    tick(desk, "RobotModel", "Visual Enabled")
    desk.user.until(lambda: drawn(desk) == pytest.approx(visuals, rel=0.01), AT_ONCE)


@pytest.mark.view
def test_task_23_hide_one_link(s: Desk) -> None:
    look_near(s)
    before, beside = drawn_around(s, WHEEL, 15), drawn_around(s, "base_link", 10)
    s.user.unfold("Displays", "RobotModel")
    s.user.unfold("Displays", "RobotModel", "Links")
    link = "RobotModel", "Links", WHEEL
    tick(s, *link)
    s.user.until(lambda: changed(before, drawn_around(s, WHEEL, 15)) > 50, AT_ONCE)
    s.user.until(lambda: not row(s, *link).one("checkbox").is_on)
    assert changed(beside, drawn_around(s, "base_link", 10)) == 0
    tick(s, *link)
    s.user.until(lambda: changed(before, drawn_around(s, WHEEL, 15)) == 0, AT_ONCE)


@pytest.mark.view
def test_task_24_hide_one_frame_and_all_arrows(s: Desk) -> None:
    def white(frame: str) -> int:
        """Pixels of the name of a frame."""
        return int((drawn_around(s, frame, 50)[..., :3].min(axis=-1) > 170).sum())

    look_near(s)
    tick(s, "RobotModel")
    s.user.until(lambda: white(WHEEL) > 20 and white("front_caster") > 20, AT_ONCE)
    s.user.unfold("Displays", "TF")
    before = s.viewer.pixels()
    tick(s, "TF", "Show Arrows")
    s.user.until(lambda: changed(before, s.viewer.pixels()) > 50, AT_ONCE)
    s.user.until(lambda: white(WHEEL) > 20, AT_ONCE)
    s.user.unfold("Displays", "TF", "Frames")
    tick(s, "TF", "Frames", WHEEL)
    s.user.until(lambda: white(WHEEL) < 5, AT_ONCE)
    s.user.until(lambda: white("front_caster") > 20, AT_ONCE)


def test_task_25_add_axes_at_the_left_wheel(s: Desk) -> None:
    s.user.unfold("Displays", "Grid")
    s.user.row("Displays", "Grid", "Offset")
    before = s.user.until(lambda: all(r := s.user.rows("Displays")) and r)
    add_axes(s)
    kept = [label for label in s.user.rows("Displays") if label in before]
    assert [label for label in before if label in kept] == before
    field = row(s, "Axes", "Reference Frame").one("combobox")
    s.user.click_on(field)
    s.user.type("whl_l")
    s.user.until(
        lambda: (
            [o.name for o in s.user.see().all("option", re.compile("whl"))][:1]
            == [WHEEL]
        )
    )
    s.user.keys("Enter")
    s.user.until(
        lambda: row(s, "Axes", "Reference Frame").one("combobox").value == WHEEL
    )
    (axes,) = [d for d in displays(s) if d.name == "Axes"]
    s.user.until(lambda: axes.get("Reference Frame") == WHEEL)
    for name in ("Grid", "Axes"):
        s.user.until(lambda name=name: row(s, name).state("expanded"))


@pytest.mark.parametrize("pause", [False, True])
def test_task_26_rename_at_any_speed(s: Desk, pause: bool) -> None:
    add_axes(s)
    s.user.click("button", "Rename", ("region", "Displays"))
    s.user.find("textbox", "Name", ("treegrid", "Displays"))
    for letter in "Wheel axes here":
        s.user.keys(letter)
        if pause:
            s.viewer.wait_for_frames()
    s.user.keys("Enter")
    s.user.until(lambda: "Wheel axes here" in names(s))
    s.user.until(lambda: "Wheel axes here" in listed(s))
    tool = s.user.find("button", "Interact", ("toolbar", "Tools"))
    assert tool.is_on
    assert s.user.there("treegrid", "Joints")


def test_task_27_move_a_display_above_grid(s: Desk) -> None:
    add_axes(s)
    # As fast as a hand can; at the top, one more does nothing.
    s.user.keys(*["Alt+ArrowUp"] * 4)
    s.user.until(lambda: names(s)[:2] == ["Axes", "Grid"])
    s.user.until(lambda: listed(s) == names(s))
    s.user.until(lambda: row(s, "Axes").state("selected"))
    # And back by one drag.
    s.user.unfold("Displays", "Axes", fold=True)
    s.user.unfold("Displays", "TF", fold=True)
    x, y = s.user.go_to(row(s, "Axes").all("gridcell")[0])
    to = s.user.box(row(s, "TF"))
    s.page.mouse.drag((x, y), (x, to[1] + to[3] - 3), steps=20)
    s.user.until(lambda: names(s)[-1] == "Axes")
    s.user.until(lambda: listed(s) == names(s))
    s.user.until(lambda: row(s, "Axes").state("selected"))


def test_task_28_duplicate_delete_undo_redo(s: Desk) -> None:
    first = names(s)
    s.user.click_on(row(s, "Grid").all("gridcell")[0])
    s.user.click("button", "Duplicate", ("region", "Displays"))
    s.user.until(lambda: len(names(s)) == 4)
    both = names(s)
    assert len(set(both)) == 4
    s.user.until(lambda: listed(s) == both)
    copy = next(name for name in both if name not in first)
    s.user.until(lambda: row(s, copy).state("focused"))
    s.user.keys("Delete")
    for key, wanted in (
        ("", first),
        ("Control+z", both),
        ("Control+z", first),
        ("Control+Shift+z", both),
        ("Control+Shift+z", first),
    ):
        if key:
            s.user.keys(key)
        s.user.until(lambda w=wanted: names(s) == w)
        s.user.until(lambda w=wanted: listed(s) == w)


@pytest.mark.view
def test_task_29_the_background(s: Desk) -> None:
    def enter(text: str) -> None:
        s.user.enter(row(s, "Background Color").one("textbox"), text)

    def shows_color(text: str) -> None:
        s.user.until(lambda: row(s, "Background Color").one("textbox").value == text)

    enter("255; 255; 255")
    s.user.until(lambda: corner(s) == WHITE, AT_ONCE)
    enter("48; 48; 48")
    s.user.until(lambda: corner(s) == GREY, AT_ONCE)
    enter("not a colour")
    s.user.until(lambda: "must be a colour" in row(s, "Background Color").text)
    shows_color("48; 48; 48")
    s.user.pick_color(row(s, "Background Color").one("ColorWell"), "#ffffff")
    s.user.until(lambda: corner(s) == WHITE, AT_ONCE)
    shows_color("255; 255; 255")
    s.user.pick_color(row(s, "Background Color").one("ColorWell"), "#303030")
    s.user.until(lambda: corner(s) == GREY, AT_ONCE)


def test_task_30_a_fixed_frame_that_does_not_exist(s: Desk) -> None:
    s.user.enter(row(s, "Global Options", "Fixed Frame").one("combobox"), "map")
    s.user.until(lambda: option(s, "Fixed Frame") == "map")
    s.user.until(lambda: "Error" in row(s, "Global Status").text)
    status = "Global Status", "Fixed Frame"
    for said in ("Frame [map] does not exist", "base_link", WHEEL):
        s.user.until(lambda said=said: said in row(s, *status).text)
    for display in ("RobotModel", "TF"):
        s.user.unfold("Displays", display)
        s.user.until(lambda d=display: "Ok" not in row(s, d, "Status").text)
        s.user.unfold("Displays", display, "Status")
        s.user.until(lambda d=display: "map" in row(s, d, "Status", "base_link").text)
    frame = "Global Options", "Fixed Frame"
    s.user.until(lambda: row(s, *frame).one("combobox").value == "map")
    repair = s.user.until(lambda: row(s, "Global Status", "Fixed Frame").one("button"))
    # After a robot was driven here, its frames hang on odom.
    assert repair.name in ("Use base_link", "Use odom")
    s.user.click_on(repair)
    s.user.until(lambda: repair.name == f"Use {option(s, 'Fixed Frame')}")
    s.user.until(lambda: "Ok" in row(s, "Global Status").text)


def test_task_31_change_ten_times_and_undo_ten_times(s: Desk) -> None:
    def marked() -> bool:
        return s.user.see().name.startswith("urdf_config.rviz*")

    s.user.until(lambda: not marked())
    s.user.unfold("Displays", "Grid")
    size = displays(s)[0]
    for step in range(1, 11):
        value = 1 + 0.1 * step
        s.user.enter(row(s, "Grid", "Cell Size").one("textbox"), f"{value:g}")
        s.user.until(lambda v=value: size.get("Cell Size") == pytest.approx(v))
    s.user.until(marked)
    s.user.keys("Escape")
    for step in range(9, -1, -1):
        value = 1 + 0.1 * step
        s.user.keys("Control+z")
        s.user.until(lambda v=value: size.get("Cell Size") == pytest.approx(v))
    s.user.until(lambda: row(s, "Grid", "Cell Size").one("textbox").value == "1")
    s.user.until(lambda: not marked())

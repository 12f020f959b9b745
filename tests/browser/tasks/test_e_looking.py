"""Tasks with the view: mouse, types of views, saved views, pictures, hidden panels."""

from __future__ import annotations

import re

import pytest
from ax_tree import Thing
from desk import Desk
from judge import drawn, look_near, on_page
from PIL import Image

pytestmark = pytest.mark.browser

AT_ONCE = 12.0
SKY = (420.0, 120.0)
"""A place of the page with nothing but background."""


def row(desk: Desk, *names: str) -> Thing:
    return desk.user.row("Views", *names)


def number(desk: Desk, name: str) -> float:
    return float(row(desk, "Current View", name).one("textbox").value)


def set_number(desk: Desk, name: str, value: str) -> None:
    """Type a number of the view; the camera is there before a mouse may move it."""
    desk.user.enter(row(desk, "Current View", name).one("textbox"), value)
    desk.settle()


def is_near(desk: Desk, name: str, value: float, within: float = 0.01) -> bool:
    return abs(number(desk, name) - value) < within


@pytest.mark.slow
@pytest.mark.view
def test_task_39_look_exactly_from_above(s: Desk) -> None:
    # The scale of an orthographic view is in pixels of the drawn picture.
    s.viewer.set_resolution(1.0)
    views = ("region", "Views")
    s.user.choose(s.user.find("combobox", "Type", views), "TopDownOrtho")
    s.user.row("Views", "Current View", "Scale")
    s.settle()
    look_near(s)
    s.user.until(lambda: drawn(s) > 0.05, AT_ONCE)
    s.settle()
    middle = s.viewer.pixels()[::, ::, :3]
    height, width, _ = middle.shape
    assert tuple(middle[5, 5]) == (48, 48, 48)
    robot = middle[
        height // 2 - 20 : height // 2 + 20, width // 2 - 20 : width // 2 + 20
    ]
    assert (robot.astype(int).max(axis=-1) > 60).mean() > 0.5
    scale = number(s, "Scale")
    s.page.mouse.wheel(*SKY, dy=-300.0)
    s.user.until(lambda: number(s, "Scale") > 1.2 * scale)
    s.user.until(lambda: drawn(s) > 0.05, AT_ONCE)
    s.page.mouse.drag(SKY, (SKY[0], SKY[1] + 200), button="right")
    s.user.until(lambda: number(s, "Scale") < scale)
    s.user.until(lambda: drawn(s) > 0.001, AT_ONCE)
    for scale in ("300", "100"):
        set_number(s, "Scale", scale)
        s.user.until(lambda: drawn(s) > 0.001, AT_ONCE)
    s.user.choose(s.user.find("combobox", "Type", views), "Orbit")
    s.user.row("Views", "Current View", "Distance")


@pytest.mark.slow
@pytest.mark.view
def test_task_40_the_mouse_as_in_rviz(s: Desk) -> None:
    set_number(s, "Distance", "3")
    set_number(s, "Yaw", "1")
    set_number(s, "Pitch", "0.5")
    s.user.until(lambda: is_near(s, "Pitch", 0.5))
    mouse, (x, y) = s.page.mouse, SKY
    mouse.drag(SKY, (x - 40, y))
    s.user.until(lambda: is_near(s, "Yaw", 1.2))
    mouse.drag(SKY, (x, y + 40))
    s.user.until(lambda: is_near(s, "Pitch", 0.7))
    mouse.wheel(*SKY, dy=-100.0)
    s.user.until(lambda: is_near(s, "Distance", 2.64))
    mouse.drag(SKY, (x, y + 40), button="right")
    s.user.until(lambda: abs(number(s, "Distance") - 2.64) > 0.1)
    point = row(s, "Focal Point").one("textbox").value
    for moves in ({"button": "middle"}, {}):
        shift = () if moves else ("Shift",)
        mouse.drag(SKY, (x + 50, y), *shift, **moves)
        s.user.until(lambda p=point: row(s, "Focal Point").one("textbox").value != p)
        point = row(s, "Focal Point").one("textbox").value
    s.settle()
    assert is_near(s, "Yaw", 1.2) and is_near(s, "Pitch", 0.7)
    set_number(s, "Pitch", "1.5697")
    s.user.until(lambda: is_near(s, "Pitch", 1.5697, 0.001))
    mouse.drag(SKY, (x + 60, y + 30), button="middle")
    s.user.until(lambda: row(s, "Focal Point").one("textbox").value != point)
    s.settle()
    assert is_near(s, "Yaw", 1.2)


@pytest.mark.view
def test_task_41_bring_a_lost_robot_back(s: Desk) -> None:
    look_near(s)
    near = drawn(s)
    set_number(s, "Focal Point", "80; 0; 0")
    s.user.until(lambda: drawn(s) < 0.2 * near, AT_ONCE)
    s.page.mouse.click(*SKY)
    s.user.keys("f")
    s.user.until(lambda: drawn(s) == pytest.approx(near, rel=0.2), AT_ONCE)
    # Neither does the ground between the lines of the grid take the view away.
    set_number(s, "Distance", "2.5")
    s.user.until(lambda: drawn(s) < 0.5 * near, AT_ONCE)
    # The middle of a cell of the grid, on this side of the robot.
    cells = [on_page(s, x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.5, 0.5)]
    s.page.mouse.click(*max(cells, key=lambda at: at[1]))
    s.user.keys("f")
    s.user.until(lambda: drawn(s) == pytest.approx(near, rel=0.2), AT_ONCE)


def test_task_42_keep_a_view_and_return_to_it(s: Desk) -> None:
    set_number(s, "Distance", "1.7")
    set_number(s, "Yaw", "2.2")
    s.user.until(lambda: is_near(s, "Yaw", 2.2))
    before = s.user.rows("Views")
    s.user.click("button", "Save", ("region", "Views"))
    saved = s.user.new_row("Views", before)
    assert "Orbit" in saved
    set_number(s, "Distance", "5")
    set_number(s, "Yaw", "0.3")
    s.user.until(lambda: is_near(s, "Yaw", 0.3))
    s.user.click_on(row(s, saved).all("gridcell")[0])
    s.user.click("button", "Go to", ("region", "Views"))
    s.user.until(lambda: is_near(s, "Yaw", 2.2) and is_near(s, "Distance", 1.7))
    s.user.click("button", "Remove", ("region", "Views"))
    s.user.until(lambda: saved not in s.user.rows("Views"))


@pytest.mark.view
def test_task_43_make_a_picture_for_the_report(s: Desk) -> None:
    s.user.menu("File", re.compile("^Save Image"))
    for side, size in (("Width", "1280"), ("Height", "720")):
        s.user.enter(s.user.find("spinbutton", side), size, end="")
    s.user.click("button", "Save", ("dialog", "Save Image"))
    s.user.reads("Saved sam_bot.png, 1280 × 720 pixels", timeout=30.0)
    file = s.user.until(lambda: [*s.downloads.glob("*.png")], 30.0)[0]
    with Image.open(file) as image:
        assert image.size == (1280, 720)
        corners = [image.convert("RGB").getpixel(at) for at in ((0, 0), (1279, 719))]
    assert corners[0] == (48, 48, 48)
    file.unlink()


def test_task_44_see_more_of_the_scene(s: Desk) -> None:
    before = s.viewer.view_box()
    for hide in (
        lambda: s.user.click("button", "Hide panels"),
        lambda: s.user.keys("h"),
        lambda: s.user.menu("Panels", re.compile("^Hide all")),
    ):
        hide()
        s.user.gone("treegrid")
        s.user.until(lambda: s.viewer.view_box() == (0, 0, 1280, 720), AT_ONCE)
        back = s.user.find("button", "Show panels (H)")
        s.user.until(lambda back=back: s.user.can_see(back))
        s.user.click_on(back)
        s.user.find("treegrid", "Joints")
        s.user.until(lambda: s.viewer.view_box() == before, AT_ONCE)
    for is_there in (False, True):
        s.user.menu("Panels", "Displays")
        s.user.until(lambda n=is_there: s.user.there("treegrid", "Displays") == n)
    s.user.until(lambda: s.viewer.view_box() == before, AT_ONCE)
    width = before[2]
    for side in ("left", "right"):
        s.user.click("button", f"Hide the {side} panels")
        s.user.until(lambda: s.viewer.view_box()[2] > width + 250, AT_ONCE)
        s.user.click("button", f"Show the {side} panels")
        s.user.until(lambda: s.viewer.view_box() == before, AT_ONCE)

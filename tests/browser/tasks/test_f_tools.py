"""Tasks with tools: measuring, selecting, going from tool to tool."""

from __future__ import annotations

import re
from itertools import chain, pairwise, permutations

import pytest
from desk import Desk
from judge import on_page

pytestmark = pytest.mark.browser

TOOLS = ("toolbar", "Tools")
LEFT, RIGHT = "drivewhl_l_link", "drivewhl_r_link"
KEYS = {
    "Interact": "i",
    "Move Camera": "m",
    "Select": "s",
    "Focus Camera": "c",
    "Measure": "n",
}


def look(desk: Desk, yaw: str, pitch: str, distance: str = "1.2") -> None:
    """Look at the middle of the robot from a side."""
    for name, value in (
        ("Focal Point", "0; 0; 0"),
        ("Distance", distance),
        ("Yaw", yaw),
        ("Pitch", pitch),
    ):
        field = desk.user.row("Views", "Current View", name).one("textbox")
        desk.user.enter(field, value)
    desk.settle()


def selected(desk: Desk) -> list[str]:
    """The names in the Selection panel."""
    rows = desk.user.rows("Selection")
    return [r.removeprefix("Link ") for r in rows if r.startswith("Link ")]


@pytest.mark.view
def test_task_45_measure_the_height_of_the_body(s: Desk) -> None:
    look(s, "0", "0.2")
    for grid in (True, False):
        box = s.user.row("Displays", "Grid").one("checkbox")
        if box.is_on != grid:
            s.user.click_on(box)
        s.choose_tool("Measure")
        # Along the edge at the front, the grid is at half of its height.
        s.page.mouse.click(*on_page(s, 0.209, 0.1, 0.088))
        s.user.reads("second point")
        s.page.mouse.click(*on_page(s, 0.209, 0.1, -0.088))
        length = s.user.until(
            lambda: re.search(r"([\d.]+) m\. Click", s.user.see().text)
        )
        assert float(length[1]) == pytest.approx(0.18, abs=0.012)
        s.user.keys("Escape")
        s.has_tool("Interact")


def test_task_46_measure_the_wheel_base(s: Desk) -> None:
    s.user.tab("Frames")
    for end, frame in (("From", LEFT), ("To", RIGHT)):
        s.user.enter(s.user.row("Frames", end).one("combobox"), frame)
    s.user.until(lambda: "0 -0.36 0" in s.user.row("Frames", "Position x y z [m]").text)


@pytest.mark.view
def test_task_47_click_on_the_lower_half_of_a_wheel(s: Desk) -> None:
    look(s, "1.57", "0.1")
    s.user.tab("Selection")
    s.choose_tool("Select")
    s.page.mouse.click(*on_page(s, 0.0, 0.02, -0.07, frame=LEFT))
    s.user.until(lambda: selected(s) == [LEFT])
    for fact in ("-0.12; 0.18; -0.05", "base_link", "drivewhl_l_joint", ".xacro:"):
        s.user.until(
            lambda fact=fact: fact in s.user.find("treegrid", "Selection").text
        )
    s.user.click_on(s.user.find("button", "Interact", TOOLS))


@pytest.mark.view
def test_task_48_select_by_rectangle_add_and_take_away(s: Desk) -> None:
    look(s, "0.9", "0.6", "1.5")
    s.user.click_on(s.user.row("Displays", "TF").one("checkbox"))
    s.user.until(lambda: not s.user.row("Displays", "TF").one("checkbox").is_on)
    s.user.tab("Selection")
    s.choose_tool("Select")
    x, y = on_page(s, frame=LEFT)
    s.page.mouse.drag((x - 6, y - 6), (x + 6, y + 6))
    s.user.until(lambda: selected(s) == [LEFT])
    top = on_page(s, 0.0, 0.0, 0.09)
    s.page.mouse.click(*top, "left", "Shift")
    s.user.until(lambda: set(selected(s)) == {LEFT, "base_link"})
    s.page.mouse.click(*top, "left", "Control")
    s.user.until(lambda: selected(s) == [LEFT])
    around = [on_page(s, x, y, 0.0) for x in (-0.4, 0.4) for y in (-0.4, 0.4)]
    low = min(p[0] for p in around), min(p[1] for p in around)
    high = max(p[0] for p in around), max(p[1] for p in around)
    s.page.mouse.drag(low, high)
    s.user.until(lambda: {LEFT, "base_link"} <= set(selected(s)))


def test_task_49_from_any_tool_to_any_other(s: Desk) -> None:
    tools = list(KEYS)
    pairs = [(a, b) for n, a in enumerate(tools) for b in tools[n + 1 :]]
    path = [*chain.from_iterable(pairs), tools[0]]
    assert sorted(pairwise(path)) == sorted(permutations(tools, 2)), "each way once"

    def choose(tool: str) -> None:
        s.user.click("button", tool, TOOLS)
        s.has_tool(tool)

    for tool in path:
        choose(tool)
    grid = s.user.row("Displays", "Grid").one("checkbox")
    slider = s.user.row("Joints", "drivewhl_l_joint").one("slider")
    for used in (grid, slider):
        for tool, key in KEYS.items():
            s.user.click_on(used)
            other = "Measure" if tool != "Measure" else "Select"
            choose(other)
            s.user.click_on(used)
            s.user.keys(key)
            s.has_tool(tool)


def test_task_50_letters_of_tool_keys_in_text_fields(t: Desk) -> None:
    user, letters = t.user, "imscn fzrh 8246"
    user.unfold("Displays", "TF")
    view = [user.row("Views", name).text for name in ("Yaw", "Pitch", "Distance")]
    fields = [
        lambda: user.row("Displays", "TF", "Filter (whitelist)").one("textbox"),
        lambda: user.row("Displays", "Global Options", "Fixed Frame").one("combobox"),
        lambda: user.find("searchbox", "Search joints"),
        lambda: user.row("Joints", "torso_yaw_joint").one("textbox"),
        lambda: user.row("Views", "Current View", "Distance").one("textbox"),
    ]
    for field in fields:
        user.click_into(field())
        user.type(letters)
        user.until(lambda f=field: f().value == letters)
        user.keys("Escape")
    # One click on a number selects its row: what is typed then replaces the number.
    pitch = ("Views", "Current View", "Pitch")
    user.click_on(user.row(*pitch).one("textbox"))
    user.type(letters)
    user.until(lambda: user.row(*pitch).one("textbox").value == letters)
    user.keys("Escape")
    user.click_on(user.row("Displays", "Grid").all("gridcell")[0])
    user.keys("F2")
    user.type(letters)
    user.keys("Enter")
    user.row("Displays", letters)
    t.has_tool("Interact")
    assert user.there("treegrid", "Joints") and user.there("treegrid", "Views")
    after = [user.row("Views", name).text for name in ("Yaw", "Pitch", "Distance")]
    assert after == view

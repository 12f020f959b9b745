"""More tasks with views, groups, fields and dialogs."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
import yaml
from ax_tree import Thing
from desk import Desk
from judge import on_page

from sambot_viz import bundled

pytestmark = pytest.mark.browser

OFFSET = "Displays", "Grid", "Offset"
VIEWS = ("region", "Views")


def grouped() -> str:
    """The config of the program, with a folded group as navigation robots have."""
    config = yaml.safe_load(bundled.config_path().read_text("utf-8"))
    maps = [
        {"Class": "rviz_default_plugins/Map", "Name": n} for n in ("Global", "Local")
    ]
    group = {"Class": "rviz_common/Group", "Name": "Planner", "Displays": maps}
    config["Visualization Manager"]["Displays"].append(group)
    return yaml.safe_dump(config)


def test_task_66_a_display_goes_into_a_group_and_back(
    sit: Callable[..., Desk],
) -> None:
    desk = sit("S grouped", grouped())
    user = desk.user
    displays = desk.session.document.config
    names = [display.name for display in displays.displays]
    for name in ("Planner", "TF", "RobotModel"):
        user.unfold("Displays", name, fold=True)
    before = user.rows("Displays")
    x, y = user.go_to(user.row("Displays", "Grid").all("gridcell")[0])
    _, top, _, height = user.box(user.row("Displays", "Planner"))
    desk.page.mouse.drag((x, y), (x, top + height / 2), steps=20)
    # The group opens, and the display is selected in it.
    user.until(lambda: user.row("Displays", "Planner", "Grid").state("selected"))
    user.until(lambda: user.row("Displays", "Planner").state("expanded"))
    assert "Grid" not in [display.name for display in displays.displays]
    # By keys it goes out of the group and into it again, in the same place.
    user.keys("Escape")
    for key, level in (("ArrowDown", 1), ("ArrowUp", 2)):
        user.keys(f"Alt+{key}")
        user.until(lambda n=level: user.row("Displays", "Grid").states["level"] == n)
    # And out of it by a drag, to the first place.
    x, y = user.go_to(user.row("Displays", "Planner", "Grid").all("gridcell")[0])
    _, top, _, height = user.box(user.row("Displays", "RobotModel"))
    desk.page.mouse.drag((x, y), (x, top + 0.1 * height), steps=20)
    user.until(lambda: [display.name for display in displays.displays] == names)
    for _ in range(4):
        user.keys("Control+z")
    user.until(lambda: [display.name for display in displays.displays] == names)
    user.until(lambda: [n for n in user.rows("Displays") if n in before] == before)


def number(desk: Desk, name: str) -> float:
    return float(desk.user.row("Views", "Current View", name).one("textbox").value)


def choose_view(desk: Desk, kind: str) -> None:
    desk.user.choose(desk.user.find("combobox", "Type", VIEWS), kind)
    desk.user.until(lambda: kind in desk.user.row("Views", "Current View").text)
    # The package of RViz's own types would cut the name off.
    desk.user.until(
        lambda: (
            desk.user.find("combobox", "Type", VIEWS).value == kind
            and "plugins" not in desk.user.row("Views", "Current View").text
        )
    )
    desk.settle()


@pytest.mark.view
@pytest.mark.parametrize(
    "kind",
    [
        pytest.param("XYOrbit", marks=pytest.mark.slow),
        pytest.param("ThirdPersonFollower", marks=pytest.mark.slow),
        "FPS",
    ],
)
def test_task_67_look_at_a_robot_that_drives(s: Desk, kind: str) -> None:
    user, drive = s.user, s.session.drive
    choose_view(s, kind)
    if kind != "FPS":
        frame = user.row("Views", "Current View", "Target Frame").one("combobox")
        user.enter(frame, "base_link")
        s.settle()
    numbers = ("Yaw", "Pitch", *(() if kind == "FPS" else ("Distance",)))
    before = {n: user.row("Views", "Current View", n).text for n in numbers}
    user.tab("Drive")
    for name, value in (("Linear speed", "0.5"), ("Angular speed", "0.5")):
        user.enter(user.row("Drive", name).one("textbox"), value)
    user.until(lambda: drive.pose.x > 0.3 and drive.pose.yaw > 0.5)
    user.click("button", re.compile("Stop"), ("group", "Drive"))
    user.until(lambda: not drive.moving)
    s.settle()
    assert {n: user.row("Views", "Current View", n).text for n in numbers} == before
    if kind != "FPS":
        # The target stays in the middle of the view, from side to side.
        left, top, width, height = s.page.evaluate(
            "(r => [r.x, r.y, r.width, r.height])"
            "(__viserMutable.canvas.getBoundingClientRect())"
        )
        x, y = on_page(s, frame="base_link")
        assert abs(x - left - width / 2) < 0.1 * width
        assert abs(y - top - height / 2) < 0.5 * height
    user.click("button", "Back to start", ("group", "Drive"))
    user.until(lambda: drive.pose.x == drive.pose.yaw == 0.0)
    user.until(lambda: s.fixed_frame != "odom")
    choose_view(s, "Orbit")


def test_task_68_a_saved_view_and_a_property_of_a_tool_come_back(s: Desk) -> None:
    user = s.user
    user.menu("View", re.compile("^Top"))
    user.until(lambda: "Angle" in user.rows("Views"))
    before = user.rows("Views")
    user.click("button", "Save", VIEWS)
    saved = user.new_row("Views", before)

    def is_seen() -> bool:
        place = user.place(user.row("Views", saved))
        return bool(place["seen"] == place["all"])

    # Orbit has more rows.
    user.until(is_seen)
    user.menu("View", re.compile("^Front"))
    user.until(lambda: len(user.rows("Views")) > len(before) + 1)
    user.until(is_seen)
    user.click_on(user.row("Views", saved).all("gridcell")[0])
    user.click("button", "Remove", VIEWS)
    user.until(lambda: saved not in user.rows("Views"))
    user.click("button", "Undo")
    user.until(lambda: saved in user.rows("Views"))
    for _ in range(2):
        user.click("button", "Undo")
    user.until(lambda: saved not in user.rows("Views"))
    user.tab("Tool Properties")
    user.unfold("Tool Properties", "Measure")

    def color() -> str:
        row = user.row("Tool Properties", "Measure", "Line color")
        return str(row.one("textbox").value)

    first = color()
    user.enter(
        user.row("Tool Properties", "Measure", "Line color").one("textbox"), "1; 2; 3"
    )
    user.until(lambda: color() == "1; 2; 3")
    user.click("button", "Undo")
    user.until(lambda: color() == first)


def test_task_69_vectors_in_every_form(s: Desk) -> None:
    user = s.user
    user.unfold("Displays", "Grid")

    def row() -> Thing:
        return user.row(*OFFSET)

    def enter(text: str) -> None:
        user.enter(row().one("textbox"), text)

    grid = s.session.document.config.displays[0]
    for text, value in (
        ("pi/2; 1/3; -5cm", (1.570796, 1 / 3, -0.05)),
        ("4 5 6", (4.0, 5.0, 6.0)),
    ):
        enter(text)
        user.until(lambda v=value: grid.get("Offset") == pytest.approx(v, abs=1e-5))
    user.until(lambda: row().one("textbox").value == "4; 5; 6")
    # A comma is that of "1,5".
    for text in ("1; 2", "1; 2; 3; 4", "1,2,3", "a;b;c"):
        enter(text)
        user.until(lambda: "Enter 3 numbers" in row().text)
        user.until(lambda: row().one("textbox").value == "4; 5; 6")
        # The reason goes with Tab, so that the next one is its own.
        user.keys("Tab")
        user.until(lambda: not row().all("alert"))
    assert grid.get("Offset") == (4.0, 5.0, 6.0)
    # One part of it at a time.
    user.unfold(*OFFSET)
    user.enter(user.row(*OFFSET, "Y").one("textbox"), "2")
    user.enter(user.row(*OFFSET, "Z").one("textbox"), "50 cm")
    user.until(lambda: grid.get("Offset") == (4.0, 2.0, 0.5))
    user.until(lambda: row().one("textbox").value == "4; 2; 0.5")


def test_task_70_a_mistake_and_a_click_elsewhere(s: Desk) -> None:
    user = s.user
    user.unfold("Displays", "Grid")
    size = "Displays", "Grid", "Cell Size"
    user.enter(user.row(*size).one("textbox"), "one", end="")
    user.click_on(user.row("Displays", "RobotModel").all("gridcell")[0])
    user.reads("not a number")
    user.until(lambda: user.row(*size).one("textbox").value == "1")
    assert s.session.document.config.displays[0].get("Cell Size") == 1.0


def test_task_71_add_a_display_by_the_keyboard_alone(s: Desk) -> None:
    user = s.user
    user.click_on(user.row("Displays", "Grid").all("gridcell")[0])
    user.keys("Shift+F10")
    user.find("menu", "Grid")
    user.keys("Escape")
    user.gone("menu", "Grid")
    user.until(lambda: user.row("Displays", "Grid").state("focused"))
    user.keys("Shift+F10")
    user.find("menuitem", "Duplicate", ("menu", "Grid"))
    user.keys("d", "Enter")
    user.until(lambda: user.row("Displays", "Grid (2)").state("focused"))
    user.keys("Shift+F10")
    user.find("menuitem", "Add…", ("menu", "Grid (2)"))
    user.keys("Enter")
    user.find("dialog", "Add Display")
    s.page.keyboard.type_quickly("ro")
    user.until(lambda: user.find("option", re.compile("^RobotModel")).state("selected"))
    user.keys("ArrowUp", "ArrowDown")
    user.until(lambda: user.find("option", re.compile("^RobotModel")).state("selected"))
    user.keys("Tab")
    user.type("One more")
    user.keys("Enter")
    user.gone("dialog")
    user.until(lambda: user.row("Displays", "One more").state("selected"))
    kinds = {d.name: d.class_id for d in s.session.document.config.displays}
    assert kinds["One more"].endswith("/RobotModel")


def test_task_77_find_a_row_in_a_long_tree(sit: Callable[..., Desk]) -> None:
    desk = sit("S grouped", grouped())
    user = desk.user
    whole = user.rows("Displays")
    user.click_on(user.find("searchbox", "Search displays"))
    user.type("show arrows")
    user.until(lambda: user.rows("Displays") == ["TF", "Show Arrows"])
    user.click_on(user.row("Displays", "TF", "Show Arrows").one("checkbox"))
    tf = desk.session.document.config.displays[2]
    user.until(lambda: tf.get("Show Arrows") is False)
    user.click_on(user.find("searchbox", "Search displays"))
    user.keys("Escape")
    user.until(lambda: [n for n in user.rows("Displays") if n in whole] == whole)
    # A display in a folded group, by the keyboard alone.
    user.keys("Control+k")
    user.find("dialog", "Go to")
    user.type("local")
    user.until(lambda: user.find("option", re.compile("^Local")).state("selected"))
    user.keys("Enter")
    user.gone("dialog")
    user.until(lambda: user.row("Displays", "Planner", "Local").state("focused"))

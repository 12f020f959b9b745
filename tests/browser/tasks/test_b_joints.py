"""Tasks with joints: sliders, numbers, degrees, wheels, names, poses."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
import yaml
from ax_tree import Thing, rows_of
from desk import Desk
from judge import changed, drawn_around, look_near
from robots import LONG_NAME, SLIDE

from sambot_viz.session.signals import connect

pytestmark = pytest.mark.browser

LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"
DIGITS = 6e-5
"""A number beside a slider is rounded to so much [rad]."""
AT_ONCE = 12.0
"""On a machine without a graphics card [s]."""


def row(desk: Desk, joint: str) -> Thing:
    return desk.user.row("Joints", joint)


def field(desk: Desk, joint: str) -> str:
    """What the number of a joint shows."""
    return str(row(desk, joint).one("textbox").value)


def enter(desk: Desk, joint: str, text: str) -> None:
    desk.user.enter(row(desk, joint).one("textbox"), text)


def shows(desk: Desk, joint: str, value: float) -> None:
    """Wait until field, slider and robot agree on a value, in radians or metres."""
    user = desk.user
    shown = pytest.approx(value, abs=DIGITS)
    user.until(lambda: float(field(desk, joint)) == shown)
    # A screen reader is told of a slider's value a little later.
    user.until(lambda: float(row(desk, joint).one("slider").value) == shown)
    user.until(lambda: desk.viz.joint_positions[joint] == pytest.approx(value))


def test_task_07_turn_a_wheel_to_exactly_1_5_by_typing(s: Desk) -> None:
    passed: list[float] = []
    session = s.viz.server.sessions.all()[0]
    disconnect = connect(
        [session.robot.positions], lambda: passed.append(s.viz.joint_positions[LEFT])
    )
    enter(s, LEFT, "1.5")
    shows(s, LEFT, 1.5)
    disconnect()
    assert field(s, LEFT) == "1.5"
    assert set(passed) <= {0.0, 1.5}


def test_task_08_type_what_is_no_value(s: Desk) -> None:
    meant = {"pi/2": math.pi / 2, "90deg": math.pi / 2, "1e-3": 0.001, "1,5": 1.5}
    for text, value in meant.items():
        enter(s, LEFT, text)
        shows(s, LEFT, value)
    reasons = {"abc": "not a number", "": "Enter a number"}
    for text, reason in reasons.items():
        enter(s, LEFT, text)
        s.user.until(lambda reason=reason: reason in row(s, LEFT).text)
        shows(s, LEFT, 1.5)
    # A wheel has no limits: the same angle is shown from −π to π.
    enter(s, LEFT, "9")
    s.user.until(lambda: "Enter a number" not in row(s, LEFT).text)
    shows(s, LEFT, 9 - 2 * math.pi)


@pytest.mark.view
def test_task_09_drag_a_slider_to_and_fro(s: Desk) -> None:
    look_near(s)
    before = drawn_around(s, "drivewhl_l_link")
    slider = row(s, LEFT).one("slider")
    s.user.drag_slider(slider, 2.5, -2.5, 1.0, -2.0, 0.8, steps=12)
    s.user.until(lambda: abs(float(field(s, LEFT)) - 0.8) < 0.2)
    shows(s, LEFT, float(field(s, LEFT)))
    s.user.until(
        lambda: changed(before, drawn_around(s, "drivewhl_l_link")) > 20, AT_ONCE
    )


def test_task_10_move_a_joint_with_the_arrow_keys(s: Desk) -> None:
    view = [s.user.row("Views", name).text for name in ("Yaw", "Pitch", "Distance")]
    s.user.click_on(row(s, LEFT).one("slider"))
    enter(s, LEFT, "0.3")
    shows(s, LEFT, 0.3)
    s.user.keys("Shift+Tab")
    s.user.until(lambda: row(s, LEFT).one("slider").state("focused"))
    for key, value in (
        ("ArrowRight", 0.31),
        ("ArrowUp", 0.32),
        ("ArrowLeft", 0.31),
        ("Shift+ArrowRight", 0.41),
        ("PageUp", 0.51),
        ("Shift+ArrowLeft", 0.41),
    ):
        s.user.keys(key)
        shows(s, LEFT, value)
    s.user.keys("Tab", "ArrowUp")
    shows(s, LEFT, 0.42)
    s.user.keys("Shift+ArrowDown")
    shows(s, LEFT, 0.32)
    after = [s.user.row("Views", name).text for name in ("Yaw", "Pitch", "Distance")]
    assert after == view


def test_task_11_roll_the_wheel_over_the_list(c: Desk) -> None:
    positions = dict(c.viz.joint_positions)
    number = row(c, "joint_3").one("textbox")
    c.user.click_on(number)
    left, top, width, height = c.user.box(number)
    c.page.mouse.wheel(left + width / 2, top + height / 2, 100.0)
    c.user.until(lambda: c.user.box(row(c, "joint_3").one("textbox"))[1] < top - 50)
    assert c.viz.joint_positions == positions
    assert field(c, "joint_3") == "0"


def test_task_12_middle_random_and_back(s: Desk) -> None:
    enter(s, LEFT, "1.5")
    shows(s, LEFT, 1.5)
    s.user.click("button", "Center")
    shows(s, LEFT, 0.0)
    s.user.click("button", "Randomize")
    s.user.until(lambda: 0.0 not in s.viz.joint_positions.values())
    for joint in (LEFT, RIGHT):
        shows(s, joint, s.viz.joint_positions[joint])
    s.user.click("button", "Undo")
    shows(s, LEFT, 0.0)
    s.user.click("button", "Undo")
    shows(s, LEFT, 1.5)
    shows(s, RIGHT, 0.0)


def test_task_13_read_type_limits_parent_and_child(t: Desk) -> None:
    user, name = t.user, "left_elbow_joint"
    thing = row(t, name)
    label = thing.all("gridcell")[0]
    t.page.mouse.move(*user.go_to(label))
    for fact in ("revolute", "left_shoulder_yaw → left_elbow", "−1.5 … 1.5 rad"):
        user.reads(fact)
    for kind in ("slider", "textbox"):
        user.until(lambda kind=kind: user.can_see(row(t, name).one(kind)))


def test_task_14_values_in_degrees(l: Desk, s: Desk) -> None:  # noqa: E741
    for desk in (l, s):
        desk.user.click("button", "Degrees")
    l.user.until(lambda: "°" in row(l, LONG_NAME).text)
    enter(l, LONG_NAME, "45")
    shown = math.radians(45)
    l.user.until(lambda: l.viz.joint_positions[LONG_NAME] == pytest.approx(shown))
    l.user.until(lambda: field(l, LONG_NAME) == "45")
    enter(l, SLIDE, "0.25")
    l.user.until(lambda: l.viz.joint_positions[SLIDE] == 0.25)
    assert "m" in row(l, SLIDE).text.split()
    assert "°" not in row(l, SLIDE).text
    s.user.enter(s.user.find("textbox", "Turn rate"), "1 rad")
    s.user.until(lambda: s.user.find("textbox", "Turn rate").value == "57.2958")
    s.user.reads("°/s")
    for desk in (l, s):
        desk.user.click("button", "Degrees")
        desk.user.until(lambda d=desk: "rad" in d.user.see().text)


def test_task_15_let_a_wheel_keep_turning(s: Desk) -> None:
    def turned() -> float:
        return s.viz.joint_positions[LEFT]

    s.user.click("button", f"Turn {LEFT}")
    s.user.until(lambda: turned() != 0.0)
    s.user.enter(s.user.find("textbox", "Turn rate"), "-3")
    s.user.until(lambda: s.user.find("textbox", "Turn rate").value == "-3")
    first = turned()
    s.user.until(lambda: turned() != first)
    s.user.click("button", re.compile(f"(Turn|Stop) {LEFT}"))
    s.user.until(lambda: not s.user.find("button", re.compile(LEFT)).is_on)
    shows(s, LEFT, turned())
    assert s.viz.joint_positions[RIGHT] == 0.0


def test_task_16_read_the_longest_name(l: Desk) -> None:  # noqa: E741
    user = l.user

    def label() -> Thing:
        cell = row(l, LONG_NAME).all("gridcell")[0]
        return cell.one("StaticText", LONG_NAME)

    assert user.is_cut_off(label())
    l.page.mouse.move(*user.go_to(row(l, LONG_NAME).all("gridcell")[0]))
    user.has_tip(LONG_NAME)
    edge = user.find("separator", "Width of the right panels")
    x, y = user.go_to(edge)
    l.page.mouse.drag((x, y), (x - 260, y))
    user.until(lambda: not user.is_cut_off(label()))
    _, _, _, height = user.box(label())
    assert height < 22, "one line"
    assert user.can_see(row(l, LONG_NAME).one("slider"))
    l.page.mouse.drag((x - 260, y), (x, y))


def test_task_17_two_joints_of_a_humanoid(t: Desk) -> None:
    user = t.user

    def seen() -> list[str]:
        rows = rows_of(user.see().one("treegrid", "Joints"))
        return [p[-1] for p, r in rows if r.all("slider") and user.can_see(r)]

    user.until(lambda: len(seen()) >= 12)
    longest = row(t, "left_shoulder_pitch_joint")
    assert not user.is_cut_off(longest.all("gridcell")[0].all("StaticText")[0])
    assert user.box(longest.one("slider"))[2] >= 90
    # So near together that one turn of the wheel, if any, leads to each.
    for joint, value in (("left_elbow_joint", 0.7), ("right_knee_joint", -0.4)):
        turns = t.page.mouse.turns
        enter(t, joint, str(value))
        assert t.page.mouse.turns - turns <= 3
        user.until(lambda j=joint, v=value: t.viz.joint_positions[j] == v)


def test_task_18_one_joint_of_three_hundred(c: Desk) -> None:
    name, user = "joint_257", c.user
    user.unfold("Joints", "joint_251 … joint_275 (25)")
    enter(c, name, "0.25")
    shows(c, name, 0.25)
    assert user.can_see(row(c, name).one("textbox"))
    search = user.find("searchbox", "Search joints")
    user.click_on(search)
    user.type("joint_257")
    user.until(
        lambda: user.rows("Joints")[-1:] == [name] and len(user.rows("Joints")) < 4
    )
    user.until(lambda: user.find("searchbox", "Search joints").value == "joint_257")
    enter(c, name, "0.5")
    shows(c, name, 0.5)
    user.click_on(user.find("searchbox", "Search joints"))
    user.keys("Escape")
    user.until(lambda: len(user.rows("Joints")) > 50)


def test_task_19_a_saved_pose_is_there_after_a_restart(own: Desk) -> None:
    user = own.user
    enter(own, LEFT, "0.75")
    shows(own, LEFT, 0.75)
    user.click("button", "Poses")
    user.enter(user.find("textbox", "Name of the pose"), "half way")
    user.find("button", "Remove pose half way")
    named = user.until(lambda: re.search(r"/\S+\.yaml", user.see().text))
    file = Path(named[0])
    assert yaml.safe_load(file.read_text("utf-8")) == {
        "half way": {LEFT: 0.75, RIGHT: 0.0}
    }
    user.keys("Escape")
    # With a pose there, too, the cursor is in the field: Enter saves another one.
    enter(own, LEFT, "0.5")
    user.click("button", "Poses")
    user.type("reach")
    user.keys("Enter")
    user.find("button", "Remove pose reach")
    shows(own, LEFT, 0.5)
    assert yaml.safe_load(file.read_text("utf-8"))["reach"] == {LEFT: 0.5, RIGHT: 0.0}
    own.restart()
    user = own.user
    shows(own, LEFT, 0.0)
    user.click("button", "Poses")
    user.click(re.compile("menuitem|button|option"), "half way")
    shows(own, LEFT, 0.75)


def test_task_20_copy_the_values_for_a_launch_file(s: Desk) -> None:
    enter(s, LEFT, "1.25")
    shows(s, LEFT, 1.25)
    s.user.click("button", "Copy as")
    s.user.click("menuitem", re.compile("launch file"))
    s.user.until(lambda: "1.25" in s.user.clipboard)
    assert LEFT in s.user.clipboard and RIGHT in s.user.clipboard
    s.user.reads("Copied")
    enter(s, LEFT, "0.5")
    shows(s, LEFT, 0.5)
    s.user.click("button", "Copy")
    s.user.until(lambda: "0.5" in s.user.clipboard)

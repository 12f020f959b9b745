"""Tasks with frames and driving."""

from __future__ import annotations

import math
import re

import pytest
from desk import Desk
from judge import changed

pytestmark = pytest.mark.browser

WHEEL = "drivewhl_l_link"


def test_task_51_where_the_left_wheel_is(s: Desk) -> None:
    user = s.user
    user.tab("Frames")
    user.enter(user.row("Frames", "From").one("combobox"), "base_link")
    user.enter(user.row("Frames", "To").one("combobox"), WHEEL)
    user.enter(user.row("Views", "Yaw").one("textbox"), "1")
    for name, shown in (
        ("Position x y z [m]", "-0.12 0.18 -0.05"),
        ("Roll pitch yaw [rad]", "0 0 0"),
        ("Roll pitch yaw [°]", "0 0 0"),
        ("Quaternion x y z w", "0 0 0 1"),
    ):
        user.until(lambda n=name, s=shown: s in user.row("Frames", n).text)
    user.unfold("Frames", "Matrix 4×4")
    user.reads("0   0.18")
    user.unfold("Frames", "Copy as")
    user.click("button", "Copy Launch file")
    wanted = '"--x", "-0.12", "--y", "0.18", "--z", "-0.05"'
    user.until(lambda: wanted in user.clipboard)
    assert f'"--child-frame-id", "{WHEEL}"' in user.clipboard


def test_task_52_hang_a_laser_on_the_body(s: Desk) -> None:
    user, form = s.user, ("form", "Static transform")

    def fill(**texts: str) -> None:
        for name, text in texts.items():
            user.enter(user.find("textbox", name, form), text, end="")

    user.tab("Frames")
    user.click("button", "Add static transform …")
    user.enter(user.find("combobox", "Parent", form), "base_link", end="")
    fill(x="0.1", z="0.2 km h", Child="base_laser")
    user.click("button", "Add", form)
    user.reads("is not a number")
    assert "base_laser" not in s.viz.frames.frames
    fill(z="0.2")
    user.click("button", "Add", form)
    user.until(lambda: "base_laser" in s.viz.frames.frames)
    assert place(s) == pytest.approx((0.1, 0.0, 0.2))
    row = user.until(lambda: [r for r in user.rows("Frames") if "base_laser" in r])[-1]
    user.unfold("Frames", row)
    user.enter(user.row("Frames", row, "Translation").one("textbox"), "0.15; 0; 0.2")
    user.until(lambda: place(s) == pytest.approx((0.15, 0.0, 0.2)))
    user.click_on(user.row("Frames", row).all("gridcell")[0])
    user.click("button", "Remove", ("tabpanel", "Frames"))
    user.until(lambda: "base_laser" not in s.viz.frames.frames)
    user.click("button", "Add static transform …")


def place(desk: Desk) -> tuple[float, ...]:
    found = desk.viz.frames.lookup("base_link", "base_laser")
    return tuple(float(v) for v in found.translation)


@pytest.mark.view
def test_task_53_drive_round_a_corner_stop_and_reset(s: Desk) -> None:
    user = s.user

    def speed(name: str, value: str) -> None:
        user.enter(user.row("Drive", name).one("textbox"), value)

    def pose(name: str) -> float:
        return float(user.row("Drive", name).one("textbox").value)

    user.tab("Drive")
    before = s.viewer.pixels()
    speed("Linear speed", "1")
    user.until(lambda: pose("x") > 0.3)
    assert abs(pose("y")) < 0.001
    speed("Linear speed", "0")
    speed("Angular speed", "1")
    user.until(lambda: pose("yaw") > 0.3)
    speed("Angular speed", "0")
    # It may have turned on meanwhile, so the way leads anywhere.
    corner = pose("x"), pose("y")
    speed("Linear speed", "1")
    user.until(lambda: math.dist((pose("x"), pose("y")), corner) > 0.3)
    speed("Linear speed", "0")
    user.until(lambda: changed(before, s.viewer.pixels()) > 200)
    stop = user.find("button", re.compile("Stop"))
    user.until(lambda: user.can_see(stop))
    speed("Linear speed", "0.5")
    user.click("button", re.compile("Stop"))
    user.until(lambda: user.row("Drive", "Linear speed").one("textbox").value == "0")
    user.click("button", "Back to start", ("group", "Drive"))
    user.until(lambda: pose("x") == pose("y") == pose("yaw") == 0.0)
    user.until(lambda: set(s.viz.joint_positions.values()) == {0.0})

"""2D Goal Pose in a real page: by mouse and by finger, and what stops it."""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from ax_tree import Thing
from inside import session_of
from live_peers import eventually, knows_takers
from navigator_peer import NavigatorPeer
from presses import press_all
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = [pytest.mark.browser, pytest.mark.view]
CONFIG = """
Visualization Manager:
  Global Options: {Fixed Frame: map}
  Displays:
    - {Class: rviz_default_plugins/Grid, Enabled: true}
    - {Class: rviz_default_plugins/TF, Enabled: true}
  Tools:
    - {Class: rviz_default_plugins/MoveCamera}
    - {Class: rviz_default_plugins/SetGoal, Topic: {Value: /goal_pose}}
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Distance: 8
      Pitch: 1
      Yaw: 1.5707963
      Focal Point: {X: 0, Y: 0, Z: 0}
"""
BAR = ("toolbar", "Tools")


@pytest.fixture
def peer() -> Iterator[NavigatorPeer]:
    made = NavigatorPeer()
    yield made
    made.stop()


@pytest.fixture
def viz(peer: NavigatorPeer, tmp_path: Path) -> Iterator[Visualizer]:
    config = tmp_path / "a.rviz"
    config.write_text(CONFIG)
    with Visualizer(source=peer.uri, config=config, port=0, publish="goal") as viz:
        eventually(lambda: "map" in session_of(viz).scene.context.tree.frames)
        data = session_of(viz).data
        assert data is not None
        knows_takers(data.source, peer)
        yield viz


def yaws(peer: NavigatorPeer) -> list[float]:
    """The headings of the goals that have come [rad]."""
    found = [struct.unpack_from("<2d", bytes(c.content)[-16:]) for c in peer.came()]
    return [2.0 * math.atan2(z, w) for z, w in found]


def test_a_goal_by_mouse_and_what_becomes_of_it(
    peer: NavigatorPeer, viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz.url)
    viewer.settle(viz)
    user, mouse = viewer.user, viewer.page.mouse
    camera = viewer.page.evaluate("__viserMutable.camera.position.toArray()")
    x, y = viewer.on_page((0.0, 0.0, 0.0))
    tip = viewer.on_page((0.0, 2.0, 0.0))
    viewer.page.keyboard.press("g")
    user.reads("Drag from the place towards the heading")
    # The press comes at once.
    mouse.move(x, y)
    mouse.press()
    mouse.move((x + tip[0]) / 2, (y + tip[1]) / 2)
    mouse.move(*tip)
    viewer.wait_for("'/~pose' in __viserMutable.nodeRefFromName")
    mouse.release()
    user.reads("Reached.")
    assert yaws(peer) == pytest.approx([math.pi / 2], abs=0.02)
    viewer.settle(viz)
    assert viewer.page.evaluate(
        "__viserMutable.camera.position.toArray()"
    ) == pytest.approx(camera, abs=1e-6)
    # Escape, in the middle of a drag, sends nothing.
    user.click("button", "2D Goal Pose", BAR)
    mouse.move(x, y)
    mouse.press()
    mouse.move(*tip)
    viewer.page.keyboard.press("Escape")
    mouse.release()
    viewer.settle(viz)
    assert len(peer.came()) == 1


def test_a_goal_by_keyboard_alone(
    peer: NavigatorPeer, viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz.url)
    viewer.settle(viz)
    user = viewer.user
    user.keys("g")
    user.reads("Drag from the place towards the heading")
    user.keys("Enter")
    user.find("dialog", "2D Goal Pose by numbers")
    user.until(lambda: user.find("textbox", "x").state("focused"))
    user.type("1.5")
    viewer.wait_for("'/~pose' in __viserMutable.nodeRefFromName")
    user.keys("Tab")
    user.type("-2")
    user.keys("Tab")
    # A plain number is radians, which is seen.
    user.type("2.0351")
    user.reads("= 116.6°")
    user.keys("Control+a")
    user.type("90 deg")
    user.reads("= 90°")
    user.keys("Enter")
    user.gone("dialog")
    user.reads("Reached.")
    (came,) = peer.came()
    assert struct.unpack_from("<2d", bytes(came.content)[-56:]) == (1.5, -2.0)
    assert yaws(peer) == pytest.approx([math.pi / 2])


def test_where_nothing_may_be_sent_the_numbers_say_so_and_send_is_grey(
    peer: NavigatorPeer, tmp_path: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    config = tmp_path / "a.rviz"
    config.write_text(CONFIG)
    with Visualizer(source=peer.uri, config=config, port=0) as viz:
        eventually(lambda: "map" in session_of(viz).scene.context.tree.frames)
        user = open_viewer(viz.url, view=False).user
        user.click("button", "2D Goal Pose", BAR)
        user.reads("start with --publish goal")
        user.click("button", "By numbers…")
        dialog = user.find("dialog", "2D Goal Pose by numbers")
        user.until(lambda: "start with --publish goal" in dialog.look_inside().text)
        assert user.find("button", "Send").state("disabled")
        user.keys("Enter")
        assert user.find("dialog", "2D Goal Pose by numbers")
    assert peer.came() == []


def test_a_goal_by_finger(
    peer: NavigatorPeer, viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz.url, width=1024, height=768, touch=True)
    viewer.settle(viz)
    touch = viewer.page.touch
    start, tip = viewer.on_page((0.0, 0.0, 0.0)), viewer.on_page((-2.0, 0.0, 0.0))
    viewer.user.click("button", "2D Goal Pose", BAR)
    viewer.user.reads("a second finger stops")
    touch.start(start)
    touch.move(tip)
    touch.end()
    viewer.user.reads("Reached.")
    (yaw,) = yaws(peer)
    assert abs(yaw) == pytest.approx(math.pi, abs=0.02)


@pytest.mark.parametrize(
    ("width", "height", "touch"),
    [
        (1280, 800, False),
        pytest.param(1024, 768, False, marks=pytest.mark.slow),
        (1024, 768, True),
        (390, 844, True),
    ],
)
def test_stop_and_cancel_keep_their_places_whatever_is_said_and_open(
    width: int,
    height: int,
    touch: bool,
    peer: NavigatorPeer,
    viz: Visualizer,
    open_viewer: Callable[..., ViewerPage],
) -> None:
    peer.statuses = (1, 2)
    viewer = open_viewer(viz.url, width=width, height=height, touch=touch, view=False)
    user, status = viewer.user, ("contentinfo", "Status bar")
    stop = user.box(user.find("button", "STOP"))
    bar = user.box(user.find(*status))

    def is_all_there(*names: str | re.Pattern[str]) -> None:
        assert user.box(user.find("button", "STOP")) == stop
        assert user.box(user.find(*status)) == bar
        for name in ("STOP", *names):
            button = user.find("button", name)
            user.until(lambda button=button: user.can_see(button))

    user.click("button", "2D Goal Pose", BAR)
    user.find("button", "By numbers…")
    is_all_there()
    viz.publish_goal(0.5, 0.5, 0.6)
    user.click("button", "Cancel", status)

    def refusal() -> Thing | None:
        lines = user.find(*status).all("status")
        return next((one for one in lines if "not cancelled" in one.text), None)

    # Nobody has that service here.
    line = user.until(refusal)
    assert line is not None
    is_all_there("Cancel")
    if user.is_cut_off(line):
        user.click_on(line)
        tip = user.find("tooltip")
        assert "not cancelled" in tip.text and user.can_see(tip)
        user.click_on(line)
    # The form of the time leaves STOP and its button free, also once it has grown.
    clock = re.compile("^Time: ")
    user.click("button", clock)
    user.until(lambda: user.can_see(user.find("dialog", "Time")))
    is_all_there(clock)
    user.choose(user.find("combobox", "Synchronization"), "Exact")
    user.find("combobox", "Source")
    user.until(lambda: user.can_see(user.find("dialog", "Time")))
    is_all_there(clock)


def test_on_a_phone_hint_and_cancel_have_room_whoever_is_there(
    peer: NavigatorPeer, viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    peer.statuses = (1, 2)
    viewer = open_viewer(viz.url, width=390, height=844, touch=True, view=False)
    open_viewer(viz.url, view=False)
    user = viewer.user
    status = "contentinfo", "Status bar"
    user.find("button", "People: 2 browsers", status)
    top = user.box(user.find("tab", "Joints"))[1]
    user.click("button", "2D Goal Pose", BAR)
    viz.publish_goal(0.5, 0.5, 0.6)
    for name in ("Cancel", "By numbers…", "People: 2 browsers", "Reset"):
        button = user.find("button", name, status)
        user.until(lambda button=button: user.can_see(button))

    def said(words: str) -> Thing:
        def found() -> Thing | None:
            lines = user.find(*status).all("status")
            return next((one for one in lines if words in one.text), None)

        return user.until(found)

    # What has no room for all of it shows that at a tap.
    hint = said("Drag from the place")
    viewer.page.touch.tap(*user.go_to(hint))
    assert "a second finger stops" in user.find("tooltip").text
    viewer.page.touch.tap(*user.go_to(hint))
    user.gone("tooltip")
    assert press_all(viewer, ".statusbar", 4) == []
    # With another tool there is room for how far the goal is.
    user.click("button", "Move Camera", BAR)
    user.until(lambda: not user.is_cut_off(said("Goal: ")))
    assert user.box(user.find("tab", "Joints"))[1] == top

"""The player below the view: keys that go through a recording, and its times."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from ax_tree import Thing
from inside import session_of
from made_recording import write_recording
from recorded_page import open_page
from user import User
from viewer_page import ViewerPage, viewer_url

from sambot_viz import Visualizer
from sambot_viz.export.chromium import Chromium
from sambot_viz.session.data.player import Player

SKY = (700, 160)
NO_TIMES = """
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/Grid, Enabled: true}
    - {Class: rviz_default_plugins/TF, Enabled: true}
"""

pytestmark = pytest.mark.browser


@pytest.fixture
def viz(make_viz: Callable[..., Visualizer], repository: Path) -> Visualizer:
    return make_viz(source=f"bag:{repository / 'assets' / 'square.mcap'}")


@pytest.fixture
def viewer(viz: Visualizer, open_viewer: Callable[..., ViewerPage]) -> ViewerPage:
    return open_viewer(viz.url)


def test_keys_go_through_a_recording_where_nothing_else_has_them(
    viz: Visualizer, viewer: ViewerPage
) -> None:
    user = viewer.user
    data = session_of(viz).data
    assert data is not None and data.player is not None
    player = data.player
    user.find("button", "Pause")
    user.keys(" ")
    user.until(lambda: not player.playback.value.playing)
    user.page.mouse.click(*SKY)
    user.keys("End")
    user.until(lambda: player.time_ns == player.end_ns)
    user.find("button", "Time: 0:19.969 / 0:19.969")
    user.keys("ArrowLeft")
    user.until(lambda: player.time_ns == player.end_ns - 10**9)

    user.click_on(user.row("Displays", "Grid"))
    user.keys("Home")
    user.until(lambda: user.row("Displays", "Global Options").state("focused"))
    assert player.time_ns == player.end_ns - 10**9
    # What elapsed counts from the beginning of the recording, whenever the page came.
    viewer.reload()
    user.click("button", "Time: 0:18.969 / 0:19.969")
    user.until(lambda: "ROS Elapsed 18.97" in user.find("dialog", "Time").text)


def paused(viz: Visualizer, viewer: ViewerPage) -> Player:
    """The player, after a click of the mouse on Pause."""
    data = session_of(viz).data
    assert data is not None and data.player is not None
    player = data.player
    viewer.user.click("button", "Pause")
    viewer.user.until(lambda: not player.playback.value.playing)
    return player


def test_a_time_that_is_typed_is_gone_to_and_a_wrong_one_says_what_can_be(
    viz: Visualizer, viewer: ViewerPage
) -> None:
    user, player = viewer.user, paused(viz, viewer)
    user.click("button", re.compile("^Time: "))
    user.enter(user.find("textbox", re.compile("Go to")), "9:00")
    user.until(lambda: "up to 0:19.969" in alerts(user))
    user.enter(user.find("textbox", re.compile("Go to")), "0:07.5")
    user.until(lambda: player.time_ns == player.start_ns + 7_500_000_000)
    user.click("button", "To the beginning")
    user.until(lambda: player.time_ns == player.start_ns)


def test_another_recording_is_opened_from_the_menu_the_player_and_the_palette(
    tmp_path: Path, repository: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    square = (repository / "assets" / "square.mcap").read_bytes()
    (tmp_path / "square.mcap").write_bytes(square)
    (tmp_path / "broken.mcap").write_bytes(b"no recording")
    moved = [("/tf", t, {"base": "odom"}) for t in (0.0, 4.0)]
    write_recording(tmp_path / "other.mcap", {}, moved)
    with Visualizer(tmp_path / "square.mcap", port=0, look="rviz") as viz:
        user = open_viewer(viz.url).user

        def choose(name: str) -> None:
            user.find("dialog", "Open Recording")
            user.click("option", name)
            user.click("button", "Open")

        user.menu("File", "Open Recording…")
        choose("other.mcap")
        user.gone("dialog")
        user.find("button", re.compile("Time: .* / 0:04"))
        # What is not saved is asked about, where it would be lost.
        user.click("checkbox", "Grid")
        user.find("button", re.compile("^Undo"))
        user.click("button", "Open recording")
        user.click("button", "Don’t save")
        choose("broken.mcap")
        user.until(lambda: "is not a recording" in alerts(user))
        assert viz.player.duration == pytest.approx(4.0)
        user.keys("Escape")
        user.gone("dialog")
        user.keys("Control+z")
        user.keys("Control+k")
        user.type("open recording")
        user.keys("Enter")
        choose("square.mcap")
        user.gone("dialog")
        user.find("button", re.compile("Time: .* / 0:20"))


def alerts(user: User) -> str:
    return " ".join(alert.text for alert in user.see().all("alert"))


def test_a_press_on_a_slider_that_a_recording_moves_says_what_moves_it(
    viewer: ViewerPage,
) -> None:
    user, said = viewer.user, "This joint is moved by square.mcap. Untick"
    left, top, width, height = user.box(user.find("slider", "drivewhl_l_joint"))
    user.page.mouse.click(round(left + 0.8 * width), round(top + height / 2))
    user.until(lambda: said in alerts(user))
    user.has_tip(said)
    user.click("checkbox", "Follow square.mcap")
    user.until(lambda: said not in alerts(user))


def test_frames_are_drawn_at_the_time_of_a_display_that_is_chosen(
    tmp_path: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    moved = [("/tf", tenth / 10, {"base": "odom"}) for tenth in range(41)]
    path = write_recording(tmp_path / "late.mcap", {}, moved, scans=[(1.5, 2.0)])
    with Visualizer(path, port=0) as viz:
        viz.player.pause()
        viz.player.jump(2.2)
        user = open_viewer(viz.url).user
        user.click("button", re.compile("^Time: "))
        user.reads("ROS Elapsed 2.20")
        user.choose(user.find("combobox", "Synchronization"), "Exact")
        user.reads("ROS Elapsed 1.50")
        assert user.find("combobox", "Source").value == "LaserScan /scan"


def test_without_a_display_that_has_times_the_source_is_none_and_says_why(
    tmp_path: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    moved = [("/tf", t, {"base": "odom"}) for t in (0.0, 4.0)]
    path = write_recording(tmp_path / "plain.mcap", {}, moved)
    config = tmp_path / "plain.rviz"
    config.write_text(NO_TIMES)
    with Visualizer(path, config=config, port=0) as viz:
        viewer = open_viewer(viz.url, view=False)
        user = viewer.user
        for _ in range(2):
            user.click("button", re.compile("^Time: "))
            user.choose(user.find("combobox", "Synchronization"), "Exact")
            source = user.find("combobox", "Source")
            assert source.value == "none"
            assert source.state("disabled")
            user.page.mouse.move(*user.go_to(source))
            user.has_tip("No display shows messages that have a time")
            viewer.reload()
        user.click("button", re.compile("^Time: "))
        modes = user.find("combobox", "Synchronization")
        assert [one.name for one in modes.all("option")] == [
            "Off",
            "Exact",
            "Approximate",
        ]


def test_on_a_phone_the_time_bar_is_as_wide_as_the_screen_and_its_times_cover_nothing(
    viz: Visualizer, chromium: Chromium
) -> None:
    page = open_page(chromium, 390, 844, touch=True)
    page.goto(viewer_url(viz.url, view=False))
    user = User(page, finger=True)
    left, _, width, _ = user.box(user.find("slider", "Time"))
    assert left < 20 and width > 350
    for button in ("Loop", "Next message"):
        assert user.can_see(user.find("button", button))
    user.click("button", "Pause")
    user.click("button", re.compile("^Time: "))
    user.reads("ROS Elapsed")
    for role, name in (("slider", "Time"), ("tab", "Joints"), ("tab", "Topics")):
        assert user.can_see(user.find(role, name))
    page.close()


def test_a_tap_on_a_line_that_is_cut_off_shows_all_of_it(
    make_viz: Callable[..., Visualizer], chromium: Chromium
) -> None:
    # Nobody listens there.
    viz = make_viz(source="rosbridge://127.0.0.1:1")
    page = open_page(chromium, 390, 844, touch=True)
    page.goto(viewer_url(viz.url, view=False))
    user = User(page, finger=True)

    def line() -> Thing:
        return max(user.see().all("status"), key=lambda one: len(one.text))

    user.until(lambda: user.is_cut_off(line()))
    user.click_on(line())
    # The seconds until the next attempt go on meanwhile.
    said, count = (
        "Nothing listens at 127.0.0.1:1: start the bridge there",
        "next attempt in",
    )

    def whole() -> Thing | None:
        found = user.find("tooltip")
        return found if found.text.startswith(said) and count in found.text else None

    tip = user.until(whole)
    assert tip is not None and user.can_see(tip)
    assert not user.is_cut_off(tip)
    user.click("button", "Select")
    user.gone("tooltip")
    page.close()


def test_the_keys_of_the_player_go_on_after_a_click_of_the_mouse(
    viz: Visualizer, viewer: ViewerPage
) -> None:
    user, player = viewer.user, paused(viz, viewer)
    user.click("button", "Loop")
    user.until(lambda: player.playback.value.loop)
    user.keys(" ")
    user.find("button", "Pause")
    user.keys(" ")
    user.find("button", "Play")
    assert player.playback.value.loop

    user.menu("View", "Look: RViz")
    user.keys("End")
    user.until(lambda: player.time_ns == player.end_ns)
    user.click("button", "Select")
    user.keys("ArrowLeft")
    user.until(lambda: player.time_ns == player.end_ns - 10**9)
    # Who came by the keyboard stays there.
    user.keys("Tab")
    user.keys("ArrowRight", "ArrowRight")
    assert player.time_ns == player.end_ns - 10**9

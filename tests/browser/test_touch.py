"""Fingers on the panels: what scrolls, what slides, and what is large enough to hit."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import robots
from ax_tree import Thing
from inside import session_of
from navigator_peer import NavigatorPeer
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.displays.picking.selectable import Selectable

pytestmark = pytest.mark.browser

FIRST, SECOND = "torso_pitch_joint", "left_shoulder_roll_joint"


@pytest.fixture
def viz(tmp_path: Path) -> Iterator[Visualizer]:
    """A humanoid of 32 joints."""
    model = tmp_path / "humanoid.urdf"
    model.write_text(robots.humanoid(), "utf-8")
    with Visualizer(model, port=0, look="rviz") as viz:
        yield viz


def test_a_finger_scrolls_the_joints_from_a_slider_and_slides_sideways(
    viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz.url, width=390, height=844, touch=True)
    user = viewer.user

    def slider(name: str) -> Thing:
        return user.row("Joints", name).one("slider")

    # On the handle, then on the track.
    for beside in (0.0, 20.0):
        x, y = user.go_to(slider(FIRST))
        user.swipe((x + beside, y), (x + beside + 3, y - 120))
        user.until(lambda y=y: user.box(slider(FIRST))[1] < y - 60)
    user.drag_slider(slider(SECOND), 1.45)
    user.until(lambda: viz.joint_positions[SECOND] > 1.2)
    x, y = user.go_to(slider(SECOND))
    viewer.page.touch.tap(x, y)
    user.until(lambda: abs(viz.joint_positions[SECOND]) < 0.1)
    user.drag_slider(slider(SECOND), -1.45)
    user.until(lambda: viz.joint_positions[SECOND] < -1.2)
    moved = {name for name, value in viz.joint_positions.items() if value}
    assert moved == {SECOND}
    assert float(slider(FIRST).value) == 0.0


def test_all_tabs_of_a_phone_are_in_sight_and_hints_are_for_fingers(
    viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz.url, width=320, height=640, touch=True)
    user = viewer.user
    user.reads("One finger: turn")
    tabs = user.find("tablist").all("tab")
    assert len(tabs) > 6
    for tab in tabs:
        user.until(lambda tab=tab: user.can_see(tab))
        assert not user.is_cut_off(tab)
    user.menu("Menu", "Problems")
    user.until(lambda: user.find("tab", "Problems").state("selected"))


def test_on_a_phone_what_is_selected_has_the_room_of_the_hint_and_texts_are_in_line(
    viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = open_viewer(viz.url, width=390, height=844, touch=True)
    user = viewer.user
    user.reads("One finger: turn")
    # Nor is there anything of viser's own panel for those who do not see it.
    assert not user.there("button", "Save Canvas")
    (client,) = session_of(viz).clients.all.values()
    client.tools.select({Selectable("link", "head_yaw")}, None)
    user.reads("Selected: head_yaw")
    user.until(lambda: "One finger: turn" not in user.see().text)
    user.tab("Selection")
    row = user.row("Selection", "Link head_yaw", "Parent")
    name, value = (user.box(cell.all("StaticText")[0]) for cell in row.all("gridcell"))
    assert abs(name[1] - value[1]) <= 2.0


def test_a_long_sentence_makes_the_joints_of_a_phone_no_wider(
    repository: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    peer = NavigatorPeer()
    model = repository / "assets" / "sam_bot.urdf.xacro"
    with Visualizer(model, source=peer.uri, publish="", port=0) as viz:
        viewer = open_viewer(viz.url, width=390, height=844, touch=True)
        viewer.user.reads("Nobody has subscribed to /joint_states")
        panel = "document.querySelector('.joints')"
        widths = f"[{panel}.scrollWidth, {panel}.clientWidth]"
        assert viewer.page.evaluate(widths) == [390, 390]
    peer.stop()

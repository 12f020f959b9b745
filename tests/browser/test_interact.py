"""Handles of interactive markers in a real page: by mouse, by finger, their menu."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from inside import session_of
from interactive_messages import MOVE_AXIS, control, cube, marker
from live_peers import eventually, knows_takers
from marker_peer import MarkerPeer
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = [pytest.mark.browser, pytest.mark.view]
CONFIG = """
Visualization Manager:
  Global Options: {Fixed Frame: map}
  Displays:
    - {Class: rviz_default_plugins/Grid, Enabled: true}
    - Class: rviz_default_plugins/InteractiveMarkers
      Enabled: true
      Interactive Markers Namespace: /ns
  Tools:
    - {Class: rviz_default_plugins/Interact}
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Distance: 5
      Pitch: 1
      Yaw: 1.5707963
      Focal Point: {X: 0, Y: 0, Z: 0}
"""
SELECT, UP = 2, 5
HANDLE, BESIDE = (0.7, 0.0, 0.0), (-1.5, 0.0, 0.0)
PLACE = "__viserMutable.camera.position.toArray()"


def with_menu(types: Any) -> Any:
    made = marker(
        types,
        controls=[
            control(types, MOVE_AXIS, name="x"),
            control(types, always=True, name="box", markers=[cube(types)]),
        ],
    )
    entry = types["visualization_msgs/msg/MenuEntry"]
    made.menu_entries = [
        entry(1, 0, "Lights", "", 0),
        entry(2, 1, "[ ] Blue", "", 0),
        entry(3, 0, "Horn", "", 0),
    ]
    return made


@pytest.fixture
def peer() -> Iterator[MarkerPeer]:
    made = MarkerPeer(with_menu)
    yield made
    made.stop()


@pytest.fixture
def viz(peer: MarkerPeer, tmp_path: Path) -> Iterator[Visualizer]:
    config = tmp_path / "a.rviz"
    config.write_text(CONFIG)
    with Visualizer(source=peer.uri, config=config, port=0, publish="markers") as viz:
        eventually(lambda: "map" in session_of(viz).scene.context.tree.frames)
        data = session_of(viz).data
        assert data is not None
        knows_takers(data.source, peer)
        yield viz


def opened(
    open_viewer: Callable[..., ViewerPage], viz: Visualizer, **options: Any
) -> ViewerPage:
    """A page that shows the marker."""
    viewer = open_viewer(viz.url, **options)
    viewer.wait_for(
        "Object.keys(__viserMutable.nodeRefFromName).some((n) => n.includes('/g0'))"
    )
    viewer.settle(viz)
    return viewer


def last_x(peer: MarkerPeer) -> float:
    return float(peer.feedback()[-1].pose.position.x)


def test_a_handle_by_mouse(
    peer: MarkerPeer, viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = opened(open_viewer, viz)
    mouse, camera = viewer.page.mouse, viewer.page.evaluate(PLACE)
    begin, end = viewer.on_page(HANDLE), viewer.on_page((1.7, 0.0, 0.0))
    # The press comes at once: the page asks what is there.
    mouse.move(*begin)
    mouse.press()
    mouse.move(*end)
    mouse.release()
    eventually(lambda: peer.events()[-1:] == [UP])
    assert last_x(peer) == pytest.approx(1.0, abs=0.1)
    viewer.settle(viz)
    # What rests on it sees what it does, and a hand.
    mouse.move(*viewer.on_page((1.7, 0.0, 0.0)))
    viewer.user.reads("one: Left: move along the axis. Right: show menu.")
    viewer.wait_for("document.body.classList.contains('over-handle')")
    told = len(peer.events())
    assert viewer.page.evaluate(PLACE) == pytest.approx(camera, abs=1e-6)
    # Beside it the camera turns.
    x, y = viewer.on_page(BESIDE)
    mouse.move(x, y)
    mouse.press()
    mouse.move(x + 60, y)
    mouse.release()
    viewer.wait_for(f"Math.abs({PLACE}[0] - {camera[0]}) > 0.1")
    assert len(peer.events()) == told


def test_a_menu_by_mouse_and_the_way_back_from_the_one_below_an_entry(
    peer: MarkerPeer, viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = opened(open_viewer, viz)
    user, mouse = viewer.user, viewer.page.mouse

    def open_menu() -> None:
        mouse.move(*viewer.on_page(HANDLE))
        viewer.wait_for("document.body.classList.contains('over-handle')")
        mouse.click(*viewer.on_page(HANDLE), button="right")
        user.find("menuitem", "Lights ▸")

    def selected() -> list[int]:
        return [f.menu_entry_id for f in peer.feedback() if f.event_type == SELECT]

    open_menu()
    user.click("menuitem", "Lights ▸")
    user.click("menuitem", "☐ Blue")
    eventually(lambda: selected() == [2])
    user.gone("menuitem", "☐ Blue")
    open_menu()
    # No entry is under the mouse, which would have the focus.
    mouse.move(5.0, 5.0)

    def has_focus(name: str) -> None:
        user.until(lambda: user.find("menuitem", name).state("focused"))

    user.click("menuitem", "Lights ▸")
    mouse.move(5.0, 5.0)
    has_focus("☐ Blue")
    user.click("menuitem", "‹ Back")
    mouse.move(5.0, 5.0)
    has_focus("Lights ▸")
    user.gone("menuitem", "☐ Blue")
    user.keys("ArrowRight")
    has_focus("☐ Blue")
    user.keys("ArrowLeft")
    has_focus("Lights ▸")
    user.keys("ArrowRight")
    has_focus("☐ Blue")
    user.keys("Enter")
    eventually(lambda: selected() == [2, 2])


def test_a_handle_and_a_menu_by_finger(
    peer: MarkerPeer, viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    viewer = opened(open_viewer, viz, width=1024, height=768, touch=True)
    touch = viewer.page.touch
    touch.start(viewer.on_page(HANDLE))
    touch.move(viewer.on_page((1.7, 0.0, 0.0)))
    touch.end()
    eventually(lambda: peer.events()[-1:] == [UP])
    assert last_x(peer) == pytest.approx(1.0, abs=0.1)
    viewer.settle(viz)
    # A finger that rests on it asks for the menu.
    touch.start(viewer.on_page((1.7, 0.0, 0.0)))
    viewer.user.find("menuitem", "Horn")
    touch.end()
    viewer.user.click("menuitem", "Lights ▸")
    viewer.user.click("menuitem", "‹ Back")
    viewer.user.click("menuitem", "Horn")
    eventually(lambda: peer.events()[-1:] == [SELECT])
    assert peer.feedback()[-1].menu_entry_id == 3

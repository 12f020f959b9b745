"""Displays of data in the page: what only a browser can tell."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from inside import session_of
from interactive_messages import (
    ALONG_Y,
    ALONG_Z,
    MOVE_PLANE,
    VIEW_FACING,
    control,
    marker,
    six_degrees,
    update,
)
from made_messages import write_messages
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = [pytest.mark.browser, pytest.mark.view]

DRAWN = """(() => {
  let size = 0;
  window.__viserMutable.scene.traverse((one) => {
    if (one.userData.drawAs === "points" && one.isMesh) size = one.userData.size[0];
  });
  return size;
})()"""
"""The size of the points that the page draws."""
CASE = Path(__file__).parents[1] / "golden" / "messages" / "cloud_intensity_points"


def test_what_was_drawn_before_is_freed(
    make_viz: Callable[..., Visualizer], open_viewer: Callable[..., ViewerPage]
) -> None:
    source = f"bag:{CASE / 'messages.mcap'}"
    viz = make_viz(source=source, config=CASE / "config.rviz")
    viz.player.pause()
    viz.player.jump(viz.player.duration)
    page = open_viewer(viz.url)
    session = session_of(viz)
    (cloud,) = (d for d in session.scene.displays if d.kind.endswith("PointCloud2"))

    def drawn() -> int:
        return int(page.page.evaluate("window.sambotVizLook.geometries"))

    counts = list[int]()
    for size in range(10, 19):
        session.display_edits.set_property(cloud, "Size (Pixels)", float(size))
        page.user.until(lambda size=size: page.page.evaluate(DRAWN) == size)
        page.wait_for_frames()
        counts.append(drawn())
    assert max(counts[4:]) <= max(counts[:4]) + 1


MARKERS = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/InteractiveMarkers
      Enabled: true
      Name: Markers
      Interactive Markers Namespace: /ns
  Global Options:
    Fixed Frame: map
  Tools:
    - Class: rviz_default_plugins/Interact
    - Class: rviz_default_plugins/MoveCamera
"""
CONTROLS = """(() => {
  const found = {};
  window.__viserMutable.scene.traverse((one) => {
    if (one.userData.drawAs !== "controlGroup") return;
    const x = one.position.clone().set(1, 0, 0).transformDirection(one.matrixWorld);
    const to = window.__viserMutable.camera.getWorldDirection(x.clone());
    const { always, faces } = one.userData;
    found[`${always ? "always" : ""} ${faces ? "faces" : ""}`.trim()] =
      [one.visible, Math.round(1000 * x.dot(to)) / 1000];
  });
  return found;
})()"""
"""Which groups of controls are visible, and the cosine of their x with the view."""


def test_controls_are_visible_with_their_tool_and_some_face_the_view(
    make_viz: Callable[..., Visualizer],
    open_viewer: Callable[..., ViewerPage],
    tmp_path: Path,
) -> None:
    file = write_messages(
        tmp_path / "markers.mcap",
        update(
            lambda t: six_degrees(t, "a", description="a", turn=ALONG_Y),
            lambda t: marker(
                t,
                "b",
                controls=[control(t, MOVE_PLANE, turn=ALONG_Z, turning=VIEW_FACING)],
            ),
        ),
    )
    config = tmp_path / "markers.rviz"
    config.write_text(MARKERS)
    viz = make_viz(source=f"bag:{file}", config=config)
    page = open_viewer(viz.url)

    def groups() -> dict[str, list[float]]:
        return dict(page.page.evaluate(CONTROLS))

    def directions() -> dict[str, float]:
        return {name: along for name, (_, along) in groups().items()}

    def visible() -> set[str]:
        return {name for name, (is_visible, _) in groups().items() if is_visible}

    # A picture that is left out shows what the page's scripts hide.
    page.page.evaluate("__viserMutable.scene.__r3f.root.getState().gl.hurry += 1")
    page.user.until(lambda: visible() == {"", "faces", "always", "always faces"})
    viz.camera.view("Orbit", {"Yaw": 2.0, "Pitch": 0.9})
    # While a node is made again it is not there.
    facing = {name: 1 for name in ("faces", "always faces")}
    page.user.until(lambda: facing.items() <= directions().items())
    # The view is there before the window that has the keys.
    page.user.find("button", "Move Camera")
    page.user.keys("m")
    page.user.until(lambda: visible() == {"always", "always faces"})
    page.user.keys("i")
    page.user.until(lambda: len(visible()) == 4)

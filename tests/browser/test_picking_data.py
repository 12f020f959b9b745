"""Points of a scan are clicked on and measured in the page."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from filled_messages import on_topic
from inside import session_of
from made_messages import write_messages
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = [pytest.mark.browser, pytest.mark.view]

CONFIG = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/LaserScan
      Enabled: true
      Name: Laser
      Topic: /a
    - Class: rviz_default_plugins/Map
      Enabled: true
      Name: Map
      Alpha: 1
      Topic: /map
  Global Options:
    Fixed Frame: map
  Tools:
    - Class: rviz_default_plugins/MoveCamera
    - Class: rviz_default_plugins/Select
    - Class: rviz_default_plugins/Measure
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Distance: 9
      Pitch: 0.8
      Yaw: 0.6
"""
RANGES = [1.0, 2.0, 3.0, 2.0]


@pytest.fixture
def scanned(make_viz: Callable[..., Visualizer], tmp_path: Path) -> Visualizer:
    """A scan with a reading along each axis, 0.1 m over a map."""
    scan = on_topic(
        "sensor_msgs/msg/LaserScan",
        angle_increment=np.pi / 2,
        angle_max=1.5 * np.pi,
        range_max=9.0,
        ranges=RANGES,
        intensities=[10.0, 11.0, 12.0, 13.0],
    )
    floor = {"position": {"x": -4.0, "y": -4.0, "z": -0.1}, "orientation": {"w": 1.0}}
    info = {"resolution": 8.0, "width": 1, "height": 1, "origin": floor}
    grid = on_topic("nav_msgs/msg/OccupancyGrid", "/map", info=info, data=[0])
    file = write_messages(tmp_path / "scan.mcap", grid, scan)
    config = tmp_path / "scan.rviz"
    config.write_text(CONFIG)
    viz = make_viz(source=f"bag:{file}", config=config)
    viz.player.pause()
    viz.player.jump(viz.player.duration)
    return viz


def test_a_point_of_a_scan_is_clicked_on_and_measured(
    scanned: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    page = open_viewer(scanned.url)
    user, mouse = page.user, page.page.mouse
    # What the page has to say of its view comes after its first picture.
    page.settle(scanned)
    (client,) = session_of(scanned).clients.all.values()

    def place(x: float, y: float) -> tuple[float, float]:
        column, row = page.project("", (x, y, 0.0))
        left, top = page.page.evaluate(
            "(r => [r.x, r.y])(__viserMutable.canvas.getBoundingClientRect())"
        )
        return left + column, top + row

    def choose(label: str) -> None:
        user.click("button", label, ("toolbar", "Tools"))
        user.until(lambda: client.tools.current.label == label)
        user.until(lambda: user.find("button", label, ("toolbar", "Tools")).is_on)
        page.settle(scanned)

    page.wait_until_drawn()
    choose("Select")
    user.tab("Selection")
    x, y = place(0.0, 2.0)
    # A pixel beside the point, which is smaller than one.
    mouse.click(x + 1, y - 1)
    shown = user.row("Selection", "Point 1 [Laser]", "3: intensity")
    assert "11" in shown.text
    assert "0; 2; 0 m" in user.row("Selection", "Point 1 [Laser]", "Position").text
    user.reads("Selected: Point 1 of Laser")
    ends = [place(1.0, 0.0), place(0.0, 2.0), place(-3.0, 0.0), place(0.0, -2.0)]
    xs, ys = zip(*ends, strict=True)
    mouse.drag((min(xs) - 10, min(ys) - 10), (max(xs) + 10, max(ys) + 10))
    user.reads("4 items selected")
    choose("Measure")
    mouse.click(*place(1.0, 0.0))
    user.until(lambda: "second point" in client.tools.status)
    mouse.click(*place(-3.0, 0.0))
    user.reads("4 m. Click")

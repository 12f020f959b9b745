"""The page of a running viewer, as a user meets it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product

import numpy as np
import pytest
import yaml
from desk import Desk
from inside import node_of, session_of
from viewer_page import Pixels, ViewerPage

from sambot_viz import Visualizer, bundled

pytestmark = [pytest.mark.browser, pytest.mark.view]

Open = Callable[..., ViewerPage]
LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"
LINK = "drivewhl_l_link"


@pytest.fixture
def desk(sit: Callable[..., Desk]) -> Desk:
    """sam_bot, seen from the left and near enough to see a wheel turn."""
    config = yaml.safe_load(bundled.config_path().read_text("utf-8"))
    view = config["Visualization Manager"]["Views"]["Current"]
    view |= {"Distance": 1.2, "Yaw": 1.9, "Pitch": 0.4}
    desk = sit("S near", yaml.safe_dump(config))
    desk.viewer.wait_for_nodes(node_of(desk.viz, LINK))
    desk.settle()
    return desk


def around(pixels: Pixels, place: tuple[int, int], size: int) -> Pixels:
    """The square of pixels around a place, cut off at the edges."""
    column, row = place
    rows = slice(max(row - size, 0), row + size)
    return pixels[rows, max(column - size, 0) : column + size]


def changed(before: Pixels, after: Pixels) -> int:
    """How many pixels differ visibly."""
    difference = np.abs(before.astype(int) - after.astype(int)).max(axis=2)
    return int(np.count_nonzero(difference > 10))


def place_of(viz: Visualizer, frame: str) -> list[float]:
    """x, y, z of a frame in the fixed frame [m]."""
    return [float(v) for v in viz.frames.lookup("base_link", frame).translation]


def wheel_place(viz: Visualizer, viewer: ViewerPage) -> tuple[int, int]:
    """Where the left wheel is in the picture."""
    return viewer.project("", place_of(viz, LINK))


def wait_for_turn(viz: Visualizer, viewer: ViewerPage, angle: float) -> None:
    """Wait until three.js shows the left wheel turned by `angle` [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    T = np.eye(4)
    T[:3, :3] = ((c, 0, s), (0, 1, 0), (-s, 0, c))
    T[:3, 3] = place_of(viz, LINK)
    viewer.wait_for_pose(node_of(viz, LINK), T, node_of(viz, "base_link"))


def slider(viewer: ViewerPage, joint: str) -> float:
    """What the slider of a joint shows."""
    return float(viewer.user.find("slider", joint).value)


@pytest.fixture
def at_first() -> Iterator[Visualizer]:
    """sam_bot as it is shown without a config."""
    with Visualizer(port=0) as viz:
        yield viz


def test_the_whole_robot_is_in_the_view_at_first_and_fills_a_third_of_its_height(
    at_first: Visualizer, open_viewer: Open
) -> None:
    viewer = open_viewer(at_first.url)
    viewer.wait_for_nodes(node_of(at_first, LINK))
    # The panels come after the robot and make the view narrower.
    viewer.wait_for("document.body.innerText.includes('Fixed Frame')")
    viewer.settle(at_first)
    session = session_of(at_first)
    box = session.picker.robot_box()
    assert box is not None
    places = [
        viewer.project("", place) for place in product(*np.transpose(box).tolist())
    ]
    columns, rows = np.transpose(places)
    height, across = viewer.pixels().shape[:2]
    assert 0 < columns.min() < columns.max() < across
    assert 0 < rows.min() < rows.max() < height
    assert np.ptp(rows) > height / 3
    assert not session.history.modified.value


def test_the_page_shows_robot_and_panels_and_asks_nobody_else(desk: Desk) -> None:
    viewer = desk.viewer
    for text in ("Grid", "RobotModel", "TF", "Fixed Frame", LEFT, RIGHT):
        viewer.user.reads(text)
    pixels = viewer.pixels()
    background = (pixels == (48, 48, 48, 255)).all(axis=2)
    assert np.count_nonzero(background) > background.size / 2
    assert viewer.foreign_requests() == []
    assert viewer.errors() == []


def test_nothing_covers_the_robot_and_the_panels_stand_beside_it(desk: Desk) -> None:
    viz, viewer = desk.viz, desk.viewer
    for frame in ("base_link", LINK, "drivewhl_r_link", "front_caster"):
        place = viewer.project("", place_of(viz, frame))
        assert not viewer.is_covered(*place), frame


def test_dragging_a_wheel_slider_changes_pixels_at_the_wheel(desk: Desk) -> None:
    viz, viewer = desk.viz, desk.viewer
    before = viewer.pixels()
    place = wheel_place(viz, viewer)
    viewer.user.drag_slider(viewer.user.find("slider", LEFT), 1.0)
    viewer.user.until(lambda: slider(viewer, LEFT) == pytest.approx(1.0, abs=0.15))
    desk.settle()
    shown = slider(viewer, LEFT)
    wait_for_turn(viz, viewer, shown)
    after = viewer.pixels()
    assert changed(around(before, place, 80), around(after, place, 80)) > 20
    assert changed(before[:100, :100], after[:100, :100]) == 0

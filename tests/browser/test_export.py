"""A page that is a file: it shows the same as the page of a server, and plays."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inside import node_of, session_of
from recorded_page import open_page
from viewer_page import COARSE, ViewerPage

from sambot_viz import Visualizer
from sambot_viz.export.chromium import Chromium
from sambot_viz.export.page_file import ViewState, page_file

pytestmark = [pytest.mark.browser, pytest.mark.view]
LEFT_LINK = "drivewhl_l_link"
BAR = 40
CAMERA = "__viserMutable.camera.position.toArray()"
Open = Callable[..., ViewerPage]
HOSTILE = (
    "</script><script>document.title='changed'</script><img src=x onerror=alert(1)>"
)


@pytest.fixture
def open_file(chromium: Chromium) -> Iterator[Open]:
    """Open an exported page from the disk; it may ask for nothing else."""
    opened: list[ViewerPage] = []

    def open_one(file: Path, width: int = 800, height: int = 640) -> ViewerPage:
        page = open_page(chromium, width, height)
        url = f"file://{file}?fixedDpr={COARSE:g}"
        page.goto(url)
        page.wait_for("document.querySelector('#sambot[data-ready]')", 30.0)
        viewer = ViewerPage(page, url)
        viewer.wait_until_drawn()
        opened.append(viewer)
        return viewer

    yield open_one
    for viewer in opened:
        viewer.page.close()
    for viewer in opened:
        asked = [url for url in viewer.page.requests if url != viewer.url]
        assert [url for url in asked if not url.startswith(("data:", "blob:"))] == []
        assert viewer.errors() == []


def test_the_file_shows_the_same_picture_as_the_page_and_plays_the_motion(
    open_viewer: Open, open_file: Open, tmp_path: Path
) -> None:
    file = tmp_path / "robot.html"
    with Visualizer(port=0, panels=False) as viz:
        wheel = node_of(viz, LEFT_LINK)
        viz.export(file)
        live = open_viewer(viz.url, width=800, height=600)
        live.wait_for_nodes(wheel)
        live.settle(viz)
    # Its server has stopped.
    live.expects_errors = True
    viewer = open_file(file, 800, 600 + BAR)
    viewer.wait_for_nodes(wheel)
    assert viewer.page.evaluate("document.title") == "sam_bot"
    viewer.user.until(lambda: differing(viewer, live) < 0.001, 30.0)
    user = viewer.user
    still = viewer.pose(wheel)
    user.click("button", "Play")
    user.find("button", "Pause")
    user.until(lambda: np.abs(viewer.pose(wheel) - still).max() > 0.5, 30.0)
    user.click("button", "Pause")
    user.find("button", "Play")
    viewer.wait_until_drawn()
    stopped = viewer.pose(wheel)
    viewer.wait_for_frames()
    assert np.allclose(viewer.pose(wheel), stopped)
    # By keys: the slider is behind the button, and the space bar plays.
    viewer.page.keyboard.press("Tab")
    viewer.page.keyboard.press("Home")
    user.until(lambda: np.allclose(viewer.pose(wheel), still, atol=1e-5), 30.0)
    user.until(lambda: user.find("slider", "Time").value in ("0", 0))
    viewer.page.keyboard.press(" ")
    user.find("button", "Pause")


SEEN = """(() => {
  const { camera, cameraControl, nodeRefFromName } = __viserMutable;
  const at = camera.position.clone();
  const target = cameraControl.getTarget(at.clone());
  const eye = cameraControl.getPosition(at.clone()).sub(target);
  const place = nodeRefFromName[NODE].getWorldPosition(at);
  return [target.sub(place).toArray(), eye.toArray(), place.toArray()];
})()"""
"""What is looked at and from where, beside a node, and where that is."""


def test_wheel_and_drag_turn_the_camera_beside_a_robot_that_moves(
    open_file: Open, tmp_path: Path, repository: Path
) -> None:
    file = tmp_path / "square.html"
    with Visualizer(repository / "assets" / "square.mcap", port=0) as viz:
        viz.player.pause()
        viz.player.jump(0.0)
        viz.camera.view("Orbit", {"Distance": 3.0, "Target Frame": "base_link"})
        node = node_of(viz, "base_link")
        viz.export(file)
    viewer = open_file(file)
    viewer.wait_for_nodes(node)

    def seen() -> list[list[float]]:
        return viewer.page.evaluate(SEEN.replace("NODE", repr(node)))

    def level(eye: list[float]) -> float:
        """The distance of the camera along the ground, which a turn keeps [m]."""
        return math.hypot(eye[0], eye[2])

    beside, eye, start = seen()
    viewer.user.click("button", "Play")
    viewer.user.until(lambda: np.abs(np.subtract(seen()[2], start)).max() > 0.3, 30.0)
    viewer.page.mouse.wheel(400.0, 150.0, dy=-100.0)
    viewer.user.until(lambda: level(seen()[1]) < 0.9 * level(eye))
    viewer.page.mouse.drag((400.0, 150.0), (300.0, 150.0))
    viewer.wait_for_frames()
    beside_now, eye_now, _ = seen()
    assert beside_now == pytest.approx(beside, abs=1e-3)
    assert level(eye_now) == pytest.approx(0.88 * level(eye), rel=1e-3)
    turn = math.atan2(eye_now[2], eye_now[0]) - math.atan2(eye[2], eye[0])
    assert abs(math.remainder(turn, math.tau)) == pytest.approx(0.5, abs=1e-3)


@pytest.mark.parametrize(
    "kind", ["TopDownOrtho", pytest.param("XYOrbit", marks=pytest.mark.slow)]
)
def test_every_view_looks_the_same_in_a_file_and_has_its_mouse(
    open_viewer: Open, open_file: Open, tmp_path: Path, kind: str
) -> None:
    with Visualizer(port=0, panels=False) as viz:
        live = open_viewer(viz.url, width=800, height=600)
        live.expects_errors = True
        live.wait_for_nodes(node_of(viz, LEFT_LINK))
        session = session_of(viz)
        live.settle(viz)
        (browser,) = session.clients.all.values()
        browser.view.set_kind(f"rviz_default_plugins/{kind}")
        live.settle(viz)
        file = tmp_path / f"{kind}.html"
        file.write_bytes(
            page_file(session.copy(), ViewState.of(browser), "none", look="studio")
        )
        alone = open_file(file, 800, 600 + BAR)
        alone.user.until(lambda: differing(alone, live) < 0.001)
        before = alone.page.evaluate(CAMERA)
        alone.page.mouse.drag((400.0, 300.0), (470.0, 330.0), button="middle")

        def moved() -> Any:
            return np.abs(np.subtract(alone.page.evaluate(CAMERA), before))

        # Both move over the ground; viser's "up" is y.
        alone.user.until(lambda: moved().max() > 0.05)
        assert moved()[1] < 0.02


def differing(one: ViewerPage, two: ViewerPage) -> float:
    """The part of the pixels that differ in two pictures of one size."""
    difference = np.abs(one.pixels().astype(int) - two.pixels()).max(axis=-1)
    return float((difference > 8).mean())


def test_a_user_downloads_the_last_minute_as_seen_by_his_camera(
    open_viewer: Open, open_file: Open, tmp_path: Path
) -> None:
    with Visualizer(port=0) as viz:
        wheel = node_of(viz, LEFT_LINK)
        viewer = open_viewer(viz.url)
        viewer.wait_for_nodes(wheel)
        viewer.page.take_downloads(tmp_path)
        viewer.settle(viz)
        viewer.page.mouse.drag((600.0, 300.0), (660.0, 330.0))
        still = viewer.pose(wheel)
        # Nothing has moved: the dialog says so, and stays.
        viewer.user.menu("File", "Export Page…")
        viewer.user.click("radio", re.compile("^The last minute"), ("dialog", None))
        viewer.user.click("button", "Export")
        viewer.user.find("alert", None, ("dialog", "Export Page"))
        viewer.user.reads("Nothing has moved in the last minute")
        viewer.user.click("button", "Cancel", ("dialog", "Export Page"))
        viewer.user.gone("dialog", "Export Page")
        viz.set_joint_positions({"drivewhl_l_joint": 1.0})
        viewer.user.until(lambda: np.abs(viewer.pose(wheel) - still).max() > 0.5)
        viewer.settle(viz)
        turned = viewer.pose(wheel)
        camera = viewer.page.evaluate(CAMERA)
        viewer.user.menu("File", "Export Page…")
        viewer.user.find("radio", re.compile("^The last minute"), ("dialog", None))
        viewer.user.click("button", "Export")
        viewer.user.gone("dialog", "Export Page")
        viewer.user.reads("Saved sam_bot.html, 1.0 MB", 30.0)
        file = tmp_path / "sam_bot.html"
        viewer.user.until(lambda: file.exists() and b"</html>" in file.read_bytes())
    viewer.expects_errors = True
    alone = open_file(file)
    assert alone.page.evaluate(CAMERA) == pytest.approx(camera, abs=1e-4)
    assert not np.allclose(alone.pose(wheel), turned, atol=0.1)
    alone.user.click("button", "Loop")
    alone.user.keys(" ")
    # At the end it stays.
    alone.user.until(lambda: np.allclose(alone.pose(wheel), turned, atol=1e-4))
    alone.user.find("button", "Play")


def test_a_robot_with_a_hostile_name_is_shown_with_that_name(
    open_file: Open, tmp_path: Path
) -> None:
    name = HOSTILE.replace("<", "&lt;")
    model, file = tmp_path / "r.urdf", tmp_path / "r.html"
    model.write_text(
        f"""<robot name="{name}"><link name="{name}"><visual><geometry>
        <sphere radius="0.3"/></geometry></visual></link></robot>""",
        "utf-8",
    )
    with Visualizer(model=model, port=0) as viz:
        viz.export(file)
    viewer = open_file(file)
    assert viewer.page.evaluate("document.title") == HOSTILE
    viewer.user.find("heading", HOSTILE)
    # Without a joint there is nothing to play.
    assert viewer.user.see().all("button") == []

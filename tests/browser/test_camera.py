"""The picture of a Camera: the scene is where the camera sees it."""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import yaml
from camera_messages import cube, image, info, pose
from inside import session_of
from made_messages import write_messages
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = [pytest.mark.browser, pytest.mark.view]

WIDTH, HEIGHT = 320, 240
FX, FY, CX, CY = 200.0, 210.0, 150.0, 110.0
EYE = (0.0, 0.0, 1.0)
FORWARD = (-0.5, 0.5, -0.5, 0.5)
"""Turns a camera to the x axis of the map, with the z axis of the map upwards."""
CENTER, EDGE = (3.0, 0.3, 1.1), 0.8
GREY, SEEN, ABOVE, BLACK = (128,) * 3, (64, 192, 64), (0, 255, 0), (0,) * 3
"""The image; the cube with half of it; the cube alone; beside the image."""
PIXELS = """(() => {
  const canvas = document.querySelector(".camera canvas");
  const context = canvas.getContext("2d");
  return POINTS.map(([x, y]) =>
    [...context.getImageData(Math.round(x), Math.round(y), 1, 1).data].slice(0, 3));
})()"""
SIZE = """(() => {
  const { width, height } = document.querySelector(".camera canvas");
  return [width, height];
})()"""
DOUBT = "(document.querySelector('.camera .doubt')?.textContent || '')"
DRAWN = "window.sambotVizLook?.cameras > 0"
TAB = "document.querySelector('[data-tab=NAME]').click()"
PLUGIN = "rviz_default_plugins"


@pytest.fixture
def viz(tmp_path: Path, make_viz: Callable[..., Visualizer]) -> Visualizer:
    grey = np.full((HEIGHT, WIDTH, 3), 128, np.uint8)
    bag = write_messages(
        tmp_path / "camera.mcap",
        pose("camera", EYE, FORWARD),
        info("/camera_info", (FX, FY, CX, CY), (WIDTH, HEIGHT)),
        cube("/cube", CENTER, EDGE),
        image("/image", "rgb8", grey),
        image("/alone/image", "rgb8", grey),
    )
    marker = {"Class": f"{PLUGIN}/Marker", "Name": "Cube", "Topic": {"Value": "/cube"}}
    camera = {
        "Class": f"{PLUGIN}/Camera",
        "Name": "Camera",
        "Topic": {"Value": "/image"},
    }
    displays = [{**one, "Enabled": True} for one in (marker, camera)]
    options = {"Fixed Frame": "map"}
    manager = {"Class": "", "Displays": displays, "Global Options": options}
    config = tmp_path / "camera.rviz"
    config.write_text(yaml.safe_dump({"Visualization Manager": manager}))
    viz = make_viz(source=f"bag:{bag}", config=config)
    viz.player.pause()
    viz.player.jump(viz.player.duration)
    return viz


class Looked:
    """A page that shows the picture of the camera."""

    def __init__(self, page: ViewerPage) -> None:
        self.page = page
        page.page.wait_for("document.querySelector('[data-tab=images]')")
        page.page.evaluate(TAB.replace("NAME", "images"))
        page.wait_for(DRAWN)
        width, height = page.page.evaluate(SIZE)
        # As high as it is wide is what the camera sees, not a pixel of its image.
        self.across = min(width / WIDTH, height / HEIGHT * FY / FX)
        self.down = self.across * FX / FY
        self.left = (width - WIDTH * self.across) / 2
        self.top = (height - HEIGHT * self.down) / 2

    def at(self, u: float, v: float) -> tuple[float, float]:
        """Where a pixel of the image is in the picture."""
        return self.left + u * self.across, self.top + v * self.down

    def colors(self, points: list[tuple[float, float]]) -> npt.NDArray[np.int64]:
        script = PIXELS.replace("POINTS", json.dumps(points))
        return np.array(self.page.page.evaluate(script), np.int64)

    def until(self, point: tuple[float, float], color: tuple[int, ...]) -> None:
        def is_there() -> bool:
            found = self.colors([point])
            return found.size > 0 and bool((abs(found - color) <= 2).all())

        self.page.user.until(is_there)


@pytest.fixture
def looked(viz: Visualizer, open_viewer: Callable[..., ViewerPage]) -> Looked:
    return Looked(open_viewer(viz.url, resolution=1))


def pixel(x: float, y: float, z: float) -> tuple[float, float]:
    """Where the camera has a point of the map, by its numbers."""
    return FX * (EYE[1] - y) / x + CX, FY * (EYE[2] - z) / x + CY


def test_the_corners_of_a_cube_are_at_their_pixels(looked: Looked) -> None:
    near = CENTER[0] - EDGE / 2
    inside, outside = list[Any](), list[Any]()
    for y, z in itertools.product((-1, 1), repeat=2):
        corner = (near, CENTER[1] + y * EDGE / 2, CENTER[2] + z * EDGE / 2)
        column, row = looked.at(*pixel(*corner))
        # To the left of the map's y, to the bottom of its z.
        inside.append((column + 3 * y, row + 3 * z))
        outside += [(column - 3 * y, row + 3 * z), (column + 3 * y, row - 3 * z)]
    looked.until(inside[0], SEEN)
    assert abs(looked.colors(inside) - SEEN).max() <= 2
    assert abs(looked.colors(outside) - GREY).max() <= 2
    beside = (looked.left + 10, looked.top / 2)
    assert looked.colors([beside]).tolist() == [list(BLACK)]
    assert looked.page.errors() == []


def test_settings_and_other_displays_change_the_picture(
    viz: Visualizer, looked: Looked
) -> None:
    session = session_of(viz)
    edits, displays = session.display_edits, session.scene.displays
    cube_display, camera = displays
    middle = looked.at(*pixel(*CENTER))
    looked.until(middle, SEEN)
    edits.set_property(camera, "Image Rendering", "background")
    looked.until(middle, ABOVE)
    edits.set_entry(camera, "Visibility", "Cube", "Value", False)
    looked.until(middle, GREY)
    # In the view it is there all the same.
    shows = f"Object.entries(__viserMutable.nodeRefFromName).filter(([name, node]) => \
        name.includes('{cube_display.key}') && node.visible).length > 0"
    assert looked.page.page.evaluate(shows)
    edits.set_entry(camera, "Visibility", "Cube", "Value", True)
    looked.until(middle, ABOVE)
    edits.set_property(camera, "Far Plane Distance", 2.0)
    looked.until(middle, GREY)
    edits.set_property(camera, "Far Plane Distance", 100.0)
    looked.until(middle, ABOVE)
    # What changes in the scene needs no new image.
    edits.set_enabled(cube_display, False)
    looked.until(middle, GREY)
    edits.set_property(camera, "Image Rendering", "overlay")
    looked.until(middle, (64, 64, 64))
    # Without the numbers of the camera there is its image, and why.
    edits.set_property(camera, "Topic", "/alone/image")
    looked.page.wait_for(f"{SIZE}[0] === {WIDTH}")
    looked.page.wait_for(f"{DOUBT}.includes('received on [/alone/camera_info]')")


def test_a_picture_that_nobody_sees_is_not_drawn(
    viz: Visualizer, looked: Looked
) -> None:
    session = session_of(viz)
    cube_display, camera = session.scene.displays
    looked.page.page.evaluate(TAB.replace("NAME", "topics"))
    pictures = session.scene.context.pictures
    looked.page.user.until(lambda: not pictures.is_wanted(camera.key))
    before = looked.page.page.evaluate("window.sambotVizLook.cameras")
    session.display_edits.set_enabled(cube_display, False)
    looked.page.settle(viz)
    looked.page.wait_for_frames()
    assert looked.page.page.evaluate("window.sambotVizLook.cameras") == before
    looked.page.page.evaluate(TAB.replace("NAME", "images"))
    middle = looked.at(*pixel(*CENTER))
    looked.until(middle, GREY)

"""Mouse, fingers and keys move the camera by RViz's formulas, in a real page."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import viser
import yaml
from desk import Desk
from inside import node_of
from viewer_page import ViewerPage

from sambot_viz import Visualizer, bundled
from sambot_viz.views.camera import angles_of

pytestmark = [pytest.mark.browser, pytest.mark.view]

Open = Callable[..., ViewerPage]
SKY = (640.0, 120.0)
"""A place of the page with nothing but background."""
LOW = (640.0, 600.0)
"""A place where all views below look at the ground."""
FOV = math.tan(math.pi / 8)
"""RViz's field of view: half of the height of the picture at a distance of 1."""


@dataclass
class Shown:
    """A page, and the camera that it reports."""

    viz: Visualizer
    viewer: ViewerPage
    camera: viser.CameraHandle

    @property
    def position(self) -> Any:
        return np.array(self.camera.position)

    @property
    def target(self) -> Any:
        return np.array(self.camera.look_at)

    @property
    def distance(self) -> float:
        return float(np.linalg.norm(self.position - self.target))

    @property
    def angles(self) -> tuple[float, float]:
        """Yaw and pitch of RViz's Orbit."""
        return angles_of(self.position - self.target)

    @property
    def up(self) -> Any:
        """Up in the picture."""
        away = (self.position - self.target) / self.distance
        right = np.cross((0.0, 0.0, 1.0), away)
        return np.cross(away, right / np.linalg.norm(right))

    @property
    def raised_focal(self) -> Any:
        """The focal point of XYOrbit."""
        return self.target - 0.2 * self.distance * self.up

    @property
    def metres(self) -> float:
        """At the focal point, per pixel."""
        height: Any = self.viewer.page.evaluate("__viserMutable.canvas.clientHeight")
        return 2 * self.distance * FOV / height

    def rests(self) -> None:
        """Wait until the page has reported what it shows."""
        self.viewer.settle(self.viz)


_ENDS = """(({ cameraControl, camera, nodeRefFromName }) => {
  const world = nodeRefFromName[""], vector = camera.position.clone();
  return ["getPosition", "getTarget"].map(
    (end) => world.worldToLocal(cameraControl[end](vector)).toArray());
})(__viserMutable)"""


def config(kind: str = "Orbit", **values: Any) -> str:
    """sam_bot with a view."""
    config = yaml.safe_load(bundled.config_path().read_text("utf-8"))
    manager = config["Visualization Manager"]
    manager["Displays"] = [
        d for d in manager["Displays"] if not d["Class"].endswith("/TF")
    ]
    manager["Global Options"]["Fixed Frame"] = "base_link"
    manager["Views"]["Current"] = {
        "Class": f"rviz_default_plugins/{kind}",
        "Name": "Current View",
        "Target Frame": "<Fixed Frame>",
        **{name.replace("_", " "): value for name, value in values.items()},
    }
    return yaml.safe_dump(config)


@pytest.fixture
def show(sit: Callable[..., Desk]) -> Callable[..., Shown]:
    """Look at sam_bot with a view: ``show("Orbit", Distance=3.0)``."""

    def one(kind: str, **values: Any) -> Shown:
        desk = sit("S mouse", config())
        desk.viewer.wait_for_nodes(node_of(desk.viz, "drivewhl_l_link"))
        view = desk.browser.view
        view.set_kind(f"rviz_default_plugins/{kind}")
        for name, value in values.items():
            given = tuple(value.values()) if isinstance(value, dict) else value
            view.set(name.replace("_", " "), given)
        desk.viewer.wait_for(f"window.sambotVizMouse?.kind === {kind!r}")
        shown = Shown(desk.viz, desk.viewer, desk.browser.client.camera)
        wanted = view.camera.position
        desk.user.until(
            lambda: np.allclose(desk.page.evaluate(_ENDS)[0], wanted, atol=1e-4)
        )
        shown.rests()
        return shown

    return one


@pytest.fixture
def show_alone(
    tmp_path: Path, make_viz: Callable[..., Visualizer], open_viewer: Open
) -> Callable[..., Shown]:
    """The same in a page of its own, on a screen that can be touched if need be."""

    def one(kind: str, touch: bool = False, **values: Any) -> Shown:
        path = tmp_path / "view.rviz"
        path.write_text(config(kind, **values), "utf-8")
        viz = make_viz(config=path)
        viewer = open_viewer(viz.url, touch=touch)
        viewer.wait_for_nodes(node_of(viz, "drivewhl_l_link"))
        viewer.wait_for(f"window.sambotVizMouse?.kind === {kind!r}")
        # The camera of the view has taken the place of viser's, at (3, 3, 3).
        viewer.wait_for(
            "Math.abs(__viserMutable.cameraControl.distance - Math.sqrt(27)) > 1e-3"
        )
        (client,) = viz.viser.get_clients().values()
        shown = Shown(viz, viewer, client.camera)
        shown.rests()
        return shown

    return one


ORBIT = {
    "Distance": 3.0,
    "Yaw": 1.0,
    "Pitch": 0.5,
    "Focal_Point": {"X": 0.0, "Y": 0.0, "Z": 0.0},
}


def test_orbit_turns_zooms_and_moves(show: Callable[..., Shown]) -> None:
    shown = show("Orbit", **ORBIT)
    mouse = shown.viewer.page.mouse
    mouse.drag(SKY, (SKY[0] - 20, SKY[1] + 30))
    shown.rests()
    assert np.allclose(shown.angles, (1.1, 0.65), atol=1e-4)
    assert shown.distance == pytest.approx(3.0)
    # Ten steps of ten pixels: 1 % of the distance per pixel of each.
    mouse.drag(SKY, (SKY[0] + 50, SKY[1] + 100), button="right")
    shown.rests()
    assert abs(shown.distance - 3.0 * 1.1**10) < 1e-5
    assert shown.target == pytest.approx(np.zeros(3), abs=1e-6)
    mouse.wheel(*SKY, dy=-100.0)
    shown.rests()
    assert abs(shown.distance - 3.0 * 1.1**10 * 0.88) < 1e-5
    assert np.allclose(shown.angles, (1.1, 0.65), atol=1e-4)
    low = (SKY[0], SKY[1] + 40)
    wanted = shown.target + 40 * shown.metres * shown.up
    mouse.drag(SKY, low, button="middle")
    shown.rests()
    assert shown.target == pytest.approx(wanted, abs=1e-6)
    wanted = shown.target + 40 * shown.metres * shown.up
    mouse.drag(SKY, low, "Shift")
    shown.rests()
    assert shown.target == pytest.approx(wanted, abs=1e-6)
    distance = shown.distance
    back = (shown.position - shown.target) / distance
    wanted = shown.target + 0.2 * distance * back
    mouse.drag(SKY, (SKY[0], SKY[1] + 20), "Shift", button="right", steps=1)
    shown.rests()
    assert np.allclose(shown.target, wanted, atol=1e-5)
    assert shown.distance == pytest.approx(distance)


def test_xy_orbit_turns_about_its_focal_point_and_moves_it_on_the_ground(
    show: Callable[..., Shown],
) -> None:
    shown = show("XYOrbit", **ORBIT)
    mouse, focal = shown.viewer.page.mouse, np.zeros(3)
    assert shown.raised_focal == pytest.approx(focal, abs=1e-5)
    mouse.drag(SKY, (SKY[0] - 100, SKY[1] + 30))
    shown.rests()
    assert np.allclose(shown.angles, (1.5, 0.65), atol=1e-4)
    assert shown.raised_focal == pytest.approx(focal, abs=1e-4)
    mouse.drag(SKY, (SKY[0], SKY[1] - 40), button="right", steps=4)
    shown.rests()
    assert abs(shown.distance - 3.0 * 0.9**4) < 1e-5
    assert shown.raised_focal == pytest.approx(focal, abs=1e-4)
    # The point of the ground under the mouse stays there.
    before = ground(shown, LOW)
    end = (LOW[0] + 90, LOW[1] - 60)
    mouse.drag(LOW, end, button="middle")
    shown.rests()
    assert np.allclose(ground(shown, end), before, atol=2e-3)
    assert shown.raised_focal[2] == pytest.approx(0.0, abs=1e-4)
    assert abs(shown.raised_focal[:2]).min() > 0.01


def test_over_the_sky_xy_orbit_does_not_move(show: Callable[..., Shown]) -> None:
    shown = show("XYOrbit", **(ORBIT | {"Pitch": 0.1}))
    before = shown.position
    shown.viewer.page.mouse.drag(SKY, (SKY[0] + 30, SKY[1] + 20), "Shift")
    shown.viewer.wait_for_frames()
    shown.rests()
    assert shown.position == pytest.approx(before)


def ground(shown: Shown, at: tuple[float, float]) -> Any:
    """The point of the ground at a place of the page."""
    box: Any = shown.viewer.page.evaluate(
        "(r => [r.x, r.y, r.width, r.height])"
        "(__viserMutable.canvas.getBoundingClientRect())"
    )
    x, y, width, height = box
    back = (shown.position - shown.target) / shown.distance
    right, pixel = np.cross(shown.up, back), 2 * FOV / height
    ray = (
        -back
        + right * (at[0] - x - width / 2) * pixel
        + shown.up * (y + height / 2 - at[1]) * pixel
    )
    return shown.position - ray * shown.position[2] / ray[2]


def test_fps_turns_in_place_and_walks(show: Callable[..., Shown]) -> None:
    start = {"X": 3.0, "Y": 1.0, "Z": 1.5}
    shown = show("FPS", Yaw=3.0, Pitch=0.4, Position=start)
    mouse, place = shown.viewer.page.mouse, np.array((3.0, 1.0, 1.5))
    mouse.drag(SKY, (SKY[0] - 20, SKY[1] + 10))
    yaw = 3.1 - math.pi + 2 * math.pi
    shown.rests()
    assert np.allclose(shown.angles, (yaw, 0.45), atol=1e-4)
    assert shown.position == pytest.approx(place, abs=1e-5)
    back = (shown.position - shown.target) / shown.distance
    mouse.drag(SKY, (SKY[0], SKY[1] + 10), button="right")
    shown.rests()
    assert np.allclose(shown.position, place + back, atol=1e-4)
    mouse.wheel(*SKY, dy=-100.0)
    wanted = place - 0.2 * back
    shown.rests()
    assert np.allclose(shown.position, wanted, atol=1e-4)
    wanted = wanted + 0.3 * np.cross(shown.up, back) - 0.1 * shown.up
    mouse.drag(SKY, (SKY[0] + 30, SKY[1] + 10), button="middle")
    shown.rests()
    assert np.allclose(shown.position, wanted, atol=1e-4)


def test_from_above_the_picture_turns_moves_and_is_scaled(
    show_alone: Callable[..., Shown],
) -> None:
    shown = show_alone("TopDownOrtho", Scale=200.0, Angle=0.3, X=0.1, Y=-0.2)
    mouse, far = shown.viewer.page.mouse, shown.distance
    mouse.drag(SKY, (SKY[0], SKY[1] + 20), button="right", steps=1)
    shown.rests()
    assert abs(far / shown.distance - 0.8) < 1e-4
    mouse.wheel(*SKY, dy=-100.0)
    shown.rests()
    assert abs(far / shown.distance - 0.8 * 1.12) < 1e-5
    scale = 200.0 * far / shown.distance
    mouse.drag(SKY, (SKY[0] + 50, SKY[1]), button="middle")
    right = np.array((math.cos(0.3), math.sin(0.3), 0.0))
    wanted = np.array((0.1, -0.2, 0.0)) - 50 / scale * right
    shown.rests()
    assert np.allclose(shown.target, wanted, atol=1e-5)
    mouse.drag(SKY, (SKY[0] + 20, SKY[1] + 50))
    shown.rests()
    across = np.cross(shown.up, (0.0, 0.0, 1.0))
    assert math.atan2(across[1], across[0]) == pytest.approx(0.4, abs=1e-5)
    assert shown.target == pytest.approx(wanted, abs=1e-5)


def test_a_disc_shows_the_focal_point_while_the_mouse_moves_the_camera(
    show: Callable[..., Shown],
) -> None:
    shown = show("Orbit", **(ORBIT | {"Focal_Point": {"X": 0.0, "Y": 0.0, "Z": 0.4}}))
    viewer, mouse = shown.viewer, shown.viewer.page.mouse
    yellow = 0.5 * np.array((255, 255, 0)) + 0.5 * 48

    def middle() -> Any:
        pixels = viewer.pixels()[..., :3].astype(int)
        return pixels[pixels.shape[0] // 2, pixels.shape[1] // 2]

    assert middle() == pytest.approx(np.full(3, 48), abs=2)
    mouse.move(*SKY)
    mouse.press()
    mouse.move(SKY[0] + 5, SKY[1] + 3)
    viewer.user.until(lambda: middle() == pytest.approx(yellow, abs=6))
    assert viewer.page.evaluate("__viserMutable.camera.layers.mask !== 1") is True
    mouse.release()
    viewer.user.until(lambda: middle() == pytest.approx(np.full(3, 48), abs=2))
    mouse.drag(SKY, (SKY[0] + 5, SKY[1]), button="right")
    assert middle() == pytest.approx(np.full(3, 48), abs=2)


def test_no_key_moves_the_camera(show: Callable[..., Shown]) -> None:
    shown = show("Orbit", **ORBIT)
    viewer, before = shown.viewer, shown.position
    for code in ("w", "a", "d", "q", "e", "ArrowUp", "ArrowLeft"):
        viewer.page.keyboard.hold(code)
        viewer.wait_for_frames()
        viewer.page.keyboard.release(code)
    viewer.wait_for_frames()
    shown.rests()
    assert shown.position == pytest.approx(before)


def test_one_finger_turns_and_two_move_and_zoom(
    show_alone: Callable[..., Shown],
) -> None:
    shown = show_alone("Orbit", touch=True, **ORBIT)
    touch, (x, y) = shown.viewer.page.touch, SKY
    touch.start(SKY)
    touch.move((x - 20, y + 30))
    shown.viewer.wait_for("window.sambotVizMouse.focal")
    touch.end()
    shown.viewer.wait_for("!window.sambotVizMouse.focal")
    shown.rests()
    assert np.allclose(shown.angles, (1.1, 0.65), atol=1e-4)
    before, metres, up = shown.target, shown.metres, shown.up
    touch.start((x - 50, y), (x + 50, y))
    touch.move((x - 50, y + 40), (x + 50, y + 40))
    touch.end()
    wanted = before + 40 * metres * up
    shown.rests()
    assert np.allclose(shown.target, wanted, atol=1e-5)
    distance = shown.distance
    assert distance == pytest.approx(3.0, abs=1e-5)
    touch.start((x - 50, y), (x + 50, y))
    touch.move((x - 100, y), (x + 100, y))
    touch.end()
    shown.rests()
    assert abs(shown.distance - distance / 2) < 1e-5
    assert shown.target == pytest.approx(wanted, abs=1e-5)
    assert shown.angles == pytest.approx((1.1, 0.65), abs=1e-4)
    shown.viewer.wait_for_frames()
    assert not shown.viewer.page.evaluate("window.sambotVizMouse.focal")

"""The camera obeys the mouse while it goes with a robot that moves, in any page."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import pytest
import yaml
from desk import Desk
from inside import node_of

from sambot_viz import bundled

pytestmark = [pytest.mark.browser, pytest.mark.view]

SKY = (640.0, 120.0)
"""A place of the page with nothing but background."""
NOTCH = 100.0
"""What a wheel turns by for one of its notches [CSS pixels]."""
SLOW = """(() => {
  const work = () => {
    if (!window.slow) return;
    const end = performance.now() + 100;
    while (performance.now() < end);
    requestAnimationFrame(work);
  };
  window.slow = true;
  requestAnimationFrame(work);
})()"""
"""Work that leaves the page at most ten pictures a second."""

WATCH_NAMES = """(() => {
  const { scene, nodeRefFromName } = __viserMutable;
  const draw = scene.onBeforeRender;
  window.nameGaps = [];
  scene.onBeforeRender = function (...args) {
    let places = [];
    scene.traverse(({ material }) => {
      const texture = material?.uniforms?.uLabelData?.value;
      if (texture) places = texture.image.data;
    });
    const names = Object.entries(__viserSceneTree.getState())
      .filter(([, node]) => node?.message?.type === "LabelMessage");
    const gaps = names.map(([name]) => {
      const frame = nodeRefFromName[name.slice(0, name.lastIndexOf("/"))];
      const [x, y, z] = frame.matrixWorld.elements.slice(12);
      return Math.min(...names.map((_, i) =>
        Math.hypot(places[4 * i] - x, places[4 * i + 1] - y, places[4 * i + 2] - z)));
    });
    window.nameGaps.push(Math.max(...gaps));
    draw.apply(this, args);
  };
})()"""
"""Note for each picture how far a name is from its frame at most [m]."""


def config() -> str:
    """sam_bot in odom, with a view that follows it."""
    config = yaml.safe_load(bundled.config_path().read_text("utf-8"))
    manager = config["Visualization Manager"]
    manager["Global Options"]["Fixed Frame"] = "odom"
    manager["Views"]["Current"] = {
        "Class": "rviz_default_plugins/Orbit",
        "Name": "Current View",
        "Target Frame": "base_link",
        "Distance": 2.0,
        "Yaw": 1.0,
        "Pitch": 0.5,
    }
    return yaml.safe_dump(config)


@pytest.fixture
def desk(sit: Callable[..., Desk]) -> Iterator[Desk]:
    """A page of a robot that drives in a circle."""
    desk = sit("S moving", config())
    desk.session.drive.enter_odom()
    desk.viewer.wait_for_nodes(node_of(desk.viz, "base_link"))
    desk.settle()
    desk.session.drive.set_velocity(0.4, 0.4)
    yield desk
    desk.page.evaluate("window.slow = false")
    desk.session.drive.stop()


def has_moved(desk: Desk) -> bool:
    """Whether the robot is elsewhere than at its start."""
    pose = desk.session.drive.pose
    return math.hypot(pose.x, pose.y) > 0.1


@pytest.mark.parametrize("kind", ["Orbit", "XYOrbit", "ThirdPersonFollower"])
def test_wheel_and_drag_do_the_same_as_when_it_stands(desk: Desk, kind: str) -> None:
    view, mouse = desk.browser.view, desk.page.mouse
    if kind == "Orbit":
        # All of them are moved by the same script: one in a slow page is enough.
        desk.page.evaluate(SLOW)
    view.set_kind(f"rviz_default_plugins/{kind}")
    view.set("Distance", 2.0)
    view.set("Yaw", 1.0)
    focal = view.values["Focal Point"]
    desk.viewer.wait_for(f"window.sambotVizMouse.kind === {kind!r}")
    desk.user.until(lambda: has_moved(desk) and view.confirmed)
    for _ in range(5):
        mouse.wheel(*SKY, dy=-NOTCH)
    nearer = 2.0 * 0.88**5
    desk.user.until(lambda: abs(view.values["Distance"] - nearer) < 1e-4)
    mouse.drag(SKY, (SKY[0] - 100, SKY[1]))
    desk.user.until(lambda: abs(view.values["Yaw"] - 1.5) < 1e-4)
    for _ in range(5):
        mouse.wheel(*SKY, dy=NOTCH)
    farther = nearer * 1.12**5
    desk.user.until(lambda: abs(view.values["Distance"] - farther) < 1e-4)
    # The camera has gone with the robot, and not in its own time.
    assert view.values["Yaw"] == pytest.approx(1.5, abs=1e-4)
    assert view.values["Focal Point"] == pytest.approx(focal, abs=1e-4)


def test_names_are_drawn_where_their_frames_are(desk: Desk) -> None:
    desk.page.evaluate(SLOW)
    desk.page.evaluate(WATCH_NAMES)
    desk.viewer.wait_for("window.nameGaps.length > 4")
    desk.user.until(lambda: has_moved(desk))
    assert max(desk.page.evaluate("window.nameGaps")) < 1e-5

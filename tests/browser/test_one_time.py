"""What a message moves and what it draws are in the same picture."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from inside import node_of, session_of
from made_recording import START, Message, header, store_of_all, transforms_message
from made_recording import write_messages as write
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = [pytest.mark.browser, pytest.mark.view]

CONFIG = """
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/TF, Enabled: true}
    - Class: rviz_default_plugins/PointCloud2
      Enabled: true
      Topic: {Value: /cloud}
      Style: Points
      Size (Pixels): 1
    - Class: rviz_default_plugins/Polygon
      Enabled: true
      Topic: {Value: /outline}
  Global Options:
    Fixed Frame: odom
"""
WATCH = """(() => {
  const { scene, camera, nodeRefFromName } = __viserMutable;
  const [prepare, tidy] = [scene.onBeforeRender, scene.onAfterRender];
  const xOf = (object, [x, y, z]) => nodeRefFromName[""].worldToLocal(
    object.localToWorld(camera.position.clone().set(x, y, z))).x;
  window.seen = [];
  // A picture waits only for a while for its rest; a slow server is not the point.
  const now = performance.now();
  performance.now = () => now;
  scene.onBeforeRender = function (...args) {
    scene.updateMatrixWorld();
    prepare.apply(this, args);
    const found = { base: xOf(nodeRefFromName[BASE], [0, 0, 0]) };
    scene.traverse((one) => {
      const { drawAs } = one.userData;
      const { center, position } = one.geometry?.attributes || {};
      if (drawAs === "points" && center) found.cloud = xOf(one, center.array);
      if (drawAs === "lines") found.outline = xOf(one, position.array);
    });
    window.seen.push([found.base, found.cloud ?? null, found.outline ?? null]);
    // It is noted; to draw thousands of points takes software a long time.
    scene.visible = false;
  };
  scene.onAfterRender = function (...args) {
    scene.visible = true;
    tidy.apply(this, args);
  };
  __viserMutable.scene.__r3f.root.getState().gl.hurry += 1;
})()"""
"""Note for each picture x of the frame, the point and the corner of the outline [m]."""


def messages(points: int) -> Iterator[Message]:
    """Two seconds in which a frame goes along x; all else says where it is.

    Args:
        points: of each cloud; they are all at the origin of the fixed frame.
    """
    store = store_of_all()
    types, numbers = store.types, ("x", "y", "z")
    field, corner = (
        types["sensor_msgs/msg/PointField"],
        types["geometry_msgs/msg/Point32"],
    )
    for x in np.arange(0.0, 2.0, 1 / 30).tolist():
        time = START * 10**9 + round(x * 1e9)
        moved = transforms_message(store, x, {"base": "odom"})
        yield "/tf", "tf2_msgs/msg/TFMessage", time, moved
        at_origin = np.tile(np.array([-x, 0.0, 0.0], np.float32), points)
        fields = [field(name, 4 * n, 7, 1) for n, name in enumerate(numbers)]
        shape = (1, points, fields, False, 12, 12 * points, at_origin.view(np.uint8))
        kind = "sensor_msgs/msg/PointCloud2"
        yield "/cloud", kind, time, types[kind](header(store, x, "base"), *shape, True)
        outline = types["geometry_msgs/msg/Polygon"](
            [corner(x, 0.0, 0.0), corner(x + 1.0, 0.0, 0.0), corner(x, 1.0, 0.0)]
        )
        kind = "geometry_msgs/msg/PolygonStamped"
        yield "/outline", kind, time, types[kind](header(store, x, "odom"), outline)


@pytest.mark.parametrize("points", [10, pytest.param(30_000, marks=pytest.mark.slow)])
def test_a_step_is_one_picture(
    make_viz: Callable[..., Visualizer],
    open_viewer: Callable[..., ViewerPage],
    tmp_path: Path,
    points: int,
) -> None:
    file, config = write(tmp_path / "one.mcap", messages(points)), tmp_path / "one.rviz"
    config.write_text(CONFIG)
    viz = make_viz(source=f"bag:{file}", config=config)
    viz.player.pause()
    viz.player.jump(0.5)
    page = open_viewer(viz.url)
    page.settle(viz)
    page.page.evaluate(WATCH.replace("BASE", repr(node_of(viz, "base"))))
    data = session_of(viz).data
    assert data is not None and data.player is not None
    # Some steps go out together, whatever the page is doing; then it has them all.
    for _ in range(3):
        for _ in range(3):
            data.player.advance(1 / 30)
        page.settle(viz)
    seen: list[tuple[float, float, float]] = page.page.evaluate("window.seen")
    bases = [base for base, _, _ in seen]
    assert len(set(bases)) >= 3
    for base, cloud, outline in seen:
        assert (cloud, outline) == (pytest.approx(0.0, abs=1e-3), pytest.approx(base))

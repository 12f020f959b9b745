"""A browser page that shows a viser server, with what tests want to know about it.

    def test_the_wheel_turns(open_viewer, server):
        viewer = open_viewer(server.url)
        viewer.wait_for_nodes("/fixed/wheel")
        before = viewer.pixels()
        viewer.user.click("button", "Center")
        viewer.wait_until_drawn()

`ViewerPage.page` is the page of the browser itself: mouse, keyboard, console, requests;
`ViewerPage.user` is someone who uses it.
The three.js objects are reached through `__viserMutable`, which viser keeps for its own
tests.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Sequence
from typing import Any, cast

import numpy as np
import numpy.typing as npt
from page_fence import settle, settle_rows
from recorded_page import RecordedPage
from window_page import COARSE, Pixels, WindowPage, decoded, viewer_url

from sambot_viz import Visualizer

__all__ = ["COARSE", "Pixels", "ViewerPage", "viewer_url"]

_NO_VIEW = "this page has no view: open it with view=True"
Matrix = npt.NDArray[np.float64]
_HAS_ROWS = "document.querySelector('#sambot [role=row], #sambot .panel.lesson h2')"
"""A lesson is in front of the other panels in a narrow window."""
_HAS_SCENE = (
    "__viserMutable.canvas && __viserMutable.scene && !__viserMutable.firstMessageBatch"
)
# viser draws for a quarter of a second after each message. Where nobody looks, most of
# these pictures are left out, as on a slow machine; the last one never is.
_DRAW_SELDOM = """(() => {
  const { gl, camera, invalidate } = __viserMutable.scene.__r3f.root.getState();
  const draw = gl.render;
  let last = -Infinity;
  let pause = 0;
  let later = null;
  gl.hurry = 0;
  gl.asleep = false;
  gl.render = (scene, eye) => {
    // A picture that was asked for has a camera of its own.
    const own = eye === camera;
    if (gl.asleep && own) return;
    const left = last + pause - performance.now();
    if (own && gl.hurry === 0 && left > 0) {
      later ??= setTimeout(() => {
        later = null;
        last = -Infinity;
        invalidate();
      }, left);
      return;
    }
    last = performance.now();
    draw.call(gl, scene, eye);
    // Software draws a long time after this call, the longer the more it was told.
    // One that took a second is not followed by none for half a minute: until the next
    // picture, viser shows what the page's scripts hide.
    pause = Math.min(2000, Math.max(400, 30 * (performance.now() - last)));
  };
})()"""
_TWO_FRAMES = """new Promise(done => {
  const { gl } = __viserMutable.scene.__r3f.root.getState();
  gl.hurry += 1;
  __viserMutable.requestRender();
  requestAnimationFrame(() => requestAnimationFrame(() => {
    gl.hurry -= 1;
    done(null);
  }));
})"""
_SLEEP = """(() => {
  const { gl, invalidate } = __viserMutable.scene.__r3f.root.getState();
  gl.asleep = ASLEEP;
  invalidate();
})()"""
_SET_RESOLUTION = """(() => {
  const { viewport, setDpr } = __viserMutable.scene.__r3f.root.getState();
  const before = viewport.dpr;
  if (before !== WANTED) setDpr(WANTED);
  return before;
})()"""
_PICTURE = """(() => {
  const shown = __viserMutable.canvas;
  const copy = document.createElement("canvas");
  const gl = shown.getContext("webgl2");
  copy.width = gl.drawingBufferWidth; copy.height = gl.drawingBufferHeight;
  copy.getContext("2d").drawImage(shown, 0, 0);
  return copy.toDataURL("image/png").split(",")[1];
})()"""
_PROJECT = """(() => {
  const { camera, canvas, nodeRefFromName } = __viserMutable;
  const node = nodeRefFromName[NAME];
  node.updateWorldMatrix(true, false);
  camera.updateMatrixWorld();
  const point = camera.position.clone().set(...POINT);
  node.localToWorld(point).project(camera);
  const { clientWidth, clientHeight } = canvas;
  return [(point.x + 1) / 2 * clientWidth, (1 - point.y) / 2 * clientHeight];
})()"""
_POSE = """(() => {
  const nodes = __viserMutable.nodeRefFromName;
  for (const name of [PARENT, NAME]) nodes[name].updateWorldMatrix(true, false);
  const inverse = nodes[PARENT].matrixWorld.clone().invert();
  return inverse.multiply(nodes[NAME].matrixWorld).elements;
})()"""


class ViewerPage(WindowPage):
    """One page with a viser viewer in it, or with an empty place for it."""

    def __init__(
        self, page: RecordedPage, url: str, finger: bool = False, view: bool = True
    ) -> None:
        """Wait until `page`, which is at `url`, is connected and has drawn."""
        super().__init__(page, url, finger)
        self.has_view = view
        self.wait_for(_HAS_SCENE if view else _HAS_ROWS, timeout=30.0)
        if view:
            self._ask(_DRAW_SELDOM)
            self.wait_for_frames()

    # Waiting.

    def wait_for(self, condition: str, timeout: float = 10.0) -> None:
        """Wait until a JavaScript expression is true."""
        assert self.has_view or "__viser" not in condition, _NO_VIEW
        super().wait_for(condition, timeout)

    def sleep(self, asleep: bool = True) -> None:
        """Draw nothing while no test uses the page."""
        if not self.has_view:
            return
        self._ask(_SLEEP.replace("ASLEEP", "true" if asleep else "false"))

    def minimize(self, minimized: bool = True) -> None:
        """Hide the page as a desktop does, or show it again."""
        # A page that is to seem focused is never hidden.
        focus = {"enabled": not minimized}
        self.page.call("Emulation.setFocusEmulationEnabled", focus)
        window = self.page.call("Browser.getWindowForTarget")["windowId"]
        state = "minimized" if minimized else "normal"
        bounds = {"windowId": window, "bounds": {"windowState": state}}
        self.page.call("Browser.setWindowBounds", bounds)
        # What is hidden has no frames to ask at.
        self.user.until(lambda: self.page.evaluate("document.hidden") == minimized)

    def wait_for_frames(self) -> None:
        """Ask for a picture and wait until two frames have been drawn."""
        if not self.has_view:
            return self.wait_for("new Promise(requestAnimationFrame)")
        self._ask(_TWO_FRAMES)

    def wait_for_nodes(self, *names: str, timeout: float = 20.0) -> None:
        """Wait until scene nodes exist in three.js and have been drawn."""
        wanted = json.dumps(names)
        self.wait_for(
            f"{wanted}.every(n => n in __viserSceneTree.getState()"
            " && __viserMutable.nodeRefFromName[n])",
            timeout,
        )
        self.wait_until_drawn(timeout)

    def settle(self, viz: Visualizer) -> None:
        """Wait until all that was done, here or in Python, is in the page."""
        if not self.has_view:
            return settle_rows(self.page, viz)
        settle(self.page, viz)
        self.wait_until_drawn()

    def wait_until_drawn(self, timeout: float = 10.0) -> None:
        """Wait until every pose that has reached the page is in the picture.

        What is still on its way is not waited for: `settle` does that.
        """
        self.wait_for(
            # Hidden labels have a pose but, until they are shown, no object to pose.
            "__viserMutable.messageQueue.length === 0 && "
            "Object.entries(__viserMutable.nodePoseData)"
            ".every(([name, pose]) => pose?.poseUpdateState !== 'needsUpdate'"
            " || !__viserMutable.nodeRefFromName[name])",
            timeout,
        )
        self.wait_for_frames()

    def wait_for_pose(
        self, name: str, T_parent_node: Matrix, parent: str = "", atol: float = 1e-4
    ) -> None:
        """Wait until a node is where it should be in three.js."""
        # three.js keeps matrices column by column.
        wanted = [
            float(T_parent_node[row, col]) for col in range(4) for row in range(4)
        ]
        self._wait_for_objects(name, parent)
        pose = self._pose_script(name, parent)
        self.wait_for(f"{pose}.every((v, i) => Math.abs(v - {wanted}[i]) < {atol})")
        self.wait_for_frames()

    # Looking.

    @property
    def nodes(self) -> list[str]:
        """The names of the scene nodes that three.js has."""
        return cast(
            list[str],
            self._ask(
                "Object.entries(__viserMutable.nodeRefFromName)"
                ".filter(([_, node]) => node).map(([name]) => name)"
            ),
        )

    def pose(self, name: str, parent: str = "") -> Matrix:
        """T_parent_node in three.js, (4, 4); the parent "" is viser's world.

        A node that is not there yet is waited for.
        """
        self._wait_for_objects(name, parent)
        elements: Any = self._ask(self._pose_script(name, parent))
        columns = [elements[start : start + 4] for start in range(0, 16, 4)]
        return np.array(list(zip(*columns, strict=True)), np.float64)

    def set_resolution(self, resolution: float) -> float:
        """Draw so many pixels per CSS pixel, until the view changes its size.

        Returns:
            How many it were before.
        """
        if not self.has_view:
            return resolution
        before = self._change_resolution(resolution)
        if before != resolution:
            # The size of letters on the screen follows that of the picture.
            self.wait_for_frames()
        return before

    def pixels(self) -> Pixels:
        """The 3D view alone, without panels: (height, width, 4), RGBA, 0 to 255.

        It is drawn in full resolution for that.
        """
        before = self._change_resolution(1.0)
        self.wait_for_frames()
        # A view that changes its size meanwhile is coarse again.
        while self._change_resolution(1.0) != 1.0:
            self.wait_for_frames()
        png = base64.b64decode(str(self._ask(_PICTURE)))
        self._change_resolution(before)
        return decoded(png)

    def project(
        self, name: str = "", point: Sequence[float] = (0.0, 0.0, 0.0)
    ) -> tuple[int, int]:
        """Where a point of a node is in `pixels`: (column, row).

        Args:
            name: the node; "" is viser's world, which is our fixed frame.
            point: x, y, z in the node's coordinates [m].
        """
        self._wait_for_objects(name)
        script = _PROJECT.replace("NAME", json.dumps(name))
        script = script.replace("POINT", json.dumps([float(v) for v in point]))
        x, y = cast(tuple[float, float], self._ask(script))
        return round(x), round(y)

    def on_page(self, point: Sequence[float]) -> tuple[float, float]:
        """Where a point of the fixed frame is on the page [CSS pixels]."""
        column, row = self.project("", point)
        left, top = self._ask(
            "(r => [r.x, r.y])(__viserMutable.canvas.getBoundingClientRect())"
        )
        return left + column, top + row

    def is_covered(self, column: int, row: int) -> bool:
        """Whether something of the page lies over this pixel of the 3D view."""
        seen = (
            "(() => { const r = __viserMutable.canvas.getBoundingClientRect();"
            f" return document.elementFromPoint(r.x + {column}, r.y + {row})"
            " === __viserMutable.canvas; })()"
        )
        return not self._ask(seen)

    def _ask(self, script: str) -> Any:
        """Ask the scene for something."""
        assert self.has_view, _NO_VIEW
        return self.page.evaluate(script)

    def _change_resolution(self, resolution: float) -> float:
        script = _SET_RESOLUTION.replace("WANTED", str(resolution))
        return float(cast("float", self._ask(script)))

    def _wait_for_objects(self, *names: str) -> None:
        """Wait until three.js has an object for each of these nodes."""
        wanted = json.dumps(names)
        self.wait_for(f"{wanted}.every(n => __viserMutable.nodeRefFromName[n])", 20.0)

    def _pose_script(self, name: str, parent: str) -> str:
        script = _POSE.replace("PARENT", json.dumps(parent))
        return script.replace("NAME", json.dumps(name))

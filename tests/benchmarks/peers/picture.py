"""A viewer's page in Chromium: when its picture shows the robot, and when it changes.

Every canvas keeps what it has drawn, so that a script can look at it after each frame;
that costs all viewers the same.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit

from tests.benchmarks.peers.driven import NotMeasured

from sambot_viz.export.browser_page import BrowserPage
from sambot_viz.export.chromium import Chromium
from sambot_viz.export.devtools import BrowserError

WIDTH, HEIGHT = 1280, 720
ENOUGH = 10
"""So many pixels of the small copy are the robot."""
CLOSE = 40
"""So far the parts of its colour that are there are above those that are not."""
WATCH = """(() => {
  const get = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    if (!/^webgl/.test(kind)) return get.call(this, kind, options);
    return get.call(this, kind, { ...options, preserveDrawingBuffer: true });
  };
  const small = document.createElement("canvas");
  [small.width, small.height] = [320, 180];
  const context = get.call(small, "2d", { willReadFrequently: true });
  const colour = COLOUR;
  const seen = (window.benchmarkSeen = { robot: null, changes: [] });
  let before = null;
  const look = () => {
    requestAnimationFrame(look);
    const shown = [...document.querySelectorAll("canvas")].sort(
      (a, b) => b.width * b.height - a.width * a.height)[0];
    if (!shown || !shown.width) return;
    context.drawImage(shown, 0, 0, small.width, small.height);
    const data = context.getImageData(0, 0, small.width, small.height).data;
    let robot = 0, hash = 0;
    for (let i = 0; i < data.length; i += 4) {
      hash = (hash * 31 + data[i] + data[i + 1] * 7 + data[i + 2] * 13) | 0;
      const there = [], away = [];
      for (let k = 0; k < 3; k++) (colour[k] ? there : away).push(data[i + k]);
      if (Math.min(...there) - Math.max(...away) > CLOSE) robot += 1;
    }
    const now = (performance.timeOrigin + performance.now()) / 1000;
    if (robot >= ENOUGH) seen.robot ??= now;
    if (hash !== before) seen.changes.push(now);
    before = hash;
  };
  requestAnimationFrame(look);
})()"""


@dataclass(frozen=True, slots=True)
class Weight:
    """What a page brings.

    Attributes:
        size: of all that its own server has sent, after decompression [MB].
        hosts: the other hosts that it has asked for something.
    """

    size: float
    hosts: tuple[str, ...]


class Watched:
    """A page that is open, or about to be."""

    def __init__(self, browser: Chromium, colour: tuple[int, int, int]) -> None:
        self._page: BrowserPage = browser.open(width=WIDTH, height=HEIGHT)
        script = WATCH.replace("COLOUR", json.dumps(colour))
        script = script.replace("ENOUGH", str(ENOUGH)).replace("CLOSE", str(CLOSE))
        self._page.call("Page.addScriptToEvaluateOnNewDocument", {"source": script})

    def goto(self, url: str) -> None:
        """Open the viewer."""
        try:
            self._page.goto(url)
        except BrowserError as error:
            raise NotMeasured(str(error)[:160]) from error

    def robot_at(self, longest: float = 60.0) -> float:
        """When the robot was first seen (`time.time`) [s]."""
        try:
            self._page.wait_for("benchmarkSeen.robot", longest)
        except BrowserError as error:
            raise NotMeasured("no pixel of the robot's colour is seen") from error
        return float(self._page.evaluate("benchmarkSeen.robot"))

    def settle(self, quiet: float = 2.0, longest: float = 60.0) -> None:
        """Wait until the picture has not changed for so long [s]."""
        try:
            self._page.wait_for(
                "(performance.timeOrigin + performance.now()) / 1000 - "
                f"(benchmarkSeen.changes.at(-1) ?? Infinity) > {quiet}",
                longest,
            )
        except BrowserError as error:
            raise NotMeasured("its picture does not come to rest") from error

    def changed_after(self, at: float, longest: float = 20.0) -> float:
        """When the picture first changed after `at` (`time.time`) [s]."""
        first = f"benchmarkSeen.changes.find(t => t > {at:.6f})"
        try:
            self._page.wait_for(first, longest)
        except BrowserError as error:
            raise NotMeasured("the picture does not change") from error
        return float(self._page.evaluate(first))

    def evaluate(self, script: str) -> Any:
        """Run a script in the page."""
        return self._page.evaluate(script)

    def weight(self, url: str) -> Weight:
        """What it has brought so far."""
        entries: list[list[Any]] = self._page.evaluate(
            "[...performance.getEntriesByType('resource'),"
            " ...performance.getEntriesByType('navigation')]"
            ".map(e => [e.name, e.decodedBodySize])"
        )
        own = urlsplit(url).hostname
        parts = [(urlsplit(str(name)), int(size)) for name, size in entries]
        hosts = {p.hostname for p, _ in parts if p.scheme.startswith(("http", "ws"))}
        size = sum(size for part, size in parts if part.hostname == own)
        return Weight(size / 1e6, tuple(sorted(str(h) for h in hosts - {own, None})))

    def close(self) -> None:
        """Close the window."""
        self._page.close()

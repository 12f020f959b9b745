"""What our own scripts cost the page: at rest, in a frame, and while joints move."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any, cast
from urllib.parse import urlsplit

import pytest
import robots
import viser
from protocol_client import ProtocolClient
from viewer_page import viewer_url

from sambot_viz.export.browser_page import BrowserPage
from sambot_viz.export.chromium import Chromium
from sambot_viz.options import Options
from sambot_viz.server.listener import listen

RunServer = Callable[[list[str]], AbstractContextManager[Any]]
PARTS = 1000
MOST = 1.0
"""Of our scripts in a frame [ms]."""
MOST_SHARE = 0.15
"""Of our scripts in all that the page does while a joint moves."""
SECONDS = 4.0
STEPS_PER_SECOND = 60.0
"""As a mouse sends them."""
MODELS = {
    "the robot of the program": ("", "drivewhl_l_joint"),
    "300 joints": (robots.chain(), "joint_1"),
}
# rviz_look.js does its work before three.js draws a scene.
TIME_LOOK = """(() => {
  const scene = __viserMutable.scene, look = scene.onBeforeRender;
  window.benchmarkLook = [];
  scene.onBeforeRender = function (...given) {
    const start = performance.now();
    look.apply(this, given);
    benchmarkLook.push(performance.now() - start);
  };
})()"""
DRAW_FORTY = """new Promise(resolve => {
  let left = 40;
  const next = () => {
    if (left-- === 0) return resolve(benchmarkLook);
    __viserMutable.requestRender();
    requestAnimationFrame(next);
  };
  next();
})"""


@contextmanager
def thousand_boxes() -> Iterator[viser.ViserServer]:
    """As many parts as a large robot has, half of them translucent."""
    listener = listen(Options(panels=False))
    server = listener.viser
    for i in range(PARTS):
        server.scene.add_box(
            f"/{i}",
            (0, 200, 200),
            (0.05, 0.05, 0.05),
            position=(i % 10 / 10, i // 10 % 10 / 10, i // 100 / 10),
            opacity=0.9 if i % 2 else None,
            cast_shadow=False,
            receive_shadow=False,
        )
    try:
        yield server
    finally:
        listener.close()


def test_a_frame_of_a_thousand_parts(chromium: Chromium) -> None:
    with thousand_boxes() as server:
        page = chromium.open(viewer_url(server.get_port(), 1.0), width=640, height=480)
        page.wait_for(f"sambotVizLook.lit >= {PARTS}", timeout=60.0)
        page.evaluate(TIME_LOOK)
        times = cast("list[float]", page.evaluate(DRAW_FORTY, timeout=120.0))
        page.close()
    cost = statistics.median(times)
    print(f"\n  {PARTS} parts: {cost:.2f} ms of a frame, {len(times)} frames")
    assert cost < MOST


@pytest.mark.parametrize("name", MODELS)
def test_at_rest_and_while_a_joint_moves(
    name: str,
    chromium: Chromium,
    run_server: RunServer,
    protocol: Callable[[int], ProtocolClient],
    tmp_path: Path,
) -> None:
    text, joint = MODELS[name]
    model = tmp_path / "robot.urdf"
    model.write_text(text, "utf-8")
    words = ["-m", "sambot_viz", "--port", "0", *([str(model)] if text else [])]
    with run_server(words) as started:
        page = chromium.open(viewer_url(started.url, 1.0))
        page.wait_for("document.querySelector('#sambot .joints input[type=range]')")
        page.wait_for("sambotVizLook.lit > 0", timeout=30.0)
        client = protocol(urlsplit(started.url).port or 0)
        page.evaluate(TIME_LOOK)
        rest = cost_of(page, lambda: time.sleep(SECONDS))
        row = client.id_of("joints", joint)
        moving = cost_of(page, lambda: drag(client, row))
        times = cast("list[float]", page.evaluate("benchmarkLook"))
        page.close()
    print(f"\n  {name}, at rest: {rest}")
    print(f"  {name}, a joint moves: {moving}")
    print(f"  {name}, before a frame: {statistics.median(times):.2f} ms")
    assert rest["scripts"] < 0.01 * 1000 * SECONDS
    assert moving["scripts"] < MOST_SHARE * moving["all"]
    if not text:
        # Without a GPU 300 joints are drawn so slowly that a frame has several steps.
        assert moving["scripts"] / moving["frames"] < MOST


def drag(client: ProtocolClient, row: str) -> None:
    """Move a joint as a mouse does."""
    start = time.perf_counter()
    for step in range(int(SECONDS * STEPS_PER_SECOND)):
        time.sleep(max(0.0, start + step / STEPS_PER_SECOND - time.perf_counter()))
        client.edit(row, 0.004 * (step + 1), gesture=1)


def cost_of(page: BrowserPage, run: Callable[[], object]) -> dict[str, float]:
    """What happens in a page meanwhile: frames, and times of its main thread [ms].

    "scripts" is all time in our scripts and what they call, "style" and "layout" those
    of the whole page, which only our panels need, and "all" the whole work.
    """
    for method in ("Profiler.enable", "Performance.enable"):
        page.call(method)
    page.call("Profiler.setSamplingInterval", {"interval": 500})
    frames, before = page.evaluate("sambotVizLook.frames"), metrics(page)
    page.call("Profiler.start")
    run()
    profile = page.call("Profiler.stop")["profile"]
    after = metrics(page)
    found = {"scripts": time_in_scripts(profile)}
    for name, metric in (
        ("style", "RecalcStyle"),
        ("layout", "Layout"),
        ("all", "Task"),
    ):
        key = f"{metric}Duration"
        found[name] = 1000 * (after[key] - before[key])
    found["frames"] = page.evaluate("sambotVizLook.frames") - frames
    return {key: round(value, 1) for key, value in found.items()}


def metrics(page: BrowserPage) -> dict[str, float]:
    """Chromium's counters of a page; durations in seconds."""
    return {
        m["name"]: m["value"] for m in page.call("Performance.getMetrics")["metrics"]
    }


def time_in_scripts(profile: dict[str, Any]) -> float:
    """How long our scripts ran, with all that they called [ms]."""
    ours: set[int] = set()
    # A node comes before its children.
    for node in profile["nodes"]:
        if node["id"] in ours or node["callFrame"]["url"].startswith("data:"):
            ours |= {node["id"], *node.get("children", ())}
    pairs = zip(profile["samples"], profile["timeDeltas"], strict=True)
    return sum(delta for sample, delta in pairs if sample in ours) / 1000

"""From a save to the message: ``pytest tests/benchmarks/bench_reload.py``."""

from __future__ import annotations

import shutil
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from protocol_client import ProtocolClient

from sambot_viz import Visualizer, bundled

pytestmark = pytest.mark.benchmark
LIMIT = 0.5
ROUNDS = 10


def test_a_save_of_sam_bot_reaches_the_browser_in_half_a_second(
    tmp_path: Path,
    protocol: Callable[[int], ProtocolClient],
    capsys: pytest.CaptureFixture[str],
) -> None:
    shutil.copytree(bundled.assets_folder(), tmp_path, dirs_exist_ok=True)
    model = tmp_path / "sam_bot.urdf.xacro"
    content = model.read_text("utf-8")
    width = '<xacro:property name="base_width" value="0.31"/>'
    assert width in content
    times: list[float] = []
    with Visualizer(model, watch=True) as viz:
        client = protocol(int(viz.url.rsplit(":", 1)[1]))
        client.settle(viz.viser)
        for number in range(ROUNDS):
            mark = client.mark()
            changed = width.replace("0.31", f"0.{40 + number}")
            start = time.perf_counter()
            model.write_text(content.replace(width, changed), "utf-8")
            client.wait_until(lambda mark=mark: client.types(mark)["BoxMessage"] > 0)
            times.append(time.perf_counter() - start)
            client.settle(viz.viser)
    with capsys.disabled():
        print(
            f"\n  save of sam_bot to its message: median {statistics.median(times):.3f}"
            f" s, longest {max(times):.3f} s of {ROUNDS} (limit {LIMIT} s)",
            end="",
        )
    assert statistics.median(times) <= LIMIT

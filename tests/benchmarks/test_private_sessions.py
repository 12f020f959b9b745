"""What one more private session costs: the robot's meshes are in memory once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import large_scene
from crowd import Crowd
from usage import usage

RunServer = Callable[[Sequence[str]], AbstractContextManager[Any]]
BROWSERS = 20


def test_one_more_private_session_costs_little(
    run_server: RunServer, tmp_path: Path
) -> None:
    model, meshes = large_scene.write_robot(tmp_path), large_scene.MESHES
    words = ["-m", "sambot_viz", str(model), "--port", "0", "--session", "private"]
    with run_server(words) as server, Crowd(server.port, 2, meshes=meshes):
        before = usage(server.process)
        with Crowd(server.port, BROWSERS, meshes=meshes):
            after = usage(server.process)
    memory = (after.memory - before.memory) / BROWSERS
    cpu = (after.cpu - before.cpu) / BROWSERS
    sent = meshes * large_scene.TRIANGLES * 50 / 2**20
    print(
        f"\n  one more private session of {sent:.0f} MB: {memory:.1f} MB of memory, "
        f"{cpu:.2f} s of computing; {after.peak - before.memory:.0f} MB more at the "
        f"peak of {BROWSERS} that join at once"
    )
    assert memory < sent / 5

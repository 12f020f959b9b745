"""viewurdf: its program in a thread; its sliders are moved as a program can."""

from __future__ import annotations

import sys
import threading
import time
from typing import Any

import viser
from speak import free_port, model_argument, obey
from viewurdf import cli

port = free_port()
made: dict[str, Any] = {}
add_slider = viser.GuiApi.add_slider


def remember(self: Any, label: str, *values: Any, **more: Any) -> Any:
    """Add the slider, and keep it by its label."""
    made[label] = add_slider(self, label, *values, **more)
    return made[label]


viser.GuiApi.add_slider = remember
options = ["--no-open", "--ip", "127.0.0.1", "--port", str(port)]
sys.argv = ["viewurdf", *options, model_argument()]
real, sys.stdout = sys.stdout, sys.stderr
threading.Thread(target=cli.main, daemon=True).start()
end = time.monotonic() + 60.0
while "Joint length" not in made and time.monotonic() < end:
    time.sleep(0.005)
sys.stdout = real
names = [n for n in made if n not in ("Link radius", "Joint radius", "Joint length")]


def move(moved: list[str], q: float) -> None:
    """Set sliders; each of them gives the robot a new configuration."""
    for name in moved:
        made[name].value = q


obey(
    f"http://127.0.0.1:{port}/?fixedDpr=1",
    names,
    move,
    subprotocol=f"viser-v{viser.__version__}",
)

"""From the command to the page, and to the robot's first pixels."""

from __future__ import annotations

import textwrap
import time
import urllib.request
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

import pytest

from sambot_viz import bundled
from sambot_viz.export.chromium import Chromium

RunServer = Callable[[list[str]], AbstractContextManager[Any]]
OURS = ["-m", "sambot_viz", "--port", "0"]
BARE_VISER = textwrap.dedent(
    """
    import contextlib, io, threading, viser
    with contextlib.redirect_stdout(io.StringIO()):
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    print(f"http://127.0.0.1:{server.get_port()}", flush=True)
    threading.Event().wait()
    """
)
# What viser's own example does with a URDF, without its sliders.
VISER_URDF = textwrap.dedent(
    """
    import contextlib, io, sys, threading, viser, yourdfpy
    from viser.extras import ViserUrdf
    with contextlib.redirect_stdout(io.StringIO()):
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    print(f"http://127.0.0.1:{server.get_port()}", flush=True)
    ViserUrdf(server, yourdfpy.URDF.load(sys.argv[1]))
    server.scene.add_grid("/grid")
    threading.Event().wait()
    """
)
# True once the picture has a pixel that is as much cyan as the robot's body is.
ROBOT_SEEN = """(() => {
  const shown = window.__viserMutable?.canvas;
  if (!shown) return false;
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [shown.width, shown.height];
  const context = copy.getContext("2d", { willReadFrequently: true });
  context.drawImage(shown, 0, 0);
  const data = context.getImageData(0, 0, copy.width, copy.height).data;
  for (let i = 0; i < data.length; i += 4)
    if (data[i + 3] > 200 && data[i + 1] > data[i] + 40 && data[i + 2] > data[i] + 40)
      return true;
  return false;
})()"""


@pytest.fixture(scope="module")
def plain_urdf(tmp_path_factory: pytest.TempPathFactory) -> str:
    """sam_bot as URDF, because viser's example reads no xacro."""
    import xacro  # pyright: ignore[reportMissingTypeStubs]

    reader: Any = xacro
    path = tmp_path_factory.mktemp("model") / "sam_bot.urdf"
    path.write_text(reader.process_file(str(bundled.model_path())).toxml(), "utf-8")
    return str(path)


def test_the_page_can_be_opened_nearly_as_soon_as_bare_viser(
    compare: Callable[..., Any], run_server: RunServer
) -> None:
    def opened(arguments: list[str]) -> float:
        with run_server(arguments) as started:
            with urllib.request.urlopen(started.url, timeout=60.0) as page:
                page.read(1)
            return time.perf_counter() - started.at

    result = compare(
        "from the command to the page",
        lambda: opened(OURS),
        lambda: opened(["-c", BARE_VISER]),
    )
    assert result.ratio <= 1.3, str(result)


def test_the_robot_is_seen_as_soon_as_with_the_example_of_viser(
    compare: Callable[..., Any],
    run_server: RunServer,
    chromium: Chromium,
    plain_urdf: str,
) -> None:
    def seen(arguments: list[str]) -> float:
        with run_server(arguments) as started:
            page = chromium.open(width=640, height=400)
            page.goto(f"{started.url}/?fixedDpr=1")
            page.wait_for(ROBOT_SEEN, timeout=120.0)
            taken = time.perf_counter() - started.at
            page.close()
            return taken

    result = compare(
        "from the command to the robot's first pixels",
        lambda: seen([*OURS, plain_urdf]),
        lambda: seen(["-c", VISER_URDF, plain_urdf]),
        rounds=5,
    )
    assert result.ratio <= 1.0, str(result)

"""Where the frame in a notebook's cell finds the page, in every kind of Jupyter."""

from __future__ import annotations

import http.server
import json
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from sambot_viz import Visualizer
from sambot_viz.jupyter.notebook import HEIGHT, notebook
from sambot_viz.options import Options

URL = "http://127.0.0.1:8123"


@pytest.fixture
def run_cell(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[[str, str], None]:
    """Be a kernel that runs a cell: ``run_cell(cell, run)``."""
    parent: dict[str, Any] = {}
    shell = SimpleNamespace(
        kernel=object(),
        config={"IPKernelApp": {"connection_file": str(tmp_path / "kernel-1.json")}},
        get_parent=lambda: parent,
    )
    module = SimpleNamespace(get_ipython=lambda: shell)
    monkeypatch.setitem(sys.modules, "IPython", module)
    monkeypatch.setenv("JPY_PARENT_PID", "77")
    monkeypatch.delenv("JUPYTERHUB_SERVICE_PREFIX", raising=False)

    def run(cell: str, number: str) -> None:
        parent.update(metadata={"cellId": cell}, header={"msg_id": number})

    run("a", "1")
    return run


@pytest.fixture(params=[404, 302])
def server(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[int]:
    """A Jupyter server without and with the proxy, by the status it answers with."""
    status: int = request.param

    class Answer(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            asked = self.path == "/user/ada/server-proxy/servers-info"
            self.send_response(status if asked else 500)
            self.end_headers()

        def log_message(self, format: str, *args: Any) -> None:
            pass

    with http.server.HTTPServer(("127.0.0.1", 0), Answer) as listening:
        about = {
            "base_url": "/user/ada/",
            "hostname": "0.0.0.0",
            "port": listening.server_port,
        }
        (tmp_path / "jpserver-77.json").write_text(json.dumps(about))
        thread = threading.Thread(target=listening.serve_forever, args=(0.01,))
        thread.start()
        yield status
        listening.shutdown()
        thread.join()


def test_a_script_and_a_terminal_are_no_notebook(
    run_cell: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    shell = SimpleNamespace()  # IPython in a terminal has no kernel
    monkeypatch.setattr(sys.modules["IPython"], "get_ipython", lambda: shell)
    assert notebook() is None
    monkeypatch.delitem(sys.modules, "IPython")
    assert notebook() is None
    with Visualizer() as viz:
        assert viz._repr_html_() is None  # pyright: ignore[reportPrivateUsage]


def test_without_a_jupyter_server_the_frame_shows_the_port(run_cell: object) -> None:
    here = notebook()
    assert here is not None
    assert here.options(Options()).token is None
    frame = here.frame(URL)
    assert f'<iframe src="{URL}" ' in frame and f'height="{HEIGHT}"' in frame
    assert f'<a href="{URL}" target="_blank">' in frame


def test_with_the_proxy_the_page_is_below_the_address_of_jupyter(
    run_cell: object, server: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JUPYTERHUB_SERVICE_PREFIX", "/user/ada/")
    here = notebook()
    assert here is not None
    if server == 404:
        assert "no jupyter-server-proxy" in here.frame(URL)
        assert "iframe" not in here.frame(URL)
        return
    token = here.options(Options()).token
    assert token
    assert here.options(Options(token="of-the-user")).token == "of-the-user"
    frame = here.frame(f"{URL}/robot/?token={token}")
    assert f'src="/user/ada/proxy/8123/?token={token}"' in frame


def test_a_hub_whose_server_is_on_another_machine_is_taken_to_have_the_proxy(
    run_cell: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JUPYTERHUB_SERVICE_PREFIX", "/user/ada/")
    here = notebook()
    assert here is not None
    assert 'src="/user/ada/proxy/8123/"' in here.frame(URL)


def test_a_cell_that_runs_again_stops_what_it_has_made(
    run_cell: Callable[[str, str], None],
) -> None:
    first, beside = Visualizer(), Visualizer()
    run_cell("b", "2")
    other = Visualizer()
    run_cell("a", "3")
    # The port is free again before the new one is made.
    again = Visualizer(port=int(first.url.rpartition(":")[2]))
    try:
        assert again.url == first.url
        for stopped in (first, beside):
            stopped.wait()
        other.set_joint_positions({"drivewhl_l_joint": 1.0})
    finally:
        other.stop()
        again.stop()

"""Where the frame in a notebook's cell finds the page, in every kind of Jupyter."""

from __future__ import annotations

import html
import http.client
import http.server
import json
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from email.message import Message
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from sambot_viz import Visualizer
from sambot_viz.jupyter.notebook import notebook
from sambot_viz.options import Options

URL = "http://127.0.0.1:8123"
KNOWN = "login=of-ada"
"""The cookie of who is logged in at the Jupyter server."""


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
            if self.path == "/user/ada/api/me":
                answer = 200 if self.headers["Cookie"] == KNOWN else 403
            else:
                asked = self.path == "/user/ada/server-proxy/servers-info"
                answer = status if asked else 500
            self.send_response(answer)
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


def get(port: int, path: str, headers: Mapping[str, str]) -> tuple[int, Message]:
    """The status and the headers of an answer; redirects are not followed."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10.0)
    with closing(connection):
        connection.request("GET", path, headers=dict(headers))
        answer = connection.getresponse()
        return answer.status, answer.headers


def test_a_script_and_a_terminal_are_no_notebook(
    run_cell: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    shell = SimpleNamespace()  # IPython in a terminal has no kernel
    monkeypatch.setattr(sys.modules["IPython"], "get_ipython", lambda: shell)
    assert notebook() is None
    monkeypatch.delitem(sys.modules, "IPython")
    assert notebook() is None
    with Visualizer() as viz:
        assert list(viz._repr_mimebundle_()) == ["text/plain"]


def test_without_a_jupyter_server_the_frame_shows_the_port(run_cell: object) -> None:
    here = notebook()
    assert here is not None
    assert here.options(Options()).token is None
    frame = html.unescape(here.frame(URL))
    assert f'<iframe src="{URL}" ' in frame
    assert f'<a href="{URL}" target="_blank">' in frame
    assert "<img" not in frame


def test_height_panels_and_picture_of_a_frame(run_cell: object) -> None:
    here = notebook()
    assert here is not None
    frame = html.unescape(here.frame(URL, height=300, panels=False, picture=b"PNG"))
    assert f'src="{URL}?panels=0"' in frame
    assert 'src="data:image/png;base64,UE5H"' in frame and "height: 300px" in frame
    with_token = html.unescape(here.frame(f"{URL}/?token=word", panels=False))
    assert f'src="{URL}/?token=word&panels=0"' in html.unescape(with_token)


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
    frame = html.unescape(here.frame(f"{URL}/robot/?token={token}"))
    assert 'src="/user/ada/proxy/8123/"' in frame
    # The notebook is saved with what its cells show.
    assert token not in frame


def test_whom_the_jupyter_server_knows_is_let_in_without_the_token(
    run_cell: object, server: int
) -> None:
    here = notebook()
    assert here is not None
    if server == 404:
        assert not here.knows(KNOWN)
        return
    assert here.knows(KNOWN)
    assert not here.knows("login=of-another")
    assert not here.knows("no\nheader")
    viz = Visualizer()
    try:
        port = int(viz.url.partition("?")[0].rstrip("/").rpartition(":")[2])
        answers = [get(port, "/", {}), get(port, "/", {"Cookie": "login=of-another"})]
        assert [status for status, _ in answers] == [401, 401]
        status, headers = get(port, "/?panels=0", {"Cookie": KNOWN})
        assert (status, headers["Location"]) == (303, "./?panels=0")
        cookie = headers["Set-Cookie"].partition(";")[0]
        assert get(port, "/", {"Cookie": cookie})[0] == 200
        # A wrong token is not made good by the cookies.
        assert get(port, "/?token=wrong-word", {"Cookie": KNOWN})[0] == 401
    finally:
        viz.stop()


def test_a_hub_whose_server_is_on_another_machine_is_taken_to_have_the_proxy(
    run_cell: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JUPYTERHUB_SERVICE_PREFIX", "/user/ada/")
    here = notebook()
    assert here is not None
    # There its cookies cannot be asked about: the frame has the token.
    assert not here.knows(KNOWN)
    frame = html.unescape(here.frame(f"{URL}/?token=word"))
    assert 'src="/user/ada/proxy/8123/?token=word"' in frame


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


def test_a_cell_has_the_page_and_a_picture_without_the_token(
    run_cell: object, server: int
) -> None:
    viz = Visualizer()
    try:
        for shown in (viz, viz.show(height=300, panels=False)):
            bundle = shown._repr_mimebundle_()
            assert list(bundle) == ["text/plain", "text/html", "image/png"]
            assert bundle["image/png"] in bundle["text/html"]
            token = viz.url.partition("token=")[2]
            assert bool(token) == (server == 302)
            assert not token or token not in str(bundle)
        assert "height: 300px" in bundle["text/html"]
    finally:
        viz.stop()

"""Who comes when there is no place left."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import ExitStack
from urllib.error import HTTPError
from urllib.request import urlopen

import pytest
import viser
from lower_limit import lower
from patience import until
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from sambot_viz.options import Options
from sambot_viz.server.listener import listen

MOST = 3
PRESENTER = "teach-the-class"


@pytest.fixture
def port(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    lower(monkeypatch, "PAGES", MOST)
    lower(monkeypatch, "CONNECTIONS", 10)
    with listen(Options(presenter=PRESENTER)) as listener:
        yield listener.viser.get_port()


def page(port: int, query: str = "") -> ClientConnection:
    protocol = Subprotocol(f"viser-v{viser.__version__}")
    return connect(f"ws://127.0.0.1:{port}/{query}", subprotocols=[protocol])


def test_a_page_too_many_reads_why_and_loads_when_one_has_left(port: int) -> None:
    address = f"http://127.0.0.1:{port}/"
    with ExitStack() as pages:
        first, *_ = (pages.enter_context(page(port)) for _ in range(MOST))
        with pytest.raises(InvalidStatus) as refused:
            page(port)
        assert refused.value.response.status_code == 503
        with pytest.raises(HTTPError) as no_page:
            urlopen(address)
        with no_page.value as answer:
            assert answer.code == 503
            assert answer.headers["Refresh"] == "10"
            assert f"shown in {MOST} pages already" in answer.read().decode()
        with page(port, f"?token={PRESENTER}"):
            pass
        first.close()
        with urlopen(address) as answer, page(port):
            assert answer.status == 200


def test_connections_that_say_nothing_leave_file_numbers_for_the_program(
    port: int, caplog: pytest.LogCaptureFixture
) -> None:
    silent = [socket.create_connection(("127.0.0.1", port), 10.0) for _ in range(10)]
    address = f"http://127.0.0.1:{port}"
    with ExitStack() as stack:
        for _ in range(100):
            one_more = socket.create_connection(("127.0.0.1", port), 10.0)
            stack.enter_context(one_more)
        # Those that say nothing give way to those that ask.
        with urlopen(f"{address}/healthz") as answer:
            assert answer.status == 200
        with pytest.raises(HTTPError) as no_page:
            urlopen(address)
        with no_page.value as answer:
            assert (answer.code, answer.headers["Refresh"]) == (503, "10")
            assert "has 10 connections already" in answer.read().decode()
        with pytest.raises(InvalidStatus) as refused:
            page(port)
        assert refused.value.response.status_code == 503
        silent.pop().close()
        stack.enter_context(until(lambda: page(port), not_yet=InvalidStatus))
    for connection in silent:
        connection.sendall(b"no request\r\n\r\n")
        assert connection.recv(1) == b""
        connection.close()
    with urlopen(f"http://127.0.0.1:{port}/") as answer:
        assert answer.status == 200
    assert caplog.records == []

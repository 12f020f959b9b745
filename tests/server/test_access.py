"""Which web pages may talk to the server."""

from __future__ import annotations

from collections.abc import Iterator
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import pytest
import viser
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Origin, Subprotocol

from sambot_viz.server.access import is_welcome, only_this_machine
from sambot_viz.server.bind import close, listen

PROTOCOL = Subprotocol(f"viser-v{viser.__version__}")


@pytest.mark.parametrize(
    ("host", "origin", "listening_on", "welcome"),
    [
        ("127.0.0.1:8080", None, "127.0.0.1", True),
        ("127.0.0.1:8080", "http://127.0.0.1:8080", "127.0.0.1", True),
        ("localhost:8080", "http://localhost:8080", "127.0.0.1", True),
        ("[::1]:8080", "http://[::1]:8080", "::1", True),
        ("127.0.0.1:8080", "https://evil.example", "127.0.0.1", False),
        ("127.0.0.1:8080", "http://127.0.0.1:9000", "127.0.0.1", False),
        ("127.0.0.1:8080", "null", "127.0.0.1", False),
        ("evil.example:8080", "http://evil.example:8080", "127.0.0.1", False),
        ("evil.example:8080", None, "127.0.0.1", False),
        ("[", None, "127.0.0.1", False),
        ("lab-robot:8080", "http://lab-robot:8080", "0.0.0.0", True),
        ("lab-robot:8080", "https://evil.example", "0.0.0.0", False),
    ],
)
def test_only_pages_of_this_server_are_welcome(
    host: str, origin: str | None, listening_on: str, welcome: bool
) -> None:
    assert is_welcome(host, origin, listening_on) is welcome


def test_it_is_known_which_addresses_only_this_machine_has() -> None:
    for host in ("127.0.0.1", "127.0.0.2", "::1", "localhost"):
        assert only_this_machine(host)
    for host in ("0.0.0.0", "::", "192.0.2.1", "lab-robot", ""):
        assert not only_this_machine(host)


def test_a_named_origin_is_welcome_through_a_proxy() -> None:
    allowed = ["https://lab.example.org"]
    for host in ("lab.example.org", "127.0.0.1:8080"):
        assert is_welcome(host, "https://lab.example.org", "127.0.0.1", allowed)
    assert not is_welcome("lab.example.org", "https://evil.example", "::1", allowed)


@pytest.fixture
def port() -> Iterator[int]:
    server = listen("127.0.0.1", 0)
    yield server.get_port()
    close(server)


def test_a_foreign_page_gets_no_connection(port: int) -> None:
    url = f"ws://127.0.0.1:{port}"
    with connect(
        url, origin=Origin(f"http://127.0.0.1:{port}"), subprotocols=[PROTOCOL]
    ):
        pass
    with pytest.raises(InvalidStatus) as refused:
        connect(url, origin=Origin("https://evil.example"), subprotocols=[PROTOCOL])
    assert refused.value.response.status_code == 403


def test_a_foreign_name_for_this_machine_gets_no_page(port: int) -> None:
    request = Request(f"http://127.0.0.1:{port}/", headers={"Host": "evil.example"})
    with pytest.raises(HTTPError) as refused:
        urlopen(request)
    with refused.value as answer:
        assert answer.code == 403
        assert b"--allow-origin" in answer.read()

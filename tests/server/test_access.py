"""Which web pages may talk to the server."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import pytest
import viser
from patience import patience
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Origin, Subprotocol

from sambot_viz.errors import UsageError
from sambot_viz.options import Options
from sambot_viz.server.handshake import without_base
from sambot_viz.server.listener import listen
from sambot_viz.server.protection.access import (
    content_policy,
    is_welcome,
    only_this_machine,
)

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
        ("a@127.0.0.1:8080", None, "127.0.0.1", False),
        ("127.0.0.1/;script-src:8080", None, "127.0.0.1", False),
        ("lab-robot:8080", "http://lab-robot:8080", "0.0.0.0", True),
        ("lab-robot:8080", "https://evil.example", "0.0.0.0", False),
    ],
)
def test_only_pages_of_this_server_are_welcome(
    host: str, origin: str | None, listening_on: str, welcome: bool
) -> None:
    assert is_welcome(host, origin, listening_on) is welcome


@pytest.mark.parametrize(
    ("host", "welcome"),
    [
        ("192.0.2.7:8080", True),
        ("[2001:db8::1]:8080", True),
        ("localhost:8080", True),
        (f"{socket.gethostname()}:8080", True),
        ("lab-robot", True),
        ("lab-robot.local:8080", True),
        ("Robot.LAN:8080", True),
        ("lab.example.org", False),
        ("evil.example:8080", False),
        ("192.0.2.7.evil.example:8080", False),
        ("evil.example.:8080", False),
        ("local:8080:1", False),
        ("", False),
    ],
)
def test_a_server_on_a_network_takes_no_name_that_a_stranger_can_buy(
    host: str, welcome: bool
) -> None:
    assert is_welcome(host, f"http://{host}", "0.0.0.0") is welcome
    assert is_welcome(host, None, "0.0.0.0") is welcome


def test_a_name_is_known_when_it_is_allowed_or_listened_on() -> None:
    for listening_on, allowed in (
        ("0.0.0.0", ["http://lab.example.org:8080"]),
        ("lab.example.org", []),
    ):
        for origin in ("http://lab.example.org:8080", None):
            assert is_welcome("lab.example.org:8080", origin, listening_on, allowed)
        for name in ("evil.example:8080", "x.lab.example.org:8080"):
            assert not is_welcome(name, None, listening_on, allowed)


def test_with_a_token_the_name_of_the_server_does_not_count() -> None:
    for host in ("hub.example.org", "127.0.0.1:8080"):
        for origin in (None, f"https://{host}"):
            assert is_welcome(host, origin, "127.0.0.1", any_name=True)
        assert not is_welcome(host, "https://evil.example", "127.0.0.1", any_name=True)
    assert not is_welcome("a b", None, "127.0.0.1", any_name=True)


def test_an_origin_that_is_not_an_address_is_refused() -> None:
    assert not is_welcome("127.0.0.1:8080", "http://[", "127.0.0.1")


def test_it_is_known_which_addresses_only_this_machine_has() -> None:
    for host in ("127.0.0.1", "127.0.0.2", "::1", "localhost"):
        assert only_this_machine(host)
    for host in ("0.0.0.0", "::", "192.0.2.1", "lab-robot", ""):
        assert not only_this_machine(host)


def test_an_allowed_origin_is_welcome_through_a_proxy() -> None:
    allowed = ["https://lab.example.org"]
    for host in ("lab.example.org", "127.0.0.1:8080"):
        assert is_welcome(host, "https://lab.example.org", "127.0.0.1", allowed)
    assert not is_welcome("lab.example.org", "https://evil.example", "::1", allowed)


@pytest.fixture
def port() -> Iterator[int]:
    with listen(Options()) as listener:
        yield listener.viser.get_port()


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
        sentence = answer.read()
        assert b"not known by this name" in sentence and b"--allow-origin" in sentence


def raw_answer(port: int, *headers: str) -> bytes:
    """The first line that the server answers to a request with these headers."""
    with socket.create_connection(
        ("127.0.0.1", port), timeout=patience(10.0)
    ) as connection:
        request = "\r\n".join(("GET / HTTP/1.1", *headers, "", ""))
        connection.sendall(request.encode())
        return connection.makefile("rb").readline()


@pytest.mark.parametrize("name", ["Host", "Origin", "Upgrade", "Accept-Encoding"])
def test_a_header_that_is_there_twice_is_refused(port: int, name: str) -> None:
    host = f"127.0.0.1:{port}"
    value = {"Host": host, "Origin": f"http://{host}"}.get(name, "websocket")
    headers = [f"{name}: {value}"] * 2 + ["Host: " + host] * (name != "Host")
    assert b" 400 " in raw_answer(port, *headers)


def test_a_request_without_a_host_is_refused(port: int) -> None:
    assert b" 400 " in raw_answer(port)


def test_a_path_that_no_file_can_have_is_not_found(port: int) -> None:
    with pytest.raises(HTTPError) as refused:
        urlopen(f"http://127.0.0.1:{port}/{'a' * 300}")
    with refused.value as answer:
        assert answer.code == 404


def test_a_page_of_another_machine_cannot_show_this_one_in_a_frame(port: int) -> None:
    with urlopen(f"http://127.0.0.1:{port}/") as answer:
        policy = answer.headers["Content-Security-Policy"]
    frames = "frame-ancestors 'self' http://localhost:* http://127.0.0.1:*"
    assert policy.partition("; ")[2] == frames


def test_an_allowed_origin_may_show_the_page_in_a_frame() -> None:
    policy = content_policy("lab:80", "0.0.0.0", ["https://lab.example.org"])
    assert policy.endswith("frame-ancestors 'self' https://lab.example.org")


def test_a_page_may_only_ask_its_own_server() -> None:
    policy = content_policy("lab:80", "0.0.0.0")
    asks = "connect-src 'self' ws://lab:80 wss://lab:80 data: blob:"
    assert policy.partition("; ")[0] == asks


def test_a_page_of_another_version_is_disconnected_and_nothing_is_printed(
    port: int, capfd: pytest.CaptureFixture[str]
) -> None:
    with connect(
        f"ws://127.0.0.1:{port}", subprotocols=[Subprotocol("viser-v0.0.1")]
    ) as old:
        with pytest.raises(ConnectionClosed):
            old.recv(timeout=patience(10.0))
        assert old.close_code == 1002
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("path", "below"),
    [
        ("/robot/", "/"),
        ("/robot", "/"),
        ("/robot?dark", "/?dark"),
        ("/robot/sambot/licenses.txt", "/sambot/licenses.txt"),
        ("/", "/"),
        ("/robots", "/robots"),
    ],
)
def test_a_proxy_may_take_the_base_path_away_or_not(path: str, below: str) -> None:
    assert without_base(path, "/robot") == below
    assert without_base(path, "/") == path


@pytest.mark.parametrize("path", ["/a b", "/../x?", "/%2e", "//a//b", "/a?b"])
def test_a_base_path_that_cannot_be_in_an_address_is_refused(path: str) -> None:
    with pytest.raises(UsageError, match="base path"):
        Options(base_path=path)

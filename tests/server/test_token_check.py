"""The secret in a link: who is let in with it, and what others get."""

from __future__ import annotations

import asyncio
import contextlib
import http.client
import socket
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import SimpleNamespace

import pytest
import viser
from lower_limit import lower
from patience import patience, until
from websockets.datastructures import Headers
from websockets.exceptions import InvalidStatus
from websockets.http11 import Request
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from sambot_viz.options import Options
from sambot_viz.server.listener import Listener, listen
from sambot_viz.server.protection import token_check
from sambot_viz.server.protection.token_check import TokenCheck

TOKEN = "s3cret-of.the_lab"
PRESENTER = "teach-the-class"
PROTOCOL = Subprotocol(f"viser-v{viser.__version__}")


@pytest.fixture
def listener() -> Iterator[Listener]:
    with listen(Options(token=TOKEN)) as listener:
        yield listener


@pytest.fixture
def port(listener: Listener) -> int:
    return listener.viser.get_port()


@dataclass(frozen=True)
class Answered:
    """What the server has answered to a request."""

    status: int
    headers: Mapping[str, str]
    text: str


def ask(port: int, path: str, headers: Mapping[str, str] | None = None) -> Answered:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=patience(10.0))
    with contextlib.closing(connection):
        connection.request("GET", path, headers=dict(headers or {}))
        answer = connection.getresponse()
        return Answered(answer.status, answer.headers, answer.read().decode())


def raw_status(port: int, line: bytes, header: bytes) -> int:
    """The status for a request with bytes that a well-behaved client does not send."""
    with socket.create_connection(
        ("127.0.0.1", port), timeout=patience(10.0)
    ) as connection:
        host = f"Host: 127.0.0.1:{port}".encode()
        connection.sendall(b"\r\n".join((line + b" HTTP/1.1", host, header, b"", b"")))
        return int(connection.makefile("rb").readline().split()[1])


def cookie_of(answer: Answered) -> str:
    return answer.headers["Set-Cookie"].partition(";")[0]


def test_the_printed_link_lets_in_and_leaves_the_address_bar(
    listener: Listener, port: int
) -> None:
    assert listener.url() == f"http://127.0.0.1:{port}/?token={TOKEN}"
    first = ask(port, f"/?fixedDpr=1&token={TOKEN}")
    assert (first.status, first.headers["Location"]) == (303, "./?fixedDpr=1")
    # This is no secret: it asks for a page without a view.
    windowed = ask(port, f"/?view=none&token={TOKEN}")
    assert (windowed.status, windowed.headers["Location"]) == (303, "./?view=none")
    cookie = first.headers["Set-Cookie"]
    assert "; HttpOnly" in cookie and "; SameSite=Lax" in cookie
    assert "Secure" not in cookie
    page = ask(port, "/?fixedDpr=1", {"Cookie": f"other=1; {cookie_of(first)}"})
    assert page.status == 200
    assert "</html>" in page.text


def test_where_there_is_a_presenter_the_links_say_whose_they_are() -> None:
    with listen(Options(token=TOKEN, presenter=PRESENTER)) as listener:
        port = listener.viser.get_port()
        page = f"http://127.0.0.1:{port}/"
        assert listener.url() == f"{page}?view={TOKEN}"
        assert listener.url(presenter=True) == f"{page}?present={PRESENTER}"
        for name in ("view", "present", "token"):
            for secret in (TOKEN, PRESENTER):
                first = ask(port, f"/?{name}={secret}&fixedDpr=1")
                assert (first.status, first.headers["Location"]) == (
                    303,
                    "./?fixedDpr=1",
                )
                assert cookie_of(first).endswith(f"={secret}")
            assert ask(port, f"/?{name}=wrong-word").status == 401
        assert ask(port, f"/?view={TOKEN}&present={PRESENTER}").status == 400


@pytest.mark.parametrize("name", ["present", "token", "view"])
def test_the_secret_decides_who_is_a_presenter_and_not_its_name(name: str) -> None:
    check = TokenCheck(TOKEN, PRESENTER)
    for secret, expected in ((PRESENTER, True), (TOKEN, False), ("wrong", False)):
        request = Request(f"/?{name}={secret}", Headers({"Host": "127.0.0.1"}))
        assert check.is_presenter(request) is expected


def test_the_cookie_goes_where_the_page_was_opened(port: int) -> None:
    # A browser takes the folder of the address, also below the path of a proxy.
    assert "Path" not in ask(port, f"/?token={TOKEN}").headers["Set-Cookie"]
    with listen(Options(token=TOKEN, base_path="/robot")) as listener:
        answer = ask(listener.viser.get_port(), f"/robot?token={TOKEN}")
    assert "; Path=/robot; " in answer.headers["Set-Cookie"]


def test_under_a_foreign_name_it_is_asked_for_too(port: int) -> None:
    host = {"Host": "hub.example.org"}
    assert ask(port, "/", host).status == 401
    assert ask(port, "/", {**host, "Authorization": f"Bearer {TOKEN}"}).status == 200
    foreign = {"Origin": "https://evil.example", "Authorization": f"Bearer {TOKEN}"}
    assert ask(port, "/", {**host, **foreign}).status == 403


def test_a_cookie_that_came_through_tls_stays_on_tls(port: int) -> None:
    answer = ask(port, f"/?token={TOKEN}", {"X-Forwarded-Proto": "https"})
    assert "; Secure" in answer.headers["Set-Cookie"]


@pytest.mark.parametrize("path", ["/", "/index.html", "/sambot/licenses.txt", "/no"])
def test_nothing_is_seen_without_the_link(port: int, path: str) -> None:
    answer = ask(port, path)
    assert answer.status == 401
    assert "with the token at its end" in answer.text
    assert TOKEN not in answer.text


@pytest.mark.parametrize("path", [f"//evil.example/?token={TOKEN}", "///x?token="])
def test_the_link_leads_to_no_other_host(port: int, path: str) -> None:
    where = ask(port, path.replace("token=", f"token={TOKEN}", 1)).headers.get(
        "Location"
    )
    assert where is None or where.startswith("./")


@pytest.mark.parametrize(
    ("query", "headers"),
    [
        ("", {}),
        ("", {"Cookie": "sambot-viz=1"}),
        ("?token=wrong", {}),
        ("", {"Authorization": "Bearer wrong"}),
    ],
)
def test_a_websocket_needs_it_too(
    port: int,
    query: str,
    headers: Mapping[str, str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(token_check, "WRONG_ANSWER", 0.0)
    with pytest.raises(InvalidStatus) as refused:
        connect(
            f"ws://127.0.0.1:{port}/{query}",
            subprotocols=[PROTOCOL],
            additional_headers=headers,
        )
    assert refused.value.response.status_code == 401


def test_a_program_may_send_it_in_three_ways(port: int) -> None:
    cookie = cookie_of(ask(port, f"/?token={TOKEN}"))
    ways: list[tuple[str, Mapping[str, str]]] = [
        (f"?token={TOKEN}", {}),
        ("", {"Authorization": f"Bearer {TOKEN}"}),
        ("", {"Cookie": cookie}),
    ]
    for query, headers in ways:
        url = f"ws://127.0.0.1:{port}/{query}"
        with connect(url, subprotocols=[PROTOCOL], additional_headers=headers):
            pass


def test_guesses_are_slowed_down_and_who_is_in_stays(
    port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "WRONG_TOKENS", 2)
    waiting: list[float] = []
    end = threading.Event()

    async def sleep(seconds: float) -> None:
        """Wait until the test has seen what it is about, however slow the machine."""
        waiting.append(seconds)
        await asyncio.to_thread(end.wait, 10.0)

    monkeypatch.setattr(token_check, "asyncio", SimpleNamespace(sleep=sleep))
    with connect(
        f"ws://127.0.0.1:{port}/?token={TOKEN}", subprotocols=[PROTOCOL]
    ) as in_:
        statuses: list[int] = []

        def guess(number: int) -> None:
            statuses.append(ask(port, f"/?token=guess{number}").status)

        guesses = [threading.Thread(target=guess, args=(n,)) for n in range(6)]
        for thread in guesses:
            thread.start()
        until(lambda: len(statuses) == 4)
        assert waiting == [token_check.WRONG_ANSWER] * 2 == [1.0, 1.0]
        assert statuses == [429] * 4
        end.set()
        for thread in guesses:
            thread.join()
        assert sorted(statuses) == [401, 401, 429, 429, 429, 429]
        in_.ping().wait(patience(5.0))
    assert ask(port, f"/?token={TOKEN}").status == 303


@pytest.mark.parametrize(
    "other",
    [
        'j={"a":1}',
        'k="',
        "q=a b c",
        "é=1",
        "=x",
        "d=1; expires=Thu, 01 Jan 1970 00:00:00 GMT",
        "$Version=1; \\",
    ],
)
def test_the_cookies_of_other_programs_lock_nobody_out(port: int, other: str) -> None:
    own = cookie_of(ask(port, f"/?token={TOKEN}"))
    for cookie in (f"{other}; {own}", f"{own}; {other}", f"{other};{own};{other}"):
        assert raw_status(port, b"GET /", f"Cookie: {cookie}".encode()) == 200


def test_a_request_is_one_guess(port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(token_check, "WRONG_ANSWER", 0.0)
    compared: list[bytes] = []
    compare = token_check.hmac.compare_digest

    def counted(one: bytes, two: bytes) -> bool:
        compared.append(one)
        return compare(one, two)

    monkeypatch.setattr(token_check.hmac, "compare_digest", counted)
    name = cookie_of(ask(port, f"/?token={TOKEN}")).partition("=")[0]
    compared.clear()
    guesses = [f"{name}=guess{number}" for number in range(100)]
    assert ask(port, "/?token=one&token=two").status == 400
    bearer = {"Authorization": "Bearer one"}
    assert ask(port, f"/?token={TOKEN}", bearer).status == 400
    assert ask(port, "/", {"Cookie": "; ".join(guesses)}).status == 401
    assert ask(port, "/?token=one", {"Cookie": "; ".join(guesses)}).status == 401
    assert len(compared) == 1 + 2


def test_a_path_of_any_letters_leads_to_the_page(port: int) -> None:
    line = b"GET /a/\xc3\xbf%20b?token=" + TOKEN.encode()
    assert raw_status(port, line, b"X: y") == 303


def test_what_is_in_the_headers_can_be_any_text(port: int) -> None:
    for line in (b"GET //[/?token=x", b"GET /?token=\xff", b"GET /\xff?a=\xff"):
        assert raw_status(port, line, b"Cookie: a=\xff") in (400, 401)
    for cookie in ("=", "a=b=c;;;", '"', "sambot-viz-0=" + "x" * 3000):
        assert ask(port, "/", {"Cookie": cookie}).status in (400, 401)

"""The login of a hub for its board, step by step; with a real hub: tests/jupyter."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from urllib.parse import parse_qs, urlsplit

import pytest
from a_hub_api import HubApi, a_hub_api
from lower_limit import lower
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from sambot_viz.classroom.hub import Hub
from sambot_viz.classroom.hub_login import CALLBACK, HubLogin

TEACHER = {"name": "tess", "scopes": ["access:services!service=board"]}


@pytest.fixture
def hub() -> Iterator[HubApi]:
    with a_hub_api() as running:
        running.codes["a-code"] = "token-of-tess"
        running.logged_in["token-of-tess"] = dict(TEACHER)
        yield running


@pytest.fixture
def login(hub: HubApi) -> HubLogin:
    where = Hub(hub.api, hub.token, "/services/board", "service-board", "/jupyter/")
    return HubLogin(where, "/services/board")


def ask(login: HubLogin, path: str, cookie: str = "") -> Response | None:
    request = Request(path, Headers({"Cookie": cookie} if cookie else {}))
    return asyncio.run(login.answer(request, path))


def begun(login: HubLogin) -> tuple[str, str]:
    """Open the board; the cookie of that browser, and the state at the hub."""
    sent = ask(login, "/board/")
    assert sent is not None and sent.status_code == 303
    where = urlsplit(sent.headers["Location"])
    assert where.path == "/jupyter/hub/api/oauth2/authorize"
    fields = parse_qs(where.query)
    assert fields["redirect_uri"] == [f"/services/board{CALLBACK}"]
    assert fields["client_id"] == ["service-board"]
    cookie = sent.headers["Set-Cookie"]
    assert "HttpOnly" in cookie and "SameSite=Lax" in cookie
    assert "Path=/services/board;" in cookie
    return cookie.partition(";")[0], fields["state"][0]


def come_back(login: HubLogin, code: str = "a-code") -> Response:
    cookie, state = begun(login)
    found = ask(login, f"{CALLBACK}?code={code}&state={state}", cookie)
    assert found is not None
    return found


def test_a_teacher_is_admitted_and_knows_the_board_from_then_on(
    login: HubLogin,
) -> None:
    found = come_back(login)
    assert (found.status_code, found.headers["Location"]) == (
        303,
        "/services/board/board/",
    )
    cookie = found.headers["Set-Cookie"].partition(";")[0]
    assert login.knows(f"other=1; {cookie}") and not login.knows("other=1")
    assert ask(login, "/board/", cookie) is None


def test_a_user_without_the_right_is_refused(hub: HubApi, login: HubLogin) -> None:
    for scopes in ([], ["access:servers", "access:services!service=other"]):
        hub.codes["a-code"] = "token-of-tess"
        hub.logged_in["token-of-tess"]["scopes"] = scopes
        found = come_back(login)
        assert found.status_code == 403 and b"for teachers" in found.body
        assert "Set-Cookie" not in found.headers


@pytest.mark.parametrize(
    "query", ["", "code=a-code", "state=x", "code=a-code&state=x", "code=&state="]
)
def test_a_login_that_another_page_has_begun_is_refused(
    hub: HubApi, login: HubLogin, query: str
) -> None:
    cookie, _ = begun(login)
    for kept in (cookie, ""):
        found = ask(login, f"{CALLBACK}?{query}", kept)
        assert found is not None and found.status_code == 403
    assert hub.codes, "the hub was not asked"


def test_a_code_counts_once_and_a_wrong_one_never(login: HubLogin) -> None:
    assert come_back(login, "wrong").status_code == 403
    assert come_back(login).status_code == 303
    assert come_back(login).status_code == 403


def test_only_the_pages_of_the_board_lead_to_the_login(login: HubLogin) -> None:
    for path in ("/board/rows", "/board/class.csv", "/board?present=x", "/x"):
        assert ask(login, path) is None


def test_logins_do_not_fill_the_memory(
    hub: HubApi, login: HubLogin, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "HUB_STUDENTS", 2)
    cookies: list[str] = []
    for number in range(3):
        hub.codes[f"code-{number}"] = "token-of-tess"
        found = come_back(login, f"code-{number}")
        cookies.append(found.headers["Set-Cookie"].partition(";")[0])
    assert [login.knows(cookie) for cookie in cookies] == [False, True, True]

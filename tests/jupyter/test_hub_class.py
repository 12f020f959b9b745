"""A class on a real JupyterHub: a lesson on each server, the board, and a restart."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

import pytest
from a_class import BoardRows, shown, write
from a_hub_class import SECRET, TEACHER, board_lines
from a_jupyter import PASSWORD, Hub, User, a_hub, a_place, free_ports, wait_until
from lesson_files import BASE
from patience import patience
from protocol_client import ProtocolClient
from recorded_page import RecordedPage

from sambot_viz.export.devtools import BrowserError

# The same of our own code, without a JupyterHub: tests/classroom/test_hub_board.py.
pytestmark = pytest.mark.slow

MODEL = "robot.urdf"
TEXT = '<robot name="ada"><link name="base_link"/></robot>'


@pytest.fixture(scope="module")
def hub() -> Iterator[Hub]:
    with a_place() as place:
        folder = place.folder / "class"
        folder.mkdir()
        for name in ("ada", "ben", TEACHER):
            (place.folder / name).mkdir()
        with a_hub(place, *board_lines(BASE, folder, *free_ports(1))) as running:
            yield running


@contextmanager
def opened(user: User) -> Iterator[ProtocolClient]:
    """Open the page of a user's lesson, as a browser does."""
    path = f"user/{user.name}/robot-viewer/"
    wait_until(lambda: user.ask(path)[0] == 200)
    headers = {**user.cookies(path), "Origin": user.url.rstrip("/")}
    port = urlsplit(user.url).port or 0
    client = ProtocolClient(port, path=f"/{path}", headers=headers)
    try:
        client.wait_until(lambda: "lesson/text" in client.rows, 60.0)
        yield client
    finally:
        client.close()


@contextmanager
def board_of(hub: Hub) -> Iterator[BoardRows]:
    """Open the teacher's board, below the address of the hub."""
    headers = {"Authorization": f"Bearer {SECRET}"}
    request = Request(f"{hub.url}services/board/board/rows", headers=headers)
    with urlopen(request, timeout=patience(60.0)) as lines:
        yield BoardRows(lines)


def test_the_board_follows_students_and_the_next_server_takes_up_their_work(
    hub: Hub,
) -> None:
    ada, _ = hub.log_in("ada"), hub.log_in("ben")
    file = hub.place.folder / "class" / "ada" / MODEL
    with board_of(hub) as board:

        def row(name: str) -> dict[str, object]:
            found = (one for one in board.rows.values() if one["name"] == name)
            return next(found, {})

        board.until(lambda: row("ada") and row("ben"))
        assert row("ben")["server"] == "no folder yet"
        with opened(ada) as page:
            write(page, TEXT)
            board.until(lambda: row("ada")["pages"] == 1 and row("ada")["unmet"])
            write(page, TEXT.replace("ada", "eve"))
            # At once: what was not saved yet is saved by the end of the server.
            hub.ask("hub/api/users/ada/server", method="DELETE")
            board.until(lambda: row("ada")["server"] == "no server")
        wait_until(lambda: 'name="eve"' in file.read_text())
        assert not row("ada")["pages"]
        assert board.trouble == ""
        hub.ask("hub/api/users/ada/server", {}, "POST")
        board.until(lambda: row("ada")["server"] == "")
        with opened(ada) as page:
            page.act("model/show", True)
            page.wait_until(lambda: (shown(page, "model/text") or {}).get("text"))
            assert 'name="eve"' in shown(page, "model/text")["text"]
            board.until(lambda: row("ada")["pages"] == 1)


def test_a_teacher_opens_the_board_with_the_login_of_the_hub(hub: Hub) -> None:
    path = "services/board/"
    # One who is not logged in is sent to the hub.
    assert "Sign in" in User(hub.url, TEACHER).ask(path)[1]
    teacher = hub.log_in(TEACHER)
    status, page = teacher.ask(path)
    assert status == 200 and "board/board.js" in page
    assert teacher.ask(f"{path}board/class.csv")[0] == 200
    # A student is logged in too, and has no right to open it.
    student = hub.log_in("ben")
    status, page = student.ask(path)
    assert status == 403
    assert student.ask(f"{path}board/class.csv")[0] == 401
    # Nobody is led into the login of another one.
    assert student.ask(f"{path}oauth_callback?code=x&state=y")[0] == 403


def test_an_open_page_comes_back_by_itself_on_the_next_server(
    hub: Hub, open_in_browser: Callable[[str], RecordedPage]
) -> None:
    hub.log_in("ben")
    page = open_in_browser(f"{hub.url}hub/login")
    page.wait_for("document.querySelector('[name=password]')", 30.0)
    page.evaluate(
        "document.querySelector('[name=username]').value = 'ben';"
        f"document.querySelector('[name=password]').value = '{PASSWORD}';"
        "document.querySelector('form').submit()"
    )
    page.wait_for("!location.pathname.endsWith('/login')", 30.0)
    page.goto(f"{hub.url}user/ben/robot-viewer/")
    is_open = "window.sambotViser?.state === 'open'"
    page.wait_for(is_open, 60.0)
    hub.ask("hub/api/users/ben/server", method="DELETE")
    page.wait_for(f"!({is_open})", 60.0)
    hub.ask("hub/api/users/ben/server", {}, "POST")

    def is_back() -> bool:
        # It may load itself again, when what answers first is a page of the hub.
        with suppress(BrowserError):
            return page.evaluate(is_open) is True
        return False

    wait_until(is_back)
    assert page.evaluate("location.pathname") == "/user/ben/robot-viewer/"

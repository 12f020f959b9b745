"""A class for tests, and the browsers of its students and its teacher.

with a_class(tmp_path) as room:
    ada = Browser(room)
    ada.join("Ada")                 # types the name, and keeps the cookie
    page = ada.page()               # a ProtocolClient; ada.type(page, "<robot/>")
    teacher = Browser(room, teaches=True)
    teacher.get("board/class.csv").text
    board = teacher.board()
    board.until(lambda: board.rows[1]["stuck"])
"""

from __future__ import annotations

import json
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Generator, Iterable, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar
from urllib.parse import quote, urlencode, urlsplit

from lesson_files import BASE
from patience import patience
from protocol_client import ProtocolClient

from sambot_viz.classroom.classroom import Classroom
from sambot_viz.lessons.read_lesson import open_lesson
from sambot_viz.options import Options

T = TypeVar("T")
ASKED = "Sambot-Class"
MODEL = "robot.urdf"


@dataclass(frozen=True)
class Got:
    """An answer."""

    status: int
    headers: Mapping[str, str]
    content: bytes

    @property
    def text(self) -> str:
        return self.content.decode()


@contextmanager
def a_class(
    folder: Path, lesson: str | Path = BASE, **options: Any
) -> Generator[Classroom]:
    """Serve a class whose seats are in one process."""
    given = Options(presenter="", **options)
    with Classroom(given, open_lesson(lesson), folder, processes=1) as room:
        yield room


class Browser:
    """What one person opens.

    Args:
        room: the class.
        teaches: whether it has the secret of the board.
        cookie: what it has kept from before.
    """

    def __init__(
        self, room: Classroom, *, teaches: bool = False, cookie: str = ""
    ) -> None:
        self._room, self.cookie = room, cookie
        self._open = ExitStack()
        self._secret = urlsplit(room.board_url).query.partition("=")[2]
        self._teaches = teaches

    @property
    def headers(self) -> dict[str, str]:
        found = {"Cookie": self.cookie} if self.cookie else {}
        if self._teaches:
            found["Authorization"] = f"Bearer {self._secret}"
        return found

    def get(self, path: str, **headers: str) -> Got:
        more = {name.replace("_", "-"): value for name, value in headers.items()}
        asked = urllib.request.Request(
            f"{self._room.url}/{path}", headers={**self.headers, **more}
        )
        try:
            with urllib.request.urlopen(asked, timeout=patience(60.0)) as answer:
                return Got(answer.status, answer.headers, answer.read())
        except urllib.error.HTTPError as error:
            return Got(error.code, error.headers, error.read())

    def join(self, name: str) -> Got:
        """Type a name."""
        got = self.get("join", **{ASKED: quote(name)})
        if "Set-Cookie" in got.headers:
            self.cookie = got.headers["Set-Cookie"].partition(";")[0]
        return got

    def do(self, what: str, **fields: object) -> Got:
        """Press a button of the board."""
        return self.get(f"board/{what}?{urlencode(fields)}", **{ASKED: "1"})

    def page(self, path: str = "/") -> ProtocolClient:
        """Open a page."""
        port = self._room.port
        client = ProtocolClient(port, path=path, headers=self.headers)
        self._open.callback(client.close)
        client.wait_until(lambda: "lesson/text" in client.rows)
        return client

    def close(self) -> None:
        """Close all pages."""
        self._open.close()

    def board(self) -> BoardRows:
        """Open the board; it is closed with the pages."""
        asked = urllib.request.Request(
            f"{self._room.url}/board/rows", headers=self.headers
        )
        answer = self._open.enter_context(
            urllib.request.urlopen(asked, timeout=patience(30.0))
        )
        return BoardRows(answer)


class BoardRows:
    """What the board shows, from what it is told.

    Attributes:
        head: the first event: the lesson, and the rows of that time.
        rows: the row of each student, by number, as it is now.
        trouble: why rows may be old.
    """

    def __init__(self, lines: Iterable[bytes]) -> None:
        self._lines = iter(lines)
        self.head: dict[str, Any] = {}
        self.rows: dict[int, dict[str, Any]] = {}
        self.trouble = ""
        while not self.head:
            self._read()

    def until(self, condition: Callable[[], T], timeout: float = 30.0) -> T:
        """Read what comes until a condition is true; it may be true already.

        Args:
            condition: what must become true.
            timeout: how long that may take [s].

        Raises:
            AssertionError: it was not after some time. A silent board hears something
                every 15 s, so a limit of the stream alone would never end this.
        """
        end = time.monotonic() + patience(timeout)
        while not (value := condition()):
            assert time.monotonic() < end, f"the board shows {self.rows}"
            self._read()
        return value

    def _read(self) -> None:
        line = next(self._lines)
        if not line.startswith(b"data: "):
            return
        event = json.loads(line.removeprefix(b"data: "))
        self.head = self.head or event
        self.trouble = event.get("trouble", self.trouble)
        rows = event.get("rows", [event["row"]] if "row" in event else [])
        self.rows |= {row["number"]: row for row in rows}


def write(client: ProtocolClient, text: str) -> None:
    """Type a whole text in a page."""
    client.act("model/show", True)
    client.wait_until(lambda: shown(client, "model/text") is not None)
    before = shown(client, "model/text")
    length = len(before["text"].encode("utf-16-le")) // 2
    client.act("model/type", before["file"], before["version"], 0, length, text, False)
    client.wait_until(lambda: shown(client, "model/text")["text"] == text)


def shown(client: ProtocolClient, name: str) -> Any:
    """What a panel of a page is told."""
    return client.rows.get(name, {}).get("value")

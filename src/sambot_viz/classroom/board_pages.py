"""The addresses of the teacher's board: the page, its rows, files, and orders."""

from __future__ import annotations

import http
import os
import tempfile
from asyncio import StreamWriter, to_thread
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import parse_qs

from websockets.http11 import Request, Response

from sambot_viz import limits, page
from sambot_viz.classroom.board import Board, event
from sambot_viz.classroom.requests import answer
from sambot_viz.content_policy import strict_policy
from sambot_viz.errors import SambotVizError
from sambot_viz.server.connections.page_files import plain_page
from sambot_viz.server.protection import access
from sambot_viz.text import text

ASKED = "Sambot-Class"
"""A header that our own pages send: no page of another origin can send it."""
_ALIVE = 15.0
"""Longest silence towards a board [s]: some proxies close silent connections."""


@dataclass(frozen=True, slots=True)
class Orders:
    """What a teacher may do with the pages of students.

    Attributes:
        say: shows a sentence to one student, or to all with 0.
        show: shows one student's page to the class, or none with 0.
    """

    say: Callable[[int, str], None]
    show: Callable[[int], None]


class BoardPages:
    """Answers the requests of a teacher.

    Args:
        board: the board.
        orders: carries out the teacher's orders; None where no page can be reached.
    """

    def __init__(self, board: Board, orders: Orders | None) -> None:
        self._board, self._orders = board, orders

    async def answer(
        self, request: Request, where: str, query: str, writer: StreamWriter
    ) -> Response | None:
        """Return the answer to a teacher's request; None after a stream of rows."""
        if where == "/board":
            return access.plain(http.HTTPStatus.SEE_OTHER, "See there.", "./board/")
        if where == "/board/":
            return html(page.board(self._board.title))
        if where == "/board/rows":
            await self._follow(writer)
            return None
        if where == "/board/class.csv":
            return _download(self._board.csv(), "text/csv", "class.csv")
        if where == "/board/class.zip":
            return await self._collected()
        if where not in ("/board/say", "/board/show") or ASKED not in request.headers:
            return no_page()
        if self._orders is None:
            return no_page()
        fields = {name: values[-1] for name, values in parse_qs(query).items()}
        return self._do(self._orders, where, fields)

    def _do(self, orders: Orders, where: str, fields: Mapping[str, str]) -> Response:
        number = fields.get("number", "0")
        wanted = int(number) if number.isdecimal() and len(number) < 6 else -1
        if wanted and not self._board.has(wanted):
            return refused("this student is not in the class")
        if where == "/board/show":
            orders.show(wanted)
            return answer(b"")
        said = text(fields.get("text", ""), limits.CLASS_MESSAGE.value + 1).strip()
        if not 0 < len(said) <= limits.CLASS_MESSAGE.value:
            most = limits.CLASS_MESSAGE.value
            return refused(f"a message has from 1 to {most} characters")
        orders.say(wanted, said)
        return answer(b"")

    async def _follow(self, writer: StreamWriter) -> None:
        """Send all rows, then each changed row."""
        head = answer(b"", "text/event-stream", more={"X-Accel-Buffering": "no"})
        del head.headers["Content-Length"]
        head.headers["Connection"] = "close"
        follower = self._board.follow()
        try:
            begin = {**self._board.begin(), "reaches": self._orders is not None}
            writer.write(head.serialize() + event(begin))
            while True:
                await writer.drain()
                numbers = await follower.changed(_ALIVE)
                changes = (event(self._board.change(number)) for number in numbers)
                writer.write(b"".join(changes) or b":\n\n")
        finally:
            follower.close()

    async def _collected(self) -> Response:
        handle, name = tempfile.mkstemp(suffix=".zip")
        os.close(handle)
        try:
            await to_thread(self._board.collect, Path(name))
            content = await to_thread(Path(name).read_bytes)
        except (OSError, SambotVizError) as error:
            return refused(f"the files cannot be collected: {error}")
        finally:
            with suppress(OSError):
                os.unlink(name)
        return _download(content, "application/zip", "class.zip")


def html(content: bytes) -> Response:
    """Return an answer that is a page of a class."""
    more = {"Content-Security-Policy": strict_policy("class")}
    return answer(content, "text/html", more=more)


def refused(sentence: str) -> Response:
    """Return an answer that says why something was not done."""
    return answer(text(sentence).encode(), status=http.HTTPStatus.BAD_REQUEST)


def no_page() -> Response:
    """Return the answer to a request for what a visitor may not see."""
    return plain_page(
        http.HTTPStatus.NOT_FOUND,
        "There is nothing here for you",
        "Students open the address of the class; the teacher opens that of the board, "
        "as sambot-viz has printed it.",
    )


def _download(content: bytes, kind: str, name: str) -> Response:
    shown = f'attachment; filename="{name}"'
    return answer(content, kind, more={"Content-Disposition": shown})

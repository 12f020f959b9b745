"""The single port of a class, and who may open which page.

A cookie identifies a student, who may open the student's own seat and the one that is
shown to the class. The secret in the board's address identifies the teacher, who may
open the board and view every seat.
"""

from __future__ import annotations

import asyncio
import http
import os
import tempfile
from asyncio import StreamReader, StreamWriter
from collections import Counter
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from pathlib import Path
from urllib.parse import parse_qs, unquote

from websockets.http11 import Request, Response

from sambot_viz import limits, page
from sambot_viz.classroom.board import Board, event
from sambot_viz.classroom.requests import (
    BadRequestError,
    answer,
    on_behalf,
    pipe,
    read_request,
)
from sambot_viz.classroom.roll import TEACHER, Roll, Student
from sambot_viz.classroom.seat_process import SeatAddress
from sambot_viz.content_policy import strict_policy
from sambot_viz.errors import SambotVizError, UsageError
from sambot_viz.options import Options
from sambot_viz.server.connections.page_files import plain_page
from sambot_viz.server.handshake import without_base
from sambot_viz.server.protection import access
from sambot_viz.server.protection.token_check import TokenCheck, remembered
from sambot_viz.server.readiness import ServerState, readiness, stopping
from sambot_viz.text import text

ASKED = "Sambot-Class"
"""A header that our own pages send: no page of another origin can send it."""
LOOK = "/student/"
"""The seats of others are below this path."""
_ALIVE = 15.0
"""Longest silence towards a board [s]: some proxies close silent connections."""
_CLOSED = 2.0
_Streams = tuple[StreamReader, StreamWriter]


class Front:
    """Answers requests, or passes them on to a seat.

    Args:
        options: address to listen on, and the secrets.
        roll: the students of the class.
        board: the teacher's board.
        seat_of: opens a student's seat, unless it is open.
        say: shows a sentence to one student, or to all with 0.
        show: shows one student's seat to the class, or none with 0.

    Attributes:
        state: whether the server shows the lesson, or is stopping.
    """

    state: ServerState = "ready"

    def __init__(
        self,
        options: Options,
        roll: Roll,
        board: Board,
        seat_of: Callable[[Student], Awaitable[SeatAddress]],
        say: Callable[[int, str], None],
        show: Callable[[int], None],
    ) -> None:
        self._options, self._roll, self._board = options, roll, board
        self._seat_of, self._say, self._show = seat_of, say, show
        secrets = (options.token, options.presenter, options.base_path)
        self._check = TokenCheck(*secrets)
        self._open: set[asyncio.Task[None]] = set()
        self._connections: Counter[int] = Counter()
        self._looking: dict[asyncio.Task[None], int] = {}

    async def serve(self, reader: StreamReader, writer: StreamWriter) -> None:
        """Serve one connection, until it ends."""
        task = asyncio.current_task()
        assert task is not None
        self._open.add(task)
        try:
            if len(self._open) <= limits.CONNECTIONS.value:
                await self._serve(reader, writer)
        except (BadRequestError, OSError, UnicodeError, asyncio.CancelledError):
            # The visitor has left, sends requests that none of our pages makes, or may
            # no longer look.
            pass
        finally:
            self._open.discard(task)
            self._looking.pop(task, None)
            writer.close()

    async def close(self) -> None:
        """End all connections."""
        for task in self._open:
            task.cancel()
        if self._open:
            await asyncio.wait(self._open, timeout=_CLOSED)

    def end_looks(self) -> None:
        """End the students' views of a seat that was shown to the class."""
        for task in self._looking:
            task.cancel()

    async def _serve(self, reader: StreamReader, writer: StreamWriter) -> None:
        request = await read_request(reader)
        path = without_base(request.path, self._options.base_path)
        found = readiness(request, path, self.state)
        found = found or access.refusal(request, self._options)
        found = found or self._check.refusal(request)
        if found is not None and not isinstance(found, Response):
            found = await found
        if found is None and self.state == "stopping":
            found = stopping()
        if found is None:
            where, _, query = path.partition("?")
            if where == "/join":
                found = self._join(request)
            elif where.startswith("/board"):
                found = await self._of_board(request, where, query, writer)
            else:
                found = await self._go_on(request, path, (reader, writer))
        if found is not None:
            found.headers["Connection"] = "close"
            writer.write(found.serialize())
            await asyncio.wait_for(writer.drain(), _ALIVE)

    # Students

    def _student(self, request: Request) -> Student | None:
        """Return the student of a request's cookie; browsers send the newest first."""
        parts = ";".join(request.headers.get_all("Cookie")).split(";")
        pairs = (part.strip().partition("=") for part in parts)
        keys = [value for name, _, value in pairs if name == self._roll.cookie]
        return self._roll.of_key(keys[0]) if len(keys) == 1 else None

    def _join(self, request: Request) -> Response:
        given = request.headers.get_all(ASKED)
        if len(given) != 1:
            return _refused("Open the address of the class, and type your name there.")
        student, more = self._student(request), dict[str, str]()
        if student is None:
            try:
                name = unquote(given[0], errors="strict")
                student, key = self._roll.add(name)
            except UnicodeDecodeError:
                return _refused("type your name")
            except UsageError as error:
                return _refused(str(error))
            self._board.look_up(student)
            base = self._options.base_path
            cookie = remembered(self._roll.cookie, key, base, request.headers)
            more["Set-Cookie"] = cookie
        return answer(student.name.encode(), more=more)

    async def _go_on(
        self, request: Request, path: str, streams: _Streams
    ) -> Response | None:
        """Pass a request on to a seat, or say why it may not go there."""
        own, teaches = self._student(request), self._check.is_presenter(request)
        if path.startswith(LOOK):
            number, slash, rest = path.removeprefix(LOOK).partition("/")
            wanted = int(number) if number.isdecimal() and len(number) < 6 else 0
            if wanted not in self._roll.students or not slash:
                return _no_page()
            if not teaches and (own is None or wanted != self._board.shown):
                return _no_page()
            name = TEACHER if teaches else own.name if own is not None else ""
            looks = (wanted, f"/{rest}", name, False)
        elif own is not None:
            looks = (own.number, path, own.name, True)
        elif path.partition("?")[0] in ("/", "/index.html"):
            return _html(page.name_form(self._board.title))
        else:
            return _no_page()
        return await self._pipe(request, streams, *looks, counted=0 if teaches else own)

    async def _pipe(
        self,
        request: Request,
        streams: _Streams,
        number: int,
        path: str,
        name: str,
        is_own: bool,
        counted: Student | int | None,
    ) -> Response | None:
        who = counted.number if isinstance(counted, Student) else 0
        if who and self._connections[who] >= limits.CLASS_CONNECTIONS.value:
            return plain_page(
                http.HTTPStatus.SERVICE_UNAVAILABLE,
                "Too many pages are open",
                "Close some of your pages, then load this one again.",
            )
        self._connections[who] += 1
        try:
            seat = await self._seat_of(self._roll.students[number])
            secret = seat.student if is_own else seat.viewer
            head = on_behalf(request, path, secret, name)
            task = asyncio.current_task()
            if not is_own and who and task is not None:
                self._looking[task] = number
            await pipe(*streams, seat.port, head)
        except SambotVizError as error:
            return plain_page(
                http.HTTPStatus.SERVICE_UNAVAILABLE,
                "Your page does not begin",
                f"{text(error)}. Tell the teacher; this page loads again by itself.",
                {"Retry-After": "10", "Refresh": "10"},
            )
        finally:
            self._connections[who] -= 1
        return None

    # The teacher

    async def _of_board(
        self, request: Request, where: str, query: str, writer: StreamWriter
    ) -> Response | None:
        if not self._check.is_presenter(request):
            return _no_page()
        if where == "/board":
            return access.plain(http.HTTPStatus.SEE_OTHER, "See there.", "./board/")
        if where == "/board/":
            return _html(page.board(self._board.title))
        if where == "/board/rows":
            await self._follow(writer)
            return None
        if where == "/board/class.csv":
            return _download(self._board.csv(), "text/csv", "class.csv")
        if where == "/board/class.zip":
            return await self._collected()
        if where not in ("/board/say", "/board/show") or ASKED not in request.headers:
            return _no_page()
        fields = {name: values[-1] for name, values in parse_qs(query).items()}
        return self._do(where, fields)

    def _do(self, where: str, fields: Mapping[str, str]) -> Response:
        number = fields.get("number", "0")
        wanted = int(number) if number.isdecimal() and len(number) < 6 else -1
        if wanted and wanted not in self._roll.students:
            return _refused("this student is not in the class")
        if where == "/board/show":
            self._show(wanted)
            return answer(b"")
        said = text(fields.get("text", ""), limits.CLASS_MESSAGE.value + 1).strip()
        if not 0 < len(said) <= limits.CLASS_MESSAGE.value:
            most = limits.CLASS_MESSAGE.value
            return _refused(f"a message has from 1 to {most} characters")
        self._say(wanted, said)
        return answer(b"")

    async def _follow(self, writer: StreamWriter) -> None:
        """Send all rows, then each changed row."""
        head = answer(b"", "text/event-stream", more={"X-Accel-Buffering": "no"})
        del head.headers["Content-Length"]
        head.headers["Connection"] = "close"
        follower = self._board.follow()
        try:
            writer.write(head.serialize() + event(self._board.begin()))
            while True:
                await writer.drain()
                numbers = await follower.changed(_ALIVE)
                rows = (event({"row": self._board.row(number)}) for number in numbers)
                writer.write(b"".join(rows) or b":\n\n")
        finally:
            follower.close()

    async def _collected(self) -> Response:
        handle, name = tempfile.mkstemp(suffix=".zip")
        os.close(handle)
        try:
            await asyncio.to_thread(self._board.collect, Path(name))
            content = await asyncio.to_thread(Path(name).read_bytes)
        except (OSError, SambotVizError) as error:
            return _refused(f"the files cannot be collected: {error}")
        finally:
            with suppress(OSError):
                os.unlink(name)
        return _download(content, "application/zip", "class.zip")


def _html(content: bytes) -> Response:
    more = {"Content-Security-Policy": strict_policy("class")}
    return answer(content, "text/html", more=more)


def _download(content: bytes, kind: str, name: str) -> Response:
    shown = f'attachment; filename="{name}"'
    return answer(content, kind, more={"Content-Disposition": shown})


def _refused(sentence: str) -> Response:
    return answer(text(sentence).encode(), status=http.HTTPStatus.BAD_REQUEST)


def _no_page() -> Response:
    return plain_page(
        http.HTTPStatus.NOT_FOUND,
        "There is nothing here for you",
        "Students open the address of the class; the teacher opens that of the board, "
        "as sambot-viz has printed it.",
    )

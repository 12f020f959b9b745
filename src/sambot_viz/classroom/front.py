"""The single port of a class, and who may open which page.

A cookie identifies a student, who may open the student's own seat and the one that is
shown to the class. The secret in the board's address identifies the teacher, who may
open the board and view every seat.
"""

from __future__ import annotations

import asyncio
import http
from asyncio import StreamReader, StreamWriter
from collections import Counter
from collections.abc import Awaitable, Callable
from urllib.parse import unquote

from websockets.http11 import Request, Response

from sambot_viz import limits, page
from sambot_viz.classroom.board import Board
from sambot_viz.classroom.board_pages import (
    ASKED,
    BoardPages,
    Orders,
    html,
    no_page,
    refused,
)
from sambot_viz.classroom.requests import (
    BadRequestError,
    answer,
    on_behalf,
    pipe,
    read_request,
)
from sambot_viz.classroom.roll import TEACHER, Roll, Student
from sambot_viz.classroom.seat_process import SeatAddress
from sambot_viz.errors import SambotVizError, UsageError
from sambot_viz.options import Options
from sambot_viz.server.connections.page_files import plain_page
from sambot_viz.server.handshake import without_base
from sambot_viz.server.protection import access
from sambot_viz.server.protection.token_check import TokenCheck, remembered
from sambot_viz.server.readiness import ServerState, readiness, stopping
from sambot_viz.text import text

LOOK = "/student/"
"""The seats of others are below this path."""
_DRAIN = 15.0
"""Longest time that a visitor may take for an answer [s]."""
_CLOSED = 2.0
_Streams = tuple[StreamReader, StreamWriter]


class Front:
    """Answers requests, or passes them on to a seat.

    Args:
        options: address to listen on, and the secrets.
        roll: the students of the class.
        board: the teacher's board.
        seat_of: opens a student's seat, unless it is open.
        orders: carries out the teacher's orders.

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
        orders: Orders,
    ) -> None:
        self._options, self._roll, self._board = options, roll, board
        self._seat_of, self._pages = seat_of, BoardPages(board, orders)
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
                found = no_page()
                if self._check.is_presenter(request):
                    found = await self._pages.answer(request, where, query, writer)
            else:
                found = await self._go_on(request, path, (reader, writer))
        if found is not None:
            found.headers["Connection"] = "close"
            writer.write(found.serialize())
            await asyncio.wait_for(writer.drain(), _DRAIN)

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
            return refused("Open the address of the class, and type your name there.")
        student, more = self._student(request), dict[str, str]()
        if student is None:
            try:
                name = unquote(given[0], errors="strict")
                student, key = self._roll.add(name)
            except UnicodeDecodeError:
                return refused("type your name")
            except UsageError as error:
                return refused(str(error))
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
                return no_page()
            if not teaches and (own is None or wanted != self._board.shown):
                return no_page()
            name = TEACHER if teaches else own.name if own is not None else ""
            looks = (wanted, f"/{rest}", name, False)
        elif own is not None:
            looks = (own.number, path, own.name, True)
        elif path.partition("?")[0] in ("/", "/index.html"):
            return html(page.name_form(self._board.title))
        else:
            return no_page()
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

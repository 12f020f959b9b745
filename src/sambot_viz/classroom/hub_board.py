"""The teacher's board of a class on a JupyterHub: a service of the hub."""

from __future__ import annotations

import asyncio
import http
import time
from asyncio import StreamWriter
from pathlib import Path

from websockets.http11 import Request, Response

from sambot_viz.classroom.board import Board
from sambot_viz.classroom.board_pages import BoardPages, no_page
from sambot_viz.classroom.hub import Hub
from sambot_viz.classroom.hub_login import HubLogin
from sambot_viz.classroom.hub_roll import HubRoll
from sambot_viz.classroom.one_port import OnePort
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.options import Options
from sambot_viz.server.listener import page_url
from sambot_viz.server.protection import access
from sambot_viz.server.protection.token_check import TokenCheck

LOOKS = 2.0
"""Shortest time between two looks into the students' folders [s]."""


class HubBoard:
    """Serves the board, as a context.

    The students' folders and the hub are looked at only while a page shows the board.

    Args:
        options: address to listen on, and the secrets.
        lesson: the lesson.
        folder: folder that has the students' folders.
        track: track of the lesson; None for the one that the files follow.
        hub: the hub.

    Raises:
        ServerError: the address cannot be listened on.
    """

    def __init__(
        self,
        options: Options,
        lesson: Lesson,
        folder: Path,
        track: str | None,
        hub: Hub,
    ) -> None:
        self.options, self._lesson = options, lesson
        self._roll = HubRoll(folder, hub)
        self._board = Board(lesson, self._roll, track)
        self._pages = BoardPages(self._board, None)
        self._looked, self._looking = float("-inf"), asyncio.Lock()
        self._login = HubLogin(hub, options.base_path)
        knows = self._login.knows if hub.client else None
        self._check = TokenCheck("", options.presenter, options.base_path, knows)
        self._server = OnePort(
            options,
            "sambot-viz-board",
            self._check,
            self._answer,
            self._follow,
            self._enter if hub.client else None,
        )
        self.port = self._server.port

    @property
    def board_url(self) -> str:
        """The secret address of the teacher."""
        return page_url(self.options, "", self.port, "/board", presenter=True)

    def __enter__(self) -> HubBoard:
        """Start listening."""
        self._server.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop, and free the port."""
        self._server.stop()

    # On the loop

    async def _enter(self, request: Request, path: str) -> Response | None:
        if self._check.is_presenter(request):
            return None
        return await self._login.answer(request, path)

    async def _answer(
        self, request: Request, path: str, writer: StreamWriter
    ) -> Response | None:
        where, _, query = path.partition("?")
        if not self._check.is_presenter(request):
            return no_page()
        if where in ("", "/"):
            return access.plain(http.HTTPStatus.SEE_OTHER, "See there.", "./board/")
        await self._look()
        return await self._pages.answer(request, where, query, writer)

    async def _follow(self) -> None:
        """Look again and again while a page shows the board."""
        while True:
            if self._board.is_followed:
                await self._look()
            await asyncio.sleep(LOOKS)

    async def _look(self) -> None:
        """Take the states of all students, unless they were taken just now."""
        async with self._looking:
            if time.monotonic() - self._looked < LOOKS / 2:
                return
            states = await asyncio.to_thread(self._roll.look, self._lesson)
            self._board.say_trouble(self._roll.trouble)
            for number, state in states.items():
                self._board.take(number, state)
            self._looked = time.monotonic()

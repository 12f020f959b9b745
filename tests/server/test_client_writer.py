"""Who is disconnected for not reading, and who is only slow."""

from __future__ import annotations

import asyncio
import socket
from types import SimpleNamespace
from typing import Any, cast

import pytest
from patience import patience

from sambot_viz.server.connections import client_writer
from sambot_viz.server.connections.client_writer import PIECE, ClientWriter


class Line:
    """A connection that takes so many bytes whenever it is looked at."""

    def __init__(self, at_a_look: int) -> None:
        self.transport = self
        self.at_a_look = at_a_look
        self.waiting = 0
        self.looks = 0
        self.aborted = False
        self.pieces: list[int] = []

    def get_write_buffer_size(self) -> int:
        self.looks += 1
        self.waiting = max(0, self.waiting - self.at_a_look)
        return self.waiting

    def get_extra_info(self, _: str) -> SimpleNamespace:
        return SimpleNamespace(family=socket.AF_UNIX)

    def abort(self) -> None:
        self.aborted = True

    async def send(self, message: Any) -> None:
        """Take all of it, as far as the line takes it."""
        async for piece in message:
            self.pieces.append(len(piece))
            self.waiting += len(piece)
            while self.waiting > PIECE and not self.aborted:
                await asyncio.sleep(0)
            if self.aborted:
                return


def send(line: Line, size: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(client_writer, "STALL_PERIOD", 0.001)

    async def run() -> None:
        line.send = cast(Any, line.send)
        await ClientWriter(cast(Any, line)).send(bytes(size))

    asyncio.run(asyncio.wait_for(run(), patience(10.0)))


def test_a_line_that_takes_a_little_all_the_time_gets_everything(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    line = Line(at_a_look=PIECE // 2)
    send(line, 10 * PIECE + 1, monkeypatch)
    assert not line.aborted
    assert line.pieces == [PIECE] * 10 + [1]
    assert line.looks > 10


def test_a_line_that_takes_nothing_is_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    line = Line(at_a_look=0)
    send(line, 10 * PIECE, monkeypatch)
    assert line.aborted
    assert line.looks <= 3

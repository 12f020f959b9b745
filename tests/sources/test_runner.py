"""A conversation that is ended says first what it was to say."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace
from typing import Any

import pytest

from sambot_viz.sources.websocket import runner
from sambot_viz.sources.websocket.runner import ConversationRunner


class Connection:
    """Takes frames one after the other, and brings none."""

    def __init__(self, takes: bool = True) -> None:
        self.sent: list[str] = []
        self._takes = takes

    async def recv(self) -> bytes:
        return await asyncio.Future()

    async def send(self, frame: str) -> None:
        await asyncio.sleep(0)
        if not self._takes:
            await asyncio.Future()
        self.sent.append(frame)


def sent_until_the_end(connection: Any) -> None:
    """Have three frames sent, and end it at once."""

    async def run() -> None:
        outbound: asyncio.Queue[str | bytes] = asyncio.Queue()
        talk: Any = SimpleNamespace(is_ready=True, tick=lambda now: None)
        nothing = lambda: None  # noqa: E731
        made = ConversationRunner(connection, talk, outbound, nothing, nothing)
        running = asyncio.ensure_future(made.run())
        await asyncio.sleep(0)
        for word in ("one", "two", "three"):
            outbound.put_nowait(word)
        running.cancel()
        with pytest.raises(asyncio.CancelledError):
            await running

    asyncio.run(run())


def test_what_waits_is_sent_before_the_end() -> None:
    connection = Connection()
    sent_until_the_end(connection)
    assert connection.sent == ["one", "two", "three"]


def test_a_peer_that_takes_nothing_does_not_hold_up_the_end(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(runner, "LAST_WORDS", 0.0)
    connection = Connection(takes=False)
    sent_until_the_end(connection)
    assert connection.sent == []

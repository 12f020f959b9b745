"""Run one conversation over one websocket, until one of the two sides ends it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from websockets.asyncio.client import ClientConnection

from sambot_viz.sources.live.conversation import Conversation
from sambot_viz.sources.live.live_source import TICK
from sambot_viz.sources.websocket.trouble import WrongServer

LONGEST_SILENCE = 10.0
"""The server has so long to say who it is [s]."""
LAST_WORDS = 1.0
"""What waits to be sent at the end has so long [s]."""


class ConversationRunner:
    """Reads, writes and ticks; all in one event loop.

    Args:
        websocket: the connection.
        conversation: takes the frames.
        outbound: frames to send.
        follow: called when the conversation may have changed.
        tell_health: called at each tick, once the conversation is ready.
    """

    def __init__(
        self,
        websocket: ClientConnection,
        conversation: Conversation,
        outbound: asyncio.Queue[str | bytes],
        follow: Callable[[], object],
        tell_health: Callable[[], object],
    ) -> None:
        self._websocket = websocket
        self._conversation = conversation
        self._outbound = outbound
        self._follow = follow
        self._tell_health = tell_health

    async def run(self) -> None:
        """Speak until one side ends; raises what has ended it."""
        jobs = (self._read(), self._write(), self._tick())
        tasks = [asyncio.ensure_future(job) for job in jobs]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        except asyncio.CancelledError:
            await self._send_rest(tasks[1])
            raise
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        for task in done:
            task.result()

    async def _read(self) -> None:
        while True:
            self._conversation.receive(await self._websocket.recv())
            self._follow()

    async def _write(self) -> None:
        while True:
            await self._websocket.send(await self._outbound.get())
            self._outbound.task_done()

    async def _send_rest(self, writing: asyncio.Future[None]) -> None:
        """Send what waits, such as that a robot is to stop, unless that takes long."""
        sent = asyncio.ensure_future(self._outbound.join())
        try:
            first = asyncio.FIRST_COMPLETED
            await asyncio.wait((sent, writing), timeout=LAST_WORDS, return_when=first)
        finally:
            sent.cancel()

    async def _tick(self) -> None:
        loop = asyncio.get_running_loop()
        begun = loop.time()
        while True:
            await asyncio.sleep(TICK)
            self._conversation.tick(loop.time())
            self._follow()
            if self._conversation.is_ready:
                self._tell_health()
            elif loop.time() - begun > LONGEST_SILENCE:
                raise WrongServer(self._conversation.silence())

"""A second connection to a peer, for one exchange that would hold up the first."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from websockets.asyncio.client import ClientConnection, connect

from sambot_viz import limits
from sambot_viz.sources.live.address import Address
from sambot_viz.sources.websocket.trouble import explain


class SideConnection:
    """Connects once, and ends with what it was made for.

    All is done in the thread of the loop in which it begins.

    Args:
        address: of the peer.
        take: takes a frame; returns whether more are wanted.
        ended: called with why it has ended before that.
    """

    def __init__(
        self,
        address: Address,
        take: Callable[[str | bytes], bool],
        ended: Callable[[str], object],
    ) -> None:
        self._address, self._take, self._ended = address, take, ended
        self._outbound: asyncio.Queue[str] = asyncio.Queue()
        self._task: asyncio.Task[None] | None = None

    def begin(self) -> None:
        """Begin to connect; returns at once."""
        self._task = asyncio.get_running_loop().create_task(self._run())

    def send(self, frame: str) -> None:
        """Send a frame, as soon as there is a connection."""
        self._outbound.put_nowait(frame)

    def close(self) -> None:
        """End it."""
        if self._task is not None:
            self._task.cancel()

    async def _run(self) -> None:
        try:
            async with connect(
                self._address.websocket,
                compression=None,
                max_size=limits.MESSAGE.value,
                open_timeout=10,
                close_timeout=1,
                ping_interval=5,
                ping_timeout=15,
            ) as websocket:
                await self._converse(websocket)
        except Exception as error:
            self._ended(explain(error, self._address))

    async def _converse(self, websocket: ClientConnection) -> None:
        writer = asyncio.ensure_future(self._write(websocket))
        try:
            while self._take(await websocket.recv()):
                pass
        finally:
            writer.cancel()

    async def _write(self, websocket: ClientConnection) -> None:
        while True:
            await websocket.send(await self._outbound.get())

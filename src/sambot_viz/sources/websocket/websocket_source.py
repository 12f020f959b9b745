"""A source over a websocket."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence

from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Subprotocol

from sambot_viz import limits
from sambot_viz.sources.live.address import Address
from sambot_viz.sources.live.conversation import Conversation, Ends
from sambot_viz.sources.live.live_source import LiveSource
from sambot_viz.sources.websocket.paced_connection import PacedConnection
from sambot_viz.sources.websocket.runner import ConversationRunner
from sambot_viz.sources.websocket.trouble import explain


class WebsocketSource(LiveSource):
    """A live source of a protocol, whose conversation it is given.

    Args:
        uri: the address, as the user wrote it.
        address: the parsed address.
        conversation: makes the conversation of a new connection.
        subprotocols: the offered ones, the best first.
    """

    def __init__(
        self,
        uri: str,
        address: Address,
        conversation: Callable[[Ends], Conversation],
        subprotocols: Sequence[str] = (),
    ) -> None:
        super().__init__(uri, address)
        self._begin = conversation
        self._subprotocols = [Subprotocol(name) for name in subprotocols] or None

    async def _connect(self) -> None:
        async with connect(
            self._address.websocket,
            subprotocols=self._subprotocols,
            compression=None,
            max_size=limits.MESSAGE.value,
            # What comes is read at once: stopping the socket for every few messages
            # of a burst costs more than they do.
            max_queue=limits.WAITING.value,
            open_timeout=10,
            close_timeout=1,
            ping_interval=5,
            ping_timeout=15,
            create_connection=PacedConnection,
        ) as websocket:
            await self._speak(websocket)

    def _explain(self, error: BaseException) -> str:
        return explain(error, self._address)

    async def _speak(self, websocket: ClientConnection) -> None:
        """Speak until one side ends; raises what has ended it."""
        outbound: asyncio.Queue[str | bytes] = asyncio.Queue()
        conversation = self._converse(self._begin, outbound.put_nowait)
        assert isinstance(websocket, PacedConnection)
        websocket.on_large = conversation.leave_out
        runner = ConversationRunner(
            websocket, conversation, outbound, self._follow, self._tell_health
        )
        await runner.run()

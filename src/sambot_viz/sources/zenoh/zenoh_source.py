"""A source over zenoh: ROS 2 with rmw_zenoh_cpp, through its router."""

from __future__ import annotations

import asyncio
from functools import partial

from sambot_viz.errors import SourceError
from sambot_viz.sources.live.event_loop import SourceLoop
from sambot_viz.sources.live.live_source import LiveSource
from sambot_viz.sources.websocket.trouble import explain
from sambot_viz.sources.zenoh.conversation import ZenohConversation
from sambot_viz.sources.zenoh.session import LONGEST_OPENING, open_session


class ZenohSource(LiveSource):
    """A live source of a router of zenoh."""

    async def _connect(self) -> None:
        loop = asyncio.get_running_loop()
        assert isinstance(loop, SourceLoop)
        address = self._address
        # What zenoh says of a place that it cannot reach is the same for all reasons.
        _, writer = await asyncio.wait_for(
            asyncio.open_connection(address.host, address.port), LONGEST_OPENING
        )
        writer.close()
        lost = asyncio.Event()
        session = await loop.aside(partial(open_session, address, self._post, lost.set))
        try:
            if session.router:
                await self._hold(partial(ZenohConversation, session), lost)
        finally:
            session.close()

    def _explain(self, error: BaseException) -> str:
        if isinstance(error, SourceError):
            return str(error)
        return explain(error, self._address)

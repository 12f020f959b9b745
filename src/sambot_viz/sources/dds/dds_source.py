"""A source over DDS: ROS 2 with Fast DDS or Cyclone DDS, no bridge and no server."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from functools import partial

from sambot_viz.errors import SourceError
from sambot_viz.sources.dds.conversation import DdsConversation
from sambot_viz.sources.dds.endpoints import DdsPeer
from sambot_viz.sources.dds.participant import DdsParticipant
from sambot_viz.sources.dds.trouble import nothing
from sambot_viz.sources.live.event_loop import SourceLoop
from sambot_viz.sources.live.live_source import LiveSource

LONGEST_SEARCH = 5.0
"""Others that are there have answered by then [s]."""


class DdsSource(LiveSource):
    """A live source of a domain of DDS.

    DDS has no connection to lose: the source counts as connected while another
    participant exists.
    """

    async def _connect(self) -> None:
        loop = asyncio.get_running_loop()
        assert isinstance(loop, SourceLoop)
        participant = await loop.aside(
            partial(DdsParticipant, self._address, self._post)
        )
        try:
            await self._meet(participant)
        finally:
            participant.close()

    async def _meet(self, participant: DdsParticipant) -> None:
        """Wait for others, and speak until the last of them is gone."""
        peers: dict[bytes, DdsPeer] = {}
        found, lost = asyncio.Event(), asyncio.Event()

        def seen(peer: DdsPeer) -> None:
            if peer.is_there:
                peers[peer.id] = peer
                found.set()
            elif peers.pop(peer.id, None) is not None and not peers:
                lost.set()

        participant.watch_peers(seen)
        with suppress(asyncio.TimeoutError):
            await asyncio.wait_for(found.wait(), LONGEST_SEARCH)
        if not peers:
            raise SourceError(nothing(self._address))
        await self._hold(partial(DdsConversation, participant, peers), lost)
        raise SourceError(f"The last participant of {self._address.label} is gone")

    def _explain(self, error: BaseException) -> str:
        return str(error)

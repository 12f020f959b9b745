"""A recording in several files that is still made, as a live source some seconds late.

`--record-dir` with `--max-bag-duration` writes it, and any web server hands it out. The
list is asked for every two seconds; each file that is new is copied and played at the
pace of its log times. Only differences of those count, so clocks may be apart.
"""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from functools import partial

from sambot_viz.errors import SambotVizError, SourceError
from sambot_viz.sources.bag.bag import Bag
from sambot_viz.sources.bag.opening import open_bag
from sambot_viz.sources.bag.web_folder import MissingPartError, PartList, WebFolder
from sambot_viz.sources.follow.conversation import FollowConversation
from sambot_viz.sources.live.event_loop import SourceLoop
from sambot_viz.sources.live.live_source import TICK, LiveSource

POLL = 2.0
"""Time between two questions for the list [s]."""
FARTHEST = 3
"""A follower that is more files behind goes on with the newest."""
LONGEST_GAP = 2.0
"""Longest pause between two messages of a file [s]: clocks are set meanwhile."""
_AT_ONCE = 100


@dataclass(frozen=True, slots=True)
class _CopiedFile:
    """A file that is to be played.

    Attributes:
        bag: the file.
        next: the number of the one after it in the list.
        listed_at: when its name came [s of the loop].
    """

    bag: Bag
    next: int
    listed_at: float


class FollowedRecording(LiveSource):
    """A live source of the files of a recording, in the order of its list."""

    # The next file of the recording whose first one is named so.
    _first = ""
    _next = 0

    async def _connect(self) -> None:
        loop = asyncio.get_running_loop()
        assert isinstance(loop, SourceLoop)
        folder = WebFolder(self._address.websocket)
        try:
            listed = await loop.aside(folder.read_list)
            first = listed.names[0] if listed.names else ""
            if first != self._first or not first:
                self._first, self._next = first, max(0, len(listed.names) - 1)
            conversation = self._converse(partial(FollowConversation, first))
            assert isinstance(conversation, FollowConversation)
            await self._follow_files(loop, folder, conversation, listed)
        finally:
            folder.close()

    async def _follow_files(
        self,
        loop: SourceLoop,
        folder: WebFolder,
        conversation: FollowConversation,
        listed: PartList,
    ) -> None:
        """Copy, play and tick, until one of them fails."""
        parts: asyncio.Queue[_CopiedFile | None] = asyncio.Queue(1)
        jobs = (
            self._copy(loop, folder, conversation, listed, parts),
            self._play(loop, conversation, parts),
            self._tick(loop, conversation),
        )
        tasks = [asyncio.ensure_future(job) for job in jobs]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_EXCEPTION)
        finally:
            for task in tasks:
                task.cancel()
            results = await asyncio.gather(*tasks, return_exceptions=True)
            while not parts.empty():
                if (left := parts.get_nowait()) is not None:
                    left.bag.close()
        for result in results:
            if isinstance(result, Exception):
                raise result

    async def _copy(
        self,
        loop: SourceLoop,
        folder: WebFolder,
        conversation: FollowConversation,
        listed: PartList,
        parts: asyncio.Queue[_CopiedFile | None],
    ) -> None:
        """Copy file after file, one ahead of the one that is played.

        A server that is away is asked again, and what was copied is played meanwhile.
        """
        listed_at, number = loop.time(), self._next
        while True:
            names = listed.names
            self._first = self._first or next(iter(names), "")
            if names and names[0] != self._first:
                raise SourceError("another recording has taken its place")
            if len(names) - number > FARTHEST:
                number = len(names) - 1
            try:
                if number < len(names):
                    bag = await loop.aside(partial(_copied, folder, names[number]))
                    number += 1
                    await parts.put(_CopiedFile(bag, number, listed_at))
                elif listed.is_running:
                    await asyncio.sleep(POLL)
                else:
                    return await parts.put(None)
                found = await loop.aside(folder.read_list)
                conversation.trouble = ""
            except (MissingPartError, SourceError):
                conversation.missing += 1
                number += 1
                continue
            except OSError as error:
                conversation.trouble = str(error)
                await asyncio.sleep(POLL)
                continue
            # A list that is shorter was read while it was written.
            if len(found.names) >= len(names):
                listed_at = loop.time() if found.names != names else listed_at
                listed = found

    async def _play(
        self,
        loop: SourceLoop,
        conversation: FollowConversation,
        parts: asyncio.Queue[_CopiedFile | None],
    ) -> None:
        """Deliver the messages of file after file, at the pace of their log times."""
        due, last_ns = loop.time(), 0
        while (part := await parts.get()) is not None:
            self._next = part.next
            try:
                conversation.take_part(part.bag, loop.time() - part.listed_at)
                self._follow()
                # What comes late is played from now on.
                due, count = max(due, loop.time()), 0
                for message in part.bag.messages():
                    gap = (message.log_ns - last_ns) * 1e-9 if last_ns else 0.0
                    due += min(max(gap, 0.0), LONGEST_GAP)
                    last_ns, count = message.log_ns, count + 1
                    if due > loop.time() or count % _AT_ONCE == 0:
                        await asyncio.sleep(due - loop.time())
                    conversation.hand_on(message)
            finally:
                part.bag.close()
        conversation.has_ended = True
        self._tell_health()

    async def _tick(self, loop: SourceLoop, conversation: FollowConversation) -> None:
        while True:
            self._follow()
            await asyncio.sleep(TICK)
            conversation.tick(loop.time())
            self._tell_health()

    def _explain(self, error: BaseException) -> str:
        if isinstance(error, SambotVizError | OSError):
            return str(error)
        return f"internal error: {error}"


def _copied(folder: WebFolder, name: str) -> Bag:
    """Copy a file and open it; its name is then needed no longer."""
    path = folder.fetch(name)
    bag = open_bag(path)
    path.unlink()
    return bag

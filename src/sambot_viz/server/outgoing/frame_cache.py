"""Pack messages for the wire once, however many clients get them.

viser packs and compresses every message for every client. If thirty clients opened a
scene of 50 MB, that would take 3 GB and half a minute of computing.
"""

from __future__ import annotations

import asyncio
import weakref
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

from sambot_viz import viser_private

HEAVY = 256 * 1024
"""Above this size, a thread packs a frame, and the cache drops it once sent [bytes]."""
RECENT = 32
"""Number of small frames kept for clients that lag a little."""
MARKER, MORE = -1, -2
"""Numbers of messages outside any buffer: viser's marker, and the notice that more
messages of the same change follow."""


MOVED = -10
"""This value minus the number of a pose follows a message's number: it says since when
the message has its pose."""


@dataclass(frozen=True, slots=True)
class Batch:
    """Messages that go out together.

    Attributes:
        numbers: numbers of the messages in their buffer, which identify them.
        messages: viser's messages.
        weight: approximate size [bytes].
    """

    numbers: tuple[int, ...]
    messages: Sequence[Any]
    weight: int

    def with_marker(self, marker: Any, number: int = MARKER) -> Batch:
        """Return this batch, followed by a message that is in no buffer."""
        numbers = (*self.numbers, number)
        return Batch(numbers, (*self.messages, marker), self.weight)


def weight(message: Any) -> int:
    """Return the approximate size of a message, from its large fields [bytes]."""
    holder: Any = getattr(message, "props", message)
    fields = cast(dict[str, Any], holder.__dict__)
    return sum(map(_length, fields.values()))


def _length(value: Any) -> int:
    if isinstance(value, str | bytes):
        return len(value)
    if isinstance(value, dict):
        return sum(map(_length, cast(dict[str, Any], value).values()))
    return getattr(value, "nbytes", 8)


class PackedFrame:
    """A batch as it goes over the wire, in one websocket frame.

    Attributes:
        content: its bytes.
    """

    def __init__(self, content: bytes) -> None:
        self.content = content


class FrameCache:
    """Keep the packed frames of one buffer; pack each when a client first wants it."""

    def __init__(self) -> None:
        self._packer = viser_private.Packer()
        self._recent: deque[PackedFrame] = deque(maxlen=RECENT)
        self._there: weakref.WeakValueDictionary[tuple[int, ...], PackedFrame] = (
            weakref.WeakValueDictionary()
        )
        self._packing: dict[tuple[int, ...], asyncio.Task[PackedFrame]] = {}
        self._one_at_a_time = asyncio.Lock()

    async def packed(self, batch: Batch) -> PackedFrame:
        """Pack a batch, or return the frame from the cache.

        A heavy frame stays in the cache only as long as a client holds it.
        """
        numbers = batch.numbers
        found = self._there.get(numbers)
        if found is not None:
            return found
        if batch.weight <= HEAVY:
            frame = self._there[numbers] = PackedFrame(
                self._packer.pack(batch.messages)
            )
            self._recent.append(frame)
            return frame
        task = self._packing.get(numbers)
        if task is None:
            task = asyncio.get_running_loop().create_task(self._pack_heavy(batch))
            self._packing[numbers] = task
            task.add_done_callback(lambda _: self._packing.pop(numbers))
        # A client that leaves must not cancel the packing for the others.
        return await asyncio.shield(task)

    async def _pack_heavy(self, batch: Batch) -> PackedFrame:
        # Each takes three times its size during packing.
        async with self._one_at_a_time:
            pack = viser_private.Packer().pack
            frame = PackedFrame(await asyncio.to_thread(pack, batch.messages))
        self._there[batch.numbers] = frame
        return frame

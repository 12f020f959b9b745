"""Pack messages for the wire once, however many clients get them.

viser packs and compresses every message for every client. Thirty clients that open a
scene of 50 MB would take 3 GB and half a minute of computing.
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
"""More than that is packed in a thread, and is not kept once it is sent [bytes]."""
RECENT = 32
"""Number of small frames kept for clients that lag a little."""
MARKER, MORE = -1, -2
"""The numbers of messages that are in no buffer: viser's marker, and that more of what
belongs together follows."""


MOVED = -10
"""Less a number, it follows the number of a message: since when its pose is that."""


@dataclass(frozen=True, slots=True)
class Batch:
    """Messages that go out together.

    Attributes:
        numbers: those of the messages in their buffer; they say which they are.
        messages: viser's messages.
        weight: about how long they are [bytes].
    """

    numbers: tuple[int, ...]
    messages: Sequence[Any]
    weight: int

    def with_marker(self, marker: Any, number: int = MARKER) -> Batch:
        """This batch with a message behind it that is in no buffer."""
        numbers = (*self.numbers, number)
        return Batch(numbers, (*self.messages, marker), self.weight)


def weight(message: Any) -> int:
    """Return about how long a message is [bytes], by what may be long in it."""
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
    """Keep the packed frames of one buffer, each made when a client first wants it."""

    def __init__(self) -> None:
        self._packer = viser_private.Packer()
        self._recent: deque[PackedFrame] = deque(maxlen=RECENT)
        self._there: weakref.WeakValueDictionary[tuple[int, ...], PackedFrame] = (
            weakref.WeakValueDictionary()
        )
        self._packing: dict[tuple[int, ...], asyncio.Task[PackedFrame]] = {}
        self._one_at_a_time = asyncio.Lock()

    async def packed(self, batch: Batch) -> PackedFrame:
        """Pack a batch, unless it is there already.

        A heavy one is there only as long as a client holds it.
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
        # A client that leaves does not take it away from the others.
        return await asyncio.shield(task)

    async def _pack_heavy(self, batch: Batch) -> PackedFrame:
        # Each takes three times its length while it is packed.
        async with self._one_at_a_time:
            pack = viser_private.Packer().pack
            frame = PackedFrame(await asyncio.to_thread(pack, batch.messages))
        self._there[batch.numbers] = frame
        return frame

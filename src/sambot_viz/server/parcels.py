"""Messages packed for the wire: once, however many browsers get them.

viser packs and compresses every message for every browser. Thirty browsers that open a
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
"""So many light parcels are kept for the browsers that are a little behind."""
MARKER = -1
"""The number of a message that is in no buffer."""


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

    def with_marker(self, marker: Any) -> Batch:
        """This batch with a message behind it that is in no buffer."""
        numbers = (*self.numbers, MARKER)
        return Batch(numbers, (*self.messages, marker), self.weight)


def weight(message: Any) -> int:
    """About how long a message is [bytes], of what may be long in it."""
    holder: Any = getattr(message, "props", message)
    fields = cast(dict[str, Any], holder.__dict__)
    return sum(map(_length, fields.values()))


def _length(value: Any) -> int:
    if isinstance(value, str | bytes):
        return len(value)
    if isinstance(value, dict):
        return sum(map(_length, cast(dict[str, Any], value).values()))
    return getattr(value, "nbytes", 8)


class Parcel:
    """A batch as it goes over the wire.

    Attributes:
        content: its bytes.
    """

    def __init__(self, content: bytes) -> None:
        self.content = content


class Parcels:
    """The batches of one buffer, each packed when a browser first wants it."""

    def __init__(self) -> None:
        self._packer = viser_private.Packer()
        self._recent: deque[Parcel] = deque(maxlen=RECENT)
        self._there: weakref.WeakValueDictionary[tuple[int, ...], Parcel] = (
            weakref.WeakValueDictionary()
        )
        self._packing: dict[tuple[int, ...], asyncio.Task[Parcel]] = {}
        self._one_at_a_time = asyncio.Lock()

    async def parcel(self, batch: Batch) -> Parcel:
        """Pack a batch, unless it is there already.

        A heavy one is there only as long as a browser holds it.
        """
        numbers = batch.numbers
        found = self._there.get(numbers)
        if found is not None:
            return found
        if batch.weight <= HEAVY:
            parcel = self._there[numbers] = Parcel(self._packer.pack(batch.messages))
            self._recent.append(parcel)
            return parcel
        task = self._packing.get(numbers)
        if task is None:
            task = asyncio.get_running_loop().create_task(self._pack_heavy(batch))
            self._packing[numbers] = task
            task.add_done_callback(lambda _: self._packing.pop(numbers))
        # A browser that leaves does not take it away from the others.
        return await asyncio.shield(task)

    async def _pack_heavy(self, batch: Batch) -> Parcel:
        # Each takes three times its length while it is packed.
        async with self._one_at_a_time:
            pack = viser_private.Packer().pack
            parcel = Parcel(await asyncio.to_thread(pack, batch.messages))
        self._there[batch.numbers] = parcel
        return parcel

"""One client's position in the messages of a buffer, and its next batch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from sambot_viz import viser_private
from sambot_viz.server.outgoing.frame_cache import HEAVY, MOVED, Batch, weight


@dataclass(slots=True)
class SharedBatch:
    """Keep the newest batch: clients that have all earlier messages share it.

    Attributes:
        after: numbers of the last message, and of the last frame of poses, before it.
        end: the same numbers at its end.
        batch: all messages in between.
    """

    after: tuple[int, int] = (-1, -1)
    end: tuple[int, int] = (-1, -1)
    batch: Batch = field(default_factory=lambda: Batch((), (), 0))


class MessageCursor:
    """Track the position of one client in the messages.

    Args:
        buffer: buffer of the messages.
        client_id: number of the client.
        shared: batch that all clients of the buffer share.

    Attributes:
        client_id: as given.
        last: number of the last message that the client has had or does not need.
    """

    def __init__(
        self, buffer: viser_private.MessageBuffer, client_id: int, shared: SharedBatch
    ) -> None:
        self.client_id = client_id
        self.last = -1
        self._buffer = buffer
        self._poses = viser_private.MovingPoses.of(buffer)
        # Number of the last frame of poses that the client has had.
        self._posed = -1
        self._shared = shared
        self._ahead: Sequence[int] = ()
        self._place = 0

    @property
    def held(self) -> bool:
        """Return whether all messages must wait for now."""
        return self._buffer.atomic_counter != 0

    def next(self, end: int) -> Batch:
        """Return the next messages; empty when there are none, or they must wait.

        Args:
            end: number of the last message that may be included; it never decreases.
        """
        shared, after = self._shared, (self.last, self._posed)
        has_all = self._place == len(self._ahead)
        if has_all and not self.held and after == shared.after and end == shared.end[0]:
            self.last, self._posed = shared.end
            return shared.batch
        batch, is_for_all = self._collect(end)
        is_whole = has_all and self.last == end and bool(batch.messages)
        if is_whole and is_for_all and batch.weight < HEAVY:
            shared.after, shared.end = after, (end, self._posed)
            shared.batch = batch
        return batch

    def _collect(self, end: int) -> tuple[Batch, bool]:
        """Return the next messages, and whether every client would get the same."""
        numbers: list[int] = []
        found: list[viser_private.Message] = []
        most, heavy, is_for_all = self._buffer.max_window_size, 0, True
        while self.last < end and len(found) < most and heavy < HEAVY and not self.held:
            if self._place == len(self._ahead):
                self._ahead, self._place = self._numbers(end), 0
            number = self._ahead[self._place]
            message, state = self._message(number)
            if message is not None:
                is_for_all = is_for_all and message.excluded_self_client is None
            if message is not None and message.excluded_self_client != self.client_id:
                more = weight(message)
                if found and more >= HEAVY:
                    break
                heavy += more
                found.append(message)
                numbers += state
            self._place += 1
            self.last = number
            self._forget(number)
        return Batch(tuple(numbers), found, heavy), is_for_all

    def _message(self, number: int) -> tuple[Any, Sequence[int]]:
        """Return a message, if it exists, and the numbers that identify its state.

        The pose in a message changes in place, and so does a frame of poses.
        """
        message = self._buffer.message_from_id.get(number)
        moved = self._posed
        if self._poses.is_frame(message):
            message = self._poses.between(self._posed, number)
            self._posed = number
        elif message is None or (moved := getattr(message, "moved_in", -1)) < 0:
            return message, (number,)
        return message, (number, MOVED - moved)

    def _numbers(self, end: int) -> Sequence[int]:
        """Return the numbers to ask for; the last one is `end`."""
        messages = self._buffer.message_from_id
        if end - self.last <= len(messages):
            return range(self.last + 1, end + 1)
        # Another thread may add a message at any moment.
        with self._buffer.buffer_lock:
            there = [number for number in messages if self.last < number < end]
        return [*there, end]

    def _forget(self, number: int) -> None:
        if not self._buffer.persistent_messages:
            with self._buffer.buffer_lock:
                self._buffer.pop_message_locked(number)

"""What a display keeps of messages: those that wait for a place, and those it shows."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.frames import LookupRefused
from sambot_viz.geometry import Matrix, Vector3, Wxyz, wxyz_from_matrix
from sambot_viz.sources.message import Recorded

T = TypeVar("T")


@dataclass(frozen=True, slots=True, eq=False)
class Taken(Generic[T]):
    """What was read of a message that has a place.

    Attributes:
        read: what is drawn of it.
        T_fixed_frame: (4, 4), where its frame was at its stamp.
    """

    read: T
    T_fixed_frame: Matrix

    @property
    def pose(self) -> tuple[Wxyz, Vector3]:
        """Rotation and position [m] of its frame in the fixed frame."""
        return wxyz_from_matrix(self.T_fixed_frame), position_of(self.T_fixed_frame)


class Held:
    """A message that waits for its transform; it is decoded when it is its turn.

    Attributes:
        recorded: as it came.
        refused: why it had no place when that was looked for last.
    """

    def __init__(self, recorded: Recorded, decode: Callable[[Recorded], Any]) -> None:
        self.recorded = recorded
        self.refused: LookupRefused | None = None
        self._decode = decode
        self._message: Any = None

    @property
    def message(self) -> Any:
        """The message with its fields; raises DecodeError."""
        if self._message is None:
            self._message = self._decode(self.recorded)
        return self._message

    def forget(self) -> None:
        """Keep the bytes alone."""
        self._message = None


class HeldMessages:
    """The messages of a display, as they came.

    Args:
        most_drawn: so many of those that are drawn are kept, to place them again.

    Attributes:
        waiting: those without a place, the oldest first.
        drawn: those that had one.
    """

    def __init__(self, most_drawn: int) -> None:
        self.waiting: deque[Held] = deque()
        self.drawn: deque[Held] = deque(maxlen=most_drawn)

    def clear(self) -> None:
        """Forget all."""
        self.waiting.clear()
        self.drawn.clear()

    def leave(self, most: int, *, last_only: bool) -> Sequence[Held]:
        """Keep what waits, and return what has no room.

        Args:
            most: number of waiting messages.
            last_only: whether what is older than the newest that is drawn does not.
        """
        kept: list[Held] = []
        for one in reversed(self.waiting):
            if one.refused is not None:
                kept.append(one)
            elif last_only:
                break
        self.waiting = deque(reversed(kept[:most]))
        return kept[most:]

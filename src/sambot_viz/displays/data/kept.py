"""The messages that a display keeps: those waiting for a place, and the shown ones."""

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
    """The content of a message that has a place.

    Attributes:
        read: its content, as the display draws it.
        T_fixed_frame: pose of its frame at its stamp, (4, 4).
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
        most_drawn: number of drawn messages that are kept, to place them again.

    Attributes:
        waiting: messages without a place, the oldest first.
        drawn: messages that had one.
    """

    def __init__(self, most_drawn: int) -> None:
        self.waiting: deque[Held] = deque()
        self.drawn: deque[Held] = deque(maxlen=most_drawn)

    def clear(self) -> None:
        """Forget all."""
        self.waiting.clear()
        self.drawn.clear()

    def leave(self, most: int, *, last_only: bool) -> Sequence[Held]:
        """Limit the waiting messages, and return the dropped ones.

        Args:
            most: the limit.
            last_only: whether to drop messages older than the newest drawn one.
        """
        kept: list[Held] = []
        for one in reversed(self.waiting):
            if one.refused is not None:
                kept.append(one)
            elif last_only:
                break
        self.waiting = deque(reversed(kept[:most]))
        return kept[most:]

"""The positions of joints that messages bring."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Collection, Mapping
from typing import Any

from sambot_viz.errors import DecodeError
from sambot_viz.sources.message import Recorded


class JointStateTopics:
    """Takes sensor_msgs/JointState messages; several publishers name parts of a robot.

    Args:
        topics: their names.
        decode: a message as an object with the lists name and position; raises
            DecodeError.

    Attributes:
        topics: as given.
        last: joint → the last position that was taken [rad or m].
        undecoded: topic → how many messages could not be decoded.
        uneven: topic → how many messages have more names than positions.
    """

    depth_ns = 1_000_000_000
    always: Collection[str] = ()

    def __init__(
        self, topics: Collection[str], decode: Callable[[Recorded], Any]
    ) -> None:
        self.topics = tuple(topics)
        self.undecoded: Counter[str] = Counter()
        self.uneven: Counter[str] = Counter()
        self._decode = decode
        self.last: dict[str, float] = {}
        self._changed: dict[str, float] = {}

    def take(self, message: Recorded) -> None:
        """Take the positions of a message; no number is no news."""
        try:
            state = self._decode(message)
            names, positions = list(state.name), list(state.position)
        except (DecodeError, AttributeError, TypeError):
            # A file may define the type otherwise, or with other fields.
            self.undecoded[message.topic] += 1
            return
        if len(names) != len(positions):
            self.uneven[message.topic] += 1
        for name, position in zip(names, positions, strict=False):
            if math.isfinite(position):
                self._changed[name] = self.last[name] = float(position)

    def take_older(self, message: Recorded) -> None:
        """Do nothing: what is older than `depth_ns` counts for nothing."""

    def clear(self) -> None:
        """Forget what was not asked for."""
        self._changed.clear()

    def lacks(self) -> bool:
        """Return False: a joint without a message stays where it is."""
        return False

    def changed(self) -> Mapping[str, float]:
        """Return joint → position since the last call [rad or m]."""
        changed, self._changed = self._changed, {}
        return changed

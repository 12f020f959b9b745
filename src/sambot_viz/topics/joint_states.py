"""The positions of joints that messages bring."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from sambot_viz.errors import DecodeError
from sambot_viz.messages import JointStateTemplate
from sambot_viz.sources.message import Recorded, TopicChannel
from sambot_viz.topics.joint_index import JointIndex

# A page without a recording does without what opens one.
if TYPE_CHECKING:
    from sambot_viz.sources.bag import Bag

_MOST_TEMPLATES = 8
"""Maximum number of cached names of a robot's parts, in each channel."""


class JointNames:
    """Reads which joints have a position in messages; most are not decoded.

    Args:
        decode: as for `JointStateTopics`.
    """

    def __init__(self, decode: Callable[[Recorded], Any]) -> None:
        self._taker = JointStateTopics((), decode)

    def __call__(self, message: Recorded) -> tuple[str, ...]:
        """Return the joints; empty for a message that cannot be decoded."""
        taker = self._taker
        taker.clear()
        taker.take(message)
        return tuple(taker.changed())


class JointStateTopics:
    """Takes sensor_msgs/JointState messages; several publishers name parts of a robot.

    Args:
        topics: their names.
        decode: a message as an object with the lists name and position; raises
            DecodeError.
        index: finds the messages that hold at a time of a recording.

    Attributes:
        topics: as given.
        undecoded: topic → how many messages could not be decoded.
        uneven: topic → how many messages have more names than positions.
    """

    always: Collection[str] = ()

    def __init__(
        self,
        topics: Collection[str],
        decode: Callable[[Recorded], Any],
        index: JointIndex | None = None,
    ) -> None:
        self.topics = tuple(topics)
        self.undecoded: Counter[str] = Counter()
        self.uneven: Counter[str] = Counter()
        self._decode = decode
        self._index = index
        self._named: set[str] = set()
        self._unfound: Collection[str] = ()
        self._last: dict[str, float] = {}
        self._changed: dict[str, float] = {}
        self._templates: dict[TopicChannel, list[JointStateTemplate]] = {}
        # The newest of each template, the last one at the end.
        self._newest: dict[JointStateTemplate, NDArray[np.float64]] = {}

    @property
    def last(self) -> Mapping[str, float]:
        """Joint → the last position that was taken [rad or m]."""
        self._spread()
        return self._last

    def set_topics(self, topics: Collection[str]) -> None:
        """Take the messages of these topics; where some are gone, begin again."""
        before, self.topics = self.topics, tuple(topics)
        if not set(topics).issuperset(before):
            self.clear()

    def take(self, message: Recorded) -> None:
        """Take the positions of a message, if all are finite."""
        for template in self._templates.get(message.channel, ()):
            positions = template.read(message.payload)
            if positions is None:
                continue
            if np.isfinite(positions).all():
                self._newest.pop(template, None)
                self._newest[template] = positions
            else:
                self._spread()
                self._set(template.names, positions.tolist())
            return
        try:
            state = self._decode(message)
            names, numbers = list(state.name), list(state.position)
        except (DecodeError, AttributeError, TypeError):
            # A file may define the type otherwise, or with other fields.
            self.undecoded[message.topic] += 1
            return
        if len(names) != len(numbers):
            self.uneven[message.topic] += 1
        self._spread()
        self._set(names, numbers)
        template = JointStateTemplate.of(message.payload, names, numbers)
        if template is not None:
            known = self._templates.get(message.channel, [])
            self._templates[message.channel] = [template, *known][:_MOST_TEMPLATES]

    def _set(self, names: Sequence[str], numbers: Sequence[float]) -> None:
        for name, number in zip(names, numbers, strict=False):
            if math.isfinite(number):
                self._changed[name] = self._last[name] = float(number)

    def _spread(self) -> None:
        """Give the joints what was taken last."""
        newest, self._newest = self._newest, {}
        for template, positions in newest.items():
            self._set(template.names, positions.tolist())

    def until(self, recording: Bag, at_ns: int) -> Sequence[Recorded]:
        """Return the messages that hold at a log time [ns], in their order."""
        del recording
        if self._index is None:
            return ()
        found, self._unfound = self._index.holding_of(self._named, at_ns)
        return found

    @property
    def unfound(self) -> Collection[str]:
        """The joints that the last jump did not look for in all messages of before."""
        if not self._unfound:
            return ()
        self._spread()
        return [name for name in self._unfound if name not in self._last]

    def clear(self) -> None:
        """Forget what was taken."""
        self._spread()
        self._named.update(self._last)
        self._last.clear()
        self._changed.clear()

    def gone(self) -> Collection[str]:
        """Return the joints that messages have named, but none since the last jump."""
        self._spread()
        return self._named - self._last.keys()

    def changed(self) -> Mapping[str, float]:
        """Return joint → position since the last call [rad or m]."""
        self._spread()
        changed, self._changed = self._changed, {}
        return changed

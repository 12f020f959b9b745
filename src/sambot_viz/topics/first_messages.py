"""What the first messages of a recording say: their frames, and how much is in them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from sambot_viz.errors import DecodeError
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.first_topics import shown_at_first

# It is opened by who has one.
if TYPE_CHECKING:
    from sambot_viz.sources.bag import Bag


class FirstMessages:
    """Reads the first message of a topic, on demand and once.

    Args:
        recording: the messages; None without a recording.
        decode: returns a message as an object with its fields; raises DecodeError.
    """

    def __init__(
        self, recording: Bag | None, decode: Callable[[Recorded], Any]
    ) -> None:
        self._recording = recording
        self._decode = decode
        self._read: dict[str, Any] = {}

    def frames(self, types: Mapping[str, str]) -> Iterator[str]:
        """Yield the frames that topics are stamped in, in the order of need.

        Args:
            types: topic → type of its messages.
        """
        for topic, _ in shown_at_first(types):
            header = getattr(self._first_of(topic), "header", None)
            frame = plain_name(str(getattr(header, "frame_id", "")))
            if frame:
                yield frame

    def points_of(self, topic: str) -> int | None:
        """Return how many points a message of a topic has; None if not known."""
        message = self._first_of(topic)
        for name in ("ranges", "points"):
            if (listed := getattr(message, name, None)) is not None:
                return len(listed)
        width, height = (getattr(message, n, None) for n in ("width", "height"))
        return None if width is None or height is None else int(width * height)

    def _first_of(self, topic: str) -> Any:
        """Return the first message of a topic; None where it cannot be read."""
        recording = self._recording
        if recording is None or recording.start_ns is None:
            return None
        if topic not in self._read:
            found = recording.next(topic, recording.start_ns - 1)
            try:
                self._read[topic] = None if found is None else self._decode(found)
            except DecodeError:
                self._read[topic] = None
        return self._read[topic]

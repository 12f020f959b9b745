"""What was seen of the messages of a topic, whoever has looked at them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, cast

from sambot_viz.errors import DecodeError
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.sources.message import Recorded
from sambot_viz.topics import reasons
from sambot_viz.topics.contents import content_reason
from sambot_viz.topics.reasons import TopicReason


@dataclass(slots=True)
class Looked:
    """The result of reading some messages of a topic.

    Attributes:
        seen: number of messages that were read.
        first_ns: log time of the first one [ns]; None without any.
        last_ns: log time of the last one that was read [ns].
        decoded: number of attempts to decode one.
        undecoded: number of messages that cannot be decoded.
        cause: why the first of them cannot.
        frame: the frame of the headers; empty without one.
        stamps: the lowest and the highest stamp of headers [ns]; None without any.
        fields: the names in a message.
        nothing: why all messages are empty; None if one is not.
    """

    seen: int = 0
    first_ns: int | None = None
    last_ns: int = 0
    decoded: int = 0
    undecoded: int = 0
    cause: str = ""
    frame: str = ""
    stamps: tuple[int, int] | None = None
    fields: tuple[str, ...] = ()
    nothing: TopicReason | None = None
    _has_content: bool = field(default=False)

    def decode(self, message: Recorded, decode: Callable[[Recorded], Any]) -> None:
        """Look into a message."""
        self.decoded += 1
        try:
            self._note(decode(message))
        except DecodeError as error:
            self.undecoded += 1
            self.cause = self.cause or str(error)
        except Exception as error:
            # A file may define a standard type with other fields.
            self.cause = self.cause or f"{type(error).__name__} in its fields"

    def undecodable(self, count: int | None) -> TopicReason | None:
        """Return how many messages cannot be decoded.

        Args:
            count: of all messages of the topic; None while that is not known.
        """
        if not self.undecoded:
            return None
        is_all = count is not None and self.decoded >= count
        cause = self.cause or "they are no transforms"
        return reasons.not_decodable(self.undecoded, self.decoded, cause, is_all)

    def _note(self, message: Any) -> None:
        if not self.fields:
            self.fields = _fields_of(message)
        header = getattr(message, "header", None)
        if header is not None:
            self._note_header(header)
        if not self._has_content:
            self.nothing = content_reason(message)
            self._has_content = self.nothing is None

    def _note_header(self, header: Any) -> None:
        frame, stamp = getattr(header, "frame_id", ""), getattr(header, "stamp", None)
        self.frame = self.frame or plain_name(str(frame))
        time = getattr(stamp, "sec", 0) * 1_000_000_000 + getattr(stamp, "nanosec", 0)
        # Without a stamp the newest transform is meant.
        if time:
            least, most = self.stamps or (time, time)
            self.stamps = min(least, time), max(most, time)


def _fields_of(message: Any) -> tuple[str, ...]:
    if isinstance(message, dict):
        return tuple(str(name) for name in cast("dict[str, Any]", message))
    names = cast("dict[str, Any]", getattr(message, "__dataclass_fields__", {}))
    return tuple(name for name in names if not name.startswith("__"))

"""What of a recording is left out, since it is too large or makes no sense."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass
from pathlib import Path

from sambot_viz import limits
from sambot_viz.errors import Problem
from sambot_viz.sources.bag.compression import BrokenPieceError, TooLargeError
from sambot_viz.sources.message import too_large

_MOST_NAMED = 5
_HINT_MESSAGE = (
    "publish fewer pixels or points in a message, and record again; the rest is shown"
)
_HINT_CHUNK = (
    "record again with smaller chunks ('chunkSize' in the file of 'ros2 bag record "
    "--storage-config-file'); the rest is shown"
)
_HINT_RECORD = (
    "record again with shorter definitions; topics that need it say that their type is "
    "not known"
)


@dataclass(frozen=True, slots=True)
class _Chunk:
    """A part that is left out: its place, the reason, and its channels, if known."""

    at: int
    error: BrokenPieceError
    channels: frozenset[int]

    @property
    def is_large(self) -> bool:
        return isinstance(self.error, TooLargeError)

    @property
    def sentence(self) -> str:
        how = "" if self.is_large else "is damaged: "
        return f"the chunk at byte {self.at:,} {how}{self.error}"


class LeftOut:
    """Collects the left out parts of a file, for sentences about them."""

    def __init__(self) -> None:
        # Channel → log time [ns] → size [bytes]: a part may be read several times.
        self._messages: dict[int, dict[int, int]] = {}
        self._chunks: list[_Chunk] = []
        self._topic = ""
        self._records: list[str] = []

    def add_message(self, channel: int, time: int, size: int) -> bool:
        """Note a message that is too large; False when it was noted before."""
        known = self._messages.setdefault(channel, {})
        is_new = time not in known
        known[time] = size
        return is_new

    def add_chunk(
        self, at: int, error: BrokenPieceError, channels: frozenset[int]
    ) -> None:
        """Note a chunk that is too large or damaged.

        Args:
            at: where it begins [bytes].
            error: why.
            channels: that have messages in it; empty when that is not known.
        """
        self._chunks.append(_Chunk(at, error, channels))

    def add_record(self, at: int, size: int) -> None:
        """Note a record of a channel or of a type that is too large, at its place."""
        said = limits.DEFINITION_RECORD.said(size)
        self._records.append(f"at byte {at:,}, with {said}")

    def add_topic(self, topic: str) -> None:
        """Note a topic that is one too many."""
        self._topic = self._topic or topic

    def of(self, channels: Set[int], count: int) -> str:
        """Return the sentence about left out messages of a topic; empty for none.

        Args:
            channels: the channels of the topic.
            count: number of its readable messages.
        """
        sizes = [s for one in channels for s in self._messages.get(one, {}).values()]
        if sizes:
            return _messages(sizes)
        for chunk in self._chunks:
            if chunk.channels & channels and (chunk.is_large or not count):
                return f"messages are left out: {chunk.sentence}"
            if not chunk.channels and not count:
                return f"messages may be left out: {chunk.sentence}"
        return ""

    @property
    def cause(self) -> str:
        """Why nothing may be left to read; empty when nothing is left out."""
        sizes = [s for one in self._messages.values() for s in one.values()]
        found = [chunk.sentence for chunk in self._chunks]
        return next(iter(found), _messages(sizes) if sizes else "")

    @property
    def remedy(self) -> str:
        """What to do about the cause."""
        is_large = all(chunk.is_large for chunk in self._chunks)
        if is_large and (self._chunks or self._messages):
            return "record again, with smaller messages or chunks"
        return "copy the file again if there is another one, or record again"

    def problems(self, path: Path, names: Mapping[int, str]) -> Iterator[Problem]:
        """Yield the sentences about parts that are too large.

        Args:
            path: the file.
            names: channel → topic.
        """
        by_topic: dict[str, list[int]] = {}
        for channel, found in self._messages.items():
            topic = names.get(channel, "a topic without a name")
            by_topic.setdefault(topic, []).extend(found.values())
        told = list(by_topic.items())
        for topic, sizes in told[:_MOST_NAMED]:
            what = f"{path.name}: of {topic} {_messages(sizes)}"
            yield _problem(path, what, _HINT_MESSAGE)
        if len(told) > _MOST_NAMED:
            what = f"{path.name}: so are messages of {len(told) - _MOST_NAMED:,} more"
            yield _problem(path, f"{what} topics", _HINT_MESSAGE)
        large = [chunk for chunk in self._chunks if chunk.is_large]
        if large:
            rest = f"; so do {len(large) - 1:,} more chunks" if len(large) > 1 else ""
            what = (
                f"{path.name}: {large[0].sentence}{rest}: what is too large is left out"
            )
            yield _problem(path, what, _HINT_CHUNK)
        if self._records:
            count = len(self._records)
            rest = f"; so do {count - 1:,} more" if count > 1 else ""
            what = (
                f"{path.name}: the record of a channel or of a type "
                f"{self._records[0]}{rest}: what is too large is left out"
            )
            yield _problem(path, what, _HINT_RECORD)
        if self._topic:
            what = (
                f"{path.name} has more than {limits.CHANNELS.value:,} channels: "
                f"{self._topic} and all later ones are left out"
            )
            yield _problem(path, what, "record again with the topics that are needed")


def _problem(path: Path, message: str, hint: str) -> Problem:
    return Problem("warning", "left-out", message, hint, str(path))


def _messages(sizes: list[int]) -> str:
    """Say how many messages are too large, and how large."""
    return too_large(len(sizes), max(sizes))

"""What every recording is, whatever its format: topics, times, and messages by time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from sambot_viz.errors import Problem
from sambot_viz.sources.message import Recorded, SourceTopic

if TYPE_CHECKING:
    from typing_extensions import Self


class Bag(Protocol):
    """A recording that is open. Several threads may read it."""

    @property
    def paths(self) -> Sequence[Path]:
        """The files, in the order of their first messages."""
        ...

    @property
    def size(self) -> int:
        """How long the files are [bytes]."""
        ...

    @property
    def is_remote(self) -> bool:
        """Whether some of it comes over a network, so that nothing is read ahead."""
        ...

    @property
    def topics(self) -> Mapping[str, SourceTopic]:
        """The topics by name, in the order of the file."""
        ...

    @property
    def start_ns(self) -> int | None:
        """Log time of the first message [ns]; None when there is no message."""
        ...

    @property
    def end_ns(self) -> int | None:
        """Log time of the last message [ns]; it grows while `is_complete` is false."""
        ...

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The damage and what to do; that of a large file is added when it is read."""
        ...

    @property
    def is_complete(self) -> bool:
        """All messages are found; if not, call `index_more` until it says so."""
        ...

    def index_more(self) -> bool:
        """Find more messages, for some tenths of a second; tell if all are found.

        The thread belongs to the caller. Messages that are found can be read at once.
        """
        ...

    def messages(
        self,
        start_ns: int | None = None,
        end_ns: int | None = None,
        topics: Iterable[str] | None = None,
    ) -> Iterator[Recorded]:
        """Yield messages in the order of their log times.

        Args:
            start_ns: the first log time [ns], or None for the beginning.
            end_ns: the last log time [ns], or None for the end.
            topics: names; only what has their messages is read. None for all.
        """
        ...

    def last(self, topic: str, at_ns: int) -> Recorded | None:
        """Return the newest message of a topic at a log time or before it."""
        ...

    def next(self, topic: str, after_ns: int) -> Recorded | None:
        """Return the first message of a topic after a log time."""
        ...

    def previous(self, topic: str, before_ns: int) -> Recorded | None:
        """Return the newest message of a topic before a log time."""
        ...

    def ends_at(self, topic: str) -> int | None:
        """Return when the recording of a topic ends, of several beside each other."""
        ...

    def latched(self) -> Sequence[Recorded]:
        """Return the messages of latched topics by log time, collected at opening."""
        ...

    def close(self) -> None:
        """Close the files; may be called again."""
        ...

    def __enter__(self) -> Self: ...

    def __exit__(self, *raised: object) -> None: ...

"""A recording among others: its topics have a prefix, and its times are moved."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.errors import Problem
from sambot_viz.sources.bag.bag import Bag
from sambot_viz.sources.message import Recorded, SourceTopic
from sambot_viz.sources.prefix import NO_NAMES, Prefix

if TYPE_CHECKING:
    from typing_extensions import Self


class RenamedBag:
    """Hands on what another recording has, under other names; see `Bag`.

    Args:
        bag: the recording; it is closed with this one.
        prefix: before its topics and frames; "" for none.
        shift_ns: how much later its messages are than they were logged [ns].
        hidden: topics that are left out, by their new names.
        remaps: topics with other names there (see `Prefix`).
    """

    def __init__(
        self,
        bag: Bag,
        prefix: str,
        shift_ns: int = 0,
        hidden: Collection[str] = (),
        remaps: Mapping[str, str] = NO_NAMES,
    ) -> None:
        self._bag = bag
        self._prefix = Prefix(prefix, remaps)
        self._shift_ns = shift_ns
        self._hidden = frozenset(hidden)
        self._topics: tuple[object, Mapping[str, SourceTopic]] = (None, {})

    @property
    def paths(self) -> Sequence[Path]:
        """The files."""
        return self._bag.paths

    @property
    def size(self) -> int:
        """How long the files are [bytes]."""
        return self._bag.size

    @property
    def is_remote(self) -> bool:
        """Whether some of it comes over a network."""
        return self._bag.is_remote

    @property
    def topics(self) -> Mapping[str, SourceTopic]:
        """The topics by their new names, without those that are hidden."""
        topics = self._bag.topics
        if self._topics[0] is not topics:
            renamed = self._prefix.topics(topics)
            shown = {n: t for n, t in renamed.items() if n not in self._hidden}
            self._topics = topics, shown
        return self._topics[1]

    @property
    def start_ns(self) -> int | None:
        """The moved log time of the first message [ns]; None when there is none."""
        start = self._bag.start_ns
        return None if start is None else start + self._shift_ns

    @property
    def end_ns(self) -> int | None:
        """The moved log time of the last message [ns]."""
        end = self._bag.end_ns
        return None if end is None else end + self._shift_ns

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The damage, and what to do."""
        return self._bag.problems

    @property
    def is_complete(self) -> bool:
        """All messages are found."""
        return self._bag.is_complete

    def index_more(self) -> bool:
        """Find more messages; see `Bag.index_more`."""
        return self._bag.index_more()

    def messages(
        self,
        start_ns: int | None = None,
        end_ns: int | None = None,
        topics: Iterable[str] | None = None,
    ) -> Iterator[Recorded]:
        """Yield messages in the order of their log times; see `Bag.messages`."""
        known = self.topics
        names = known if topics is None else [n for n in topics if n in known]
        inner = [self._prefix.inner(name) for name in names]
        for message in self._bag.messages(
            self._then(start_ns), self._then(end_ns), inner
        ):
            yield self._prefix.message(message, self._shift_ns)

    def last(self, topic: str, at_ns: int) -> Recorded | None:
        """Return the newest message of a topic at a log time or before it."""
        return self._outer(
            topic, self._bag.last(self._prefix.inner(topic), at_ns - self._shift_ns)
        )

    def next(self, topic: str, after_ns: int) -> Recorded | None:
        """Return the first message of a topic after a log time."""
        return self._outer(
            topic, self._bag.next(self._prefix.inner(topic), after_ns - self._shift_ns)
        )

    def previous(self, topic: str, before_ns: int) -> Recorded | None:
        """Return the newest message of a topic before a log time."""
        return self.last(topic, before_ns - 1)

    def ends_at(self, topic: str) -> int | None:
        """Return the log time of the last message of all topics [ns]."""
        del topic
        return self.end_ns

    def latched(self) -> Sequence[Recorded]:
        """Return the messages of latched topics by log time."""
        found = [self._prefix.message(m, self._shift_ns) for m in self._bag.latched()]
        return [message for message in found if message.topic not in self._hidden]

    def close(self) -> None:
        """Close the files; may be called again."""
        self._bag.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()

    def _then(self, time_ns: int | None) -> int | None:
        return None if time_ns is None else time_ns - self._shift_ns

    def _outer(self, topic: str, message: Recorded | None) -> Recorded | None:
        if message is None or topic in self._hidden:
            return None
        return self._prefix.message(message, self._shift_ns)

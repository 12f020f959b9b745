"""Several files as one recording: the parts of a split one, or bags side by side."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from heapq import heapify, heappop, heappush
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.errors import Problem
from sambot_viz.sources.bag.bag import Bag
from sambot_viz.sources.message import Recorded, SourceTopic

if TYPE_CHECKING:
    from typing_extensions import Self


class Recording:
    """One recording out of some files; see `Bag` for what can be asked of it."""

    def __init__(
        self,
        bags: Sequence[Bag],
        problems: Iterable[Problem] = (),
        *,
        are_beside: bool = False,
    ) -> None:
        """Join open files, which are closed with the recording.

        Args:
            bags: the files.
            problems: problems in addition to those of the files.
            are_beside: whether they are separate recordings, not parts of one.
        """
        # At one time the file that begins first is first, as at the seam of a split.
        self._bags = sorted(bags, key=lambda bag: (bag.start_ns is None, bag.start_ns))
        self._problems = tuple(problems)
        self._are_beside = are_beside
        self._topics: tuple[Sequence[object], Mapping[str, SourceTopic]] = (), {}

    @property
    def paths(self) -> Sequence[Path]:
        """The files, in the order of their first messages."""
        return tuple(path for bag in self._bags for path in bag.paths)

    @property
    def size(self) -> int:
        """How long the files are [bytes]."""
        return sum(bag.size for bag in self._bags)

    @property
    def is_remote(self) -> bool:
        """Whether some of it comes over a network."""
        return any(bag.is_remote for bag in self._bags)

    @property
    def topics(self) -> Mapping[str, SourceTopic]:
        """The topics by name, in the order of the files."""
        parts = [bag.topics for bag in self._bags]
        known, joined = self._topics
        # Who asks for each topic of many joins them once.
        if len(known) != len(parts) or any(
            one is not other for one, other in zip(known, parts, strict=True)
        ):
            joined = _joined_topics(parts)
            self._topics = parts, joined
        return joined

    @property
    def start_ns(self) -> int | None:
        """Log time of the first message [ns]; None when there is no message."""
        times = (bag.start_ns for bag in self._bags)
        return min((time for time in times if time is not None), default=None)

    @property
    def end_ns(self) -> int | None:
        """Log time of the last message [ns]; it grows while `is_complete` is false."""
        times = (bag.end_ns for bag in self._bags)
        return max((time for time in times if time is not None), default=None)

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The damage, and what to do."""
        found = [problem for bag in self._bags for problem in bag.problems]
        if self.start_ns is not None:
            # A part without messages does not hide the others.
            found = [
                replace(problem, severity="info")
                if problem.code == "file-no-messages"
                else problem
                for problem in found
            ]
        return (*self._problems, *found)

    @property
    def is_complete(self) -> bool:
        """All messages are found; if not, call `index_more` until it says so."""
        return all(bag.is_complete for bag in self._bags)

    def index_more(self) -> bool:
        """Find more messages; see `Bag.index_more`."""
        for bag in self._bags:
            if not bag.is_complete:
                bag.index_more()
                break
        return self.is_complete

    def messages(
        self,
        start_ns: int | None = None,
        end_ns: int | None = None,
        topics: Iterable[str] | None = None,
    ) -> Iterator[Recorded]:
        """Yield messages in the order of their log times; see `Bag.messages`."""
        names = None if topics is None else frozenset(topics)
        # A file is read when the time has come at which it begins.
        waiting: list[tuple[int, int, Recorded | None, Iterator[Recorded]]] = [
            (bag.start_ns, number, None, bag.messages(start_ns, end_ns, names))
            for number, bag in enumerate(self._bags)
            if bag.start_ns is not None
            and (end_ns is None or bag.start_ns <= end_ns)
            and (start_ns is None or (bag.end_ns or 0) >= start_ns)
        ]
        if len(waiting) == 1:
            yield from waiting[0][3]
            return
        heapify(waiting)
        while waiting:
            _, number, message, rest = heappop(waiting)
            if message is not None:
                yield message
            following = next(rest, None)
            if following is not None:
                heappush(waiting, (following.log_ns, number, following, rest))

    def last(self, topic: str, at_ns: int) -> Recorded | None:
        """Return the newest message of a topic at a log time or before it."""
        best: Recorded | None = None
        for bag in self._bags:
            if bag.start_ns is not None and bag.start_ns <= at_ns:
                found = bag.last(topic, at_ns)
                if found and (best is None or found.log_ns >= best.log_ns):
                    best = found
        return best

    def next(self, topic: str, after_ns: int) -> Recorded | None:
        """Return the first message of a topic after a log time."""
        found = (bag.next(topic, after_ns) for bag in self._bags)
        there = (message for message in found if message is not None)
        return min(there, key=attrgetter("log_ns"), default=None)

    def previous(self, topic: str, before_ns: int) -> Recorded | None:
        """Return the newest message of a topic before a log time."""
        return self.last(topic, before_ns - 1)

    def ends_at(self, topic: str) -> int | None:
        """Return when the recording of a topic ends, of several beside each other."""
        owner = next((bag for bag in self._bags if topic in bag.topics), None)
        return owner.end_ns if self._are_beside and owner else self.end_ns

    def latched(self) -> Sequence[Recorded]:
        """Return the messages of latched topics by log time, collected at opening."""
        found = [message for bag in self._bags for message in bag.latched()]
        return sorted(found, key=attrgetter("log_ns"))

    def close(self) -> None:
        """Close the files; may be called again."""
        for bag in self._bags:
            bag.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()


def _joined_topics(
    parts: Iterable[Mapping[str, SourceTopic]],
) -> dict[str, SourceTopic]:
    found: dict[str, SourceTopic] = {}
    for topics in parts:
        for name, topic in topics.items():
            found[name] = _joined(found[name], topic) if name in found else topic
    return found


def _joined(one: SourceTopic, other: SourceTopic) -> SourceTopic:
    known = one.count is not None and other.count is not None
    return replace(
        one,
        qos=one.qos or other.qos,
        is_latched=one.is_latched or other.is_latched,
        left_out=one.left_out or other.left_out,
        count=(one.count or 0) + (other.count or 0) if known else None,
    )

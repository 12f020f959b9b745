"""Whoever takes the messages of some topics, and what it is given after a jump."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING, Protocol

from sambot_viz.sources.message import Recorded

# A page without a recording does without what opens one.
if TYPE_CHECKING:
    from sambot_viz.sources.bag import Bag


class Subscriber(Protocol):
    """Takes messages in the order of their log times."""

    @property
    def topics(self) -> Collection[str]:
        """The topics whose messages it takes."""
        ...

    @property
    def always(self) -> Collection[str]:
        """Those of its topics whose messages hold for ever, also after a jump back."""
        ...

    def until(self, recording: Bag, at_ns: int) -> Iterable[Recorded]:
        """Return the messages that count at a log time [ns], in their order."""
        ...

    def take(self, message: Recorded) -> None:
        """Accept a message; one that cannot be decoded is counted, without an error."""
        ...

    def clear(self) -> None:
        """Forget what was taken: the time has jumped."""
        ...


def jump(recording: Bag, at_ns: int, subscribers: Iterable[Subscriber]) -> None:
    """Bring subscribers to a time of a recording, as if it had been played to there.

    What was taken is forgotten, but for what holds for ever.

    Args:
        recording: the messages.
        at_ns: the log time; messages of that time are taken [ns].
        subscribers: are cleared and filled.
    """
    for one in subscribers:
        one.clear()
        for message in one.until(recording, at_ns):
            one.take(message)


def latched_until(
    recording: Bag, topics: Collection[str], at_ns: int
) -> list[Recorded]:
    """Return the latched messages of some topics up to a log time [ns]."""
    latched = recording.latched()
    return [m for m in latched if m.topic in topics and m.log_ns <= at_ns]


def newest_until(
    recording: Bag, topics: Collection[str], at_ns: int, depth_ns: int, base: str = ""
) -> list[Recorded]:
    """Return the newest messages of some topics up to a log time, in their order.

    Args:
        recording: the messages.
        topics: names, of which some may not be in the recording.
        at_ns: the log time [ns].
        depth_ns: how far back messages count [ns]. Of a topic without one in this time
            the last one before counts.
        base: the topic whose last message changes are made to; all that has come since
            it counts. "" for none.
    """
    there = [topic for topic in topics if topic in recording.topics]
    if not there:
        return []
    begin = at_ns - depth_ns
    base_message = recording.last(base, at_ns) if base in there else None
    if base_message is not None:
        begin = min(begin, base_message.log_ns)
    recent = list(recording.messages(begin, at_ns, there))
    seen = {message.topic for message in recent}
    before = [recording.last(name, begin - 1) for name in there if name not in seen]
    older = sorted((m for m in before if m is not None), key=lambda m: m.log_ns)
    return [*latched_until(recording, there, at_ns), *older, *recent]

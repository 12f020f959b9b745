"""Whoever takes the messages of some topics, and what it is given after a jump."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import TYPE_CHECKING, Protocol

from sambot_viz.sources.message import Recorded

# A page without a recording does without what opens one.
if TYPE_CHECKING:
    from sambot_viz.sources.bag import Bag

MOST_OLDER = 400
"""After a jump so many messages before its depth are looked through."""


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

    @property
    def depth_ns(self) -> int:
        """How far back messages count after a jump [ns].

        Of a topic without one in this time the last one before counts.
        """
        ...

    @property
    def base(self) -> str:
        """The topic whose last message changes are made to; "" for none.

        All that has come since it counts.
        """
        ...

    def take(self, message: Recorded) -> None:
        """Take a message; one that cannot be decoded is counted, and no error."""
        ...

    def take_older(self, message: Recorded) -> None:
        """Take what a message, older than those before, has that is new."""
        ...

    def clear(self) -> None:
        """Forget what was taken: the time has jumped."""
        ...

    def lacks(self) -> bool:
        """Return whether older messages could still tell something."""
        ...


def jump(recording: Bag, at_ns: int, subscribers: Iterable[Subscriber]) -> None:
    """Bring subscribers to a time of a recording, as if it had been played to there.

    What was taken is forgotten, but for what holds for ever. Then come the latched
    messages, those of the depth of a subscriber up to the time, and of what is rarer
    the last one.

    Args:
        recording: the messages.
        at_ns: the log time; messages of that time are taken [ns].
        subscribers: are cleared and filled.
    """
    latched = recording.latched()
    for one in subscribers:
        one.clear()
        rest = [topic for topic in one.topics if topic in recording.topics]
        for message in latched:
            if message.topic in one.topics and message.log_ns <= at_ns:
                one.take(message)
        rest = [topic for topic in rest if topic not in one.always]
        begin = at_ns - one.depth_ns
        base = recording.last(one.base, at_ns) if one.base in rest else None
        if base is not None:
            begin = min(begin, base.log_ns)
        recent = list(recording.messages(begin, at_ns, rest)) if rest else []
        seen = {message.topic for message in recent}
        before = [recording.last(topic, begin - 1) for topic in rest]
        older = [m for m in before if m is not None and m.topic not in seen]
        for message in sorted(older, key=lambda m: m.log_ns):
            one.take(message)
        for message in recent:
            one.take(message)
        if one.lacks():
            _look_further(recording, begin, rest, one)


def _look_further(
    recording: Bag, before_ns: int, topics: Sequence[str], one: Subscriber
) -> None:
    """Give a subscriber what is older than its depth, the newest first."""
    looked = 0
    for topic in topics:
        time = before_ns
        while one.lacks() and looked < MOST_OLDER:
            message = recording.last(topic, time - 1)
            if message is None:
                break
            time = message.log_ns
            for same_time in recording.messages(time, time, (topic,)):
                one.take_older(same_time)
                looked += 1

"""Several sources as one: recordings, robots, and both beside each other."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from sambot_viz.errors import Problem
from sambot_viz.sources.action_names import status_topic
from sambot_viz.sources.message import SourceTopic
from sambot_viz.sources.source import (
    Asset,
    Capability,
    Encoding,
    OnMessage,
    OnReply,
    Outgoing,
    OutgoingAction,
    Playback,
    Source,
    SourceStatus,
    no_file,
)

_MOST_NAMED = 3


def each_of(source: Source) -> Iterator[Source]:
    """Yield the sources that a user has named; one alone is its own."""
    if isinstance(source, JoinedSources):
        for part in source.parts:
            yield from each_of(part)
    else:
        yield source


class JoinedSources:
    """Hands on what several sources have; implements `Source`.

    A topic that several have is that of the first one.

    Args:
        parts: of which at most one can seek.
        is_shared: whether changes of the parts are told on; not of a session's view.
    """

    def __init__(self, parts: Sequence[Source], is_shared: bool = True) -> None:
        self.parts = tuple(parts)
        self.uri = " and ".join(part.uri for part in parts)
        self.on_topics: Callable[[], object] = lambda: None
        self.on_status: Callable[[], object] = lambda: None
        self._known: tuple[Sequence[object], Mapping[str, SourceTopic]] = ((), {})
        self._wanted: dict[tuple[str, OnMessage], OnMessage | None] = {}
        self._asked: dict[tuple[str, OnMessage], Source] = {}
        # Each part calls back in its own thread.
        self._lock = threading.RLock()
        if is_shared:
            for part in self.parts:
                part.on_topics = self._look
                part.on_status = self._tell_status

    def open(self) -> None:
        """Begin to connect; returns at once."""
        for part in self.parts:
            part.open()

    def close(self) -> None:
        """End all of them; may be called twice."""
        for part in self.parts:
            part.close()

    def of_session(self) -> Source:
        """Return it as one session sees it, with a time for what can seek."""
        if self.playback is None:
            return self
        return JoinedSources([one.of_session() for one in self.parts], is_shared=False)

    @property
    def status(self) -> SourceStatus:
        """The status of all: connected if one of the live sources is.

        Missing sources are named first.
        """
        parts = [part for part in self.parts if part.live is not None] or self.parts
        named = [(part.uri, part.status) for part in parts]
        every = [status for _, status in named]
        said = [
            f"{name}: {status.sentence}" if len(named) > 1 else status.sentence
            for name, status in sorted(named, key=lambda one: one[1].is_connected)
            if status.sentence
        ]
        pauses = [one.retry_s for one in every if one.retry_s is not None]
        lags = [one.lag_s for one in every if one.lag_s is not None]
        return SourceStatus(
            any(one.is_connected for one in every),
            "; ".join(said),
            min(pauses, default=None),
            max(lags, default=None),
            sum(one.dropped for one in every),
            sum(one.unreadable for one in every),
            sum(one.session for one in every),
            all(one.is_connected for one in every),
            sum(one.received for one in every),
        )

    @property
    def capabilities(self) -> frozenset[Capability]:
        """What one of them can do."""
        return frozenset[Capability]().union(*(p.capabilities for p in self.parts))

    @property
    def playback(self) -> Playback | None:
        """The time of what can seek; None without."""
        found = (part.playback for part in self.parts)
        return next((one for one in found if one is not None), None)

    @property
    def live(self) -> Source | None:
        """What has a clock; None without."""
        found = [part.live for part in self.parts]
        if all(one is not None for one in found):
            return self
        return next((one for one in found if one is not None), None)

    def topics(self) -> Mapping[str, SourceTopic]:
        """Return the topics of all by name."""
        parts = [part.topics() for part in self.parts]
        known, joined = self._known
        if len(known) != len(parts) or any(
            one is not other for one, other in zip(known, parts, strict=True)
        ):
            joined = {n: t for topics in reversed(parts) for n, t in topics.items()}
            self._known = parts, joined
        return joined

    @property
    def hidden(self) -> tuple[Problem, ...]:
        """The hidden topics, and the sources that hide them."""
        return hidden_topics([(part.uri, part.topics()) for part in self.parts])

    def subscribe(
        self, topic: str, callback: OnMessage, on_kept: OnMessage | None = None
    ) -> None:
        """Call back with each message of a topic; see `Source.subscribe`."""
        with self._lock:
            self._wanted.setdefault((topic, callback), on_kept)
            self._ask(topic, callback)

    def unsubscribe(self, topic: str, callback: OnMessage) -> None:
        """No longer call back."""
        with self._lock:
            self._wanted.pop((topic, callback), None)
            part = self._asked.pop((topic, callback), None)
        if part is not None:
            part.unsubscribe(topic, callback)

    @property
    def has_clock(self) -> bool:
        """Whether a peer has told its time."""
        return any(part.has_clock for part in self.parts)

    def clock_ns(self) -> int:
        """Return the time of the first robot, or that of the recording [ns]."""
        first = next((p for p in self.parts if p.live is not None), self.parts[0])
        return first.clock_ns()

    def fetch_asset(self, uri: str) -> Asset:
        """Request a file from the first source that serves files."""
        for part in self.parts:
            if "files" in part.capabilities:
                return part.fetch_asset(uri)
        return no_file(f"{self.uri}: none of them hands out files, and not {uri}")

    def advertise(self, topic: str, type_name: str) -> Outgoing:
        """Begin to publish a topic at the robot that has it, or at the first one."""
        return self._robot_of(topic).advertise(topic, type_name)

    def call(
        self, service: str, write: Callable[[Encoding], bytes], answered: OnReply
    ) -> None:
        """Call a service of the robot whose topics are called so, or of the first."""
        self._robot_of(service).call(service, write, answered)

    def action(self, name: str, type_name: str) -> OutgoingAction:
        """Return an action of the robot whose topics are called so, or of the first."""
        return self._robot_of(status_topic(name)).action(name, type_name)

    def _robot_of(self, name: str) -> Source:
        """Return the robot that has a topic, or else topics of its name space."""
        robots = [part for part in self.parts if part.live is not None] or self.parts
        has = next((one for one in robots if name in one.topics()), None)
        if has is not None:
            return has
        space = f"/{name.split('/')[1]}/"
        near = (r for r in robots if any(t.startswith(space) for t in r.topics()))
        return next(near, robots[0])

    def _ask(self, topic: str, callback: OnMessage) -> None:
        """Subscribe at the part that has a topic, now or when it comes."""
        part = next((one for one in self.parts if topic in one.topics()), None)
        before = self._asked.get((topic, callback))
        if part is None or part is before:
            return
        if before is not None:
            before.unsubscribe(topic, callback)
        self._asked[topic, callback] = part
        part.subscribe(topic, callback, self._wanted[topic, callback])

    def _look(self) -> None:
        with self._lock:
            for topic, callback in list(self._wanted):
                self._ask(topic, callback)
            self.on_topics()

    def _tell_status(self) -> None:
        self.on_status()


def hidden_topics(
    parts: Iterable[tuple[str, Iterable[str]]],
) -> tuple[Problem, ...]:
    """Say which source hides topics of which other one.

    Args:
        parts: the name of each, and its topics; those of the first ones are shown.
    """
    return tuple(_hidden(list(parts)))


def _hidden(parts: Sequence[tuple[str, Iterable[str]]]) -> Iterator[Problem]:
    owner: dict[str, str] = {}
    for name, topics in parts:
        hidden: dict[str, list[str]] = {}
        for topic in sorted(topics):
            if owner.setdefault(topic, name) != name:
                hidden.setdefault(owner[topic], []).append(topic)
        for first, found in hidden.items():
            listed = ", ".join(found[:_MOST_NAMED])
            more = f" and {len(found) - _MOST_NAMED} more" * (len(found) > _MOST_NAMED)
            hide = "hides" if len(found) == 1 else "hide"
            called = name if name.isidentifier() else "other"
            yield Problem(
                "warning",
                "topic-hidden",
                f"{listed}{more} of {first} {hide} the same of {name}",
                "give that source a name and a prefix: --source "
                f"{called}=URI --source-prefix {called}=robot2",
            )

"""What a session says of the topics of a robot on the network."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from typing import Any

from sambot_viz.errors import DecodeError
from sambot_viz.frames import LookupRefused
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.worker import Worker
from sambot_viz.sources.message import Recorded, SourceTopic
from sambot_viz.topics import reasons
from sambot_viz.topics.contents import content_reason
from sambot_viz.topics.live_reasons import (
    no_publisher,
    not_listened,
    qos_words,
    silent,
    stopped,
    unreadable,
)
from sambot_viz.topics.reasons import TopicReason, left_out
from sambot_viz.topics.report import TopicStatus
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.topic import Topic

PERIOD = 1.0
"""So often what is said of topics is looked at again [s]."""
SILENT_AFTER = 5.0
"""A topic of which nothing has come for so long is said to be silent [s]."""
FaultOf = Callable[[str], LookupRefused | None]
_LARGE = re.compile(r"(Image|PointCloud2?|Video|Packet\w*)$")
"""Types of messages that would fill a wireless network."""


class LiveTopics:
    """Listens to the topics whose rows are on the screen, and says what came of them.

    One connection serves all sessions: what others listen to as well costs it nothing
    more. Large messages are left alone until somebody chooses their row.

    Args:
        live: the robot.
        fault_of: says why a frame has no place in the picture; None when it has one.
        change: tells what is said.
        worker: looks at the messages.

    Attributes:
        nothing: what to say without any topic.
        looked: told when something else is to be said.
    """

    nothing = "No topic is published yet"
    is_complete = True

    def __init__(
        self, live: SourceRobot, fault_of: FaultOf, change: Change, worker: Worker
    ) -> None:
        self.looked = Signal(change, None)
        self._fault_of = fault_of
        self._ticked = Signal(change, None)
        self._live = live
        self._source = live.source.live or live.source
        self._worker = worker
        self._known: Mapping[str, SourceTopic] = {}
        self._known_of: object = None
        self._names: Sequence[str] = ()
        self._viewers: dict[object, tuple[Collection[str], str]] = {}
        self._heard: dict[str, _Heard] = {}
        # The thread of the source adds messages.
        self._lock = threading.Lock()
        self._said: dict[str, str] = {}
        self._is_ticking = False
        self._tell = partial(worker.post, self.looked.touch)
        live.on_topics.append(self._tell)

    @property
    def names(self) -> Sequence[str]:
        """The names of the topics that there are now, sorted."""
        known, hidden = self._source.topics(), self._live.has_recorded
        if self._known_of is not known:
            self._known_of = known
            self._known = {n: t for n, t in known.items() if not hidden(n)}
            self._names = sorted(self._known)
        return self._names

    @property
    def remade_by(self) -> Sequence[Signal[Any]]:
        """After these something else is to be said."""
        return (self.looked,)

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """After these rates and ages are others."""
        return (self._ticked,)

    def follow(
        self, viewer: object, names: Collection[str] | None, chosen: str = ""
    ) -> None:
        """Listen to topics for a viewer, and to no others for it.

        Args:
            viewer: who sees them.
            names: of the topics; None when they are no longer on the screen.
            chosen: the one that may be large.
        """
        if names is None:
            self._viewers.pop(viewer, None)
        else:
            self._viewers[viewer] = (names, chosen)
        self._listen()
        if self._viewers and not self._is_ticking:
            self._is_ticking = True
            self._worker.post_later(PERIOD, self._tick)

    def close(self) -> None:
        """Listen to nothing more."""
        self._live.on_topics.remove(self._tell)
        self._viewers.clear()
        self._listen()

    def status(self, name: str) -> TopicStatus:
        """Return what is to be said of a topic."""
        topic = self._known[name]
        decoder = self._live.decoder(topic)
        heard = self._heard.get(name)
        reason = unreadable(topic)
        if reason is None and decoder.reason is not None:
            reason = TopicReason(decoder.reason.code, decoder.reason.text)
        readable = reason is None
        if topic.left_out:
            reason = reason or left_out(topic.left_out)
        reason = reason or self._reason(topic, heard)
        self._said[name] = "" if reason is None else reason.code
        type_name = decoder.type_name or topic.schema.name
        count, rate = self.count(name), self.rate(name)
        return TopicStatus(name, type_name, count, rate, readable, reason)

    def count(self, name: str) -> int | None:
        """Return how many messages have come; None for a topic nobody listens to."""
        heard = self._heard.get(name)
        return None if heard is None else heard.topic.count

    def rate(self, name: str) -> float | None:
        """Return how often messages come [Hz]; None when there are less than two.

        Latched messages come when somebody asks for them: they have none.
        """
        heard = self._heard.get(name)
        known = self._known.get(name)
        if heard is None or known is None or known.is_latched:
            return None
        with self._lock:
            return heard.topic.rate(self._source.clock_ns())

    def age(self, name: str) -> float | None:
        """Return how long ago the last message came [s]; None before the first."""
        heard = self._heard.get(name)
        return None if heard is None else heard.topic.age(self._source.clock_ns())

    def facts(self, name: str) -> Mapping[str, str]:
        """Return what the robot says of a topic: who publishes it, and how."""
        topic, told = self._known[name], dict[str, str]()
        if topic.publishers is not None:
            names = topic.publishers
            told["Publishers"] = (
                str(names) if isinstance(names, int) else ", ".join(names) or "none"
            )
        if topic.qos is not None:
            told["QoS"] = qos_words(topic.qos)
        return told

    # In the worker

    def _tick(self) -> None:
        self._is_ticking = bool(self._viewers)
        if self._is_ticking:
            self._look_again()
            self._ticked.touch()
            self._worker.post_later(PERIOD, self._tick)

    def _look_again(self) -> None:
        """Tell all viewers when something else is to be said of a topic than before."""
        self._listen()
        named = {name for names, _ in self._viewers.values() for name in names}
        shown = named & self._known.keys()
        before = {name: self._said.get(name) for name in shown}
        for name in shown:
            self.status(name)
        if any(self._said[name] != code for name, code in before.items()):
            self.looked.touch()

    def _listen(self) -> None:
        """Subscribe to what viewers see, and to nothing else."""
        source, known = self._source, self._known
        wanted = {
            name
            for names, chosen in self._viewers.values()
            for name in names
            if name in known
            and known[name].reason is None
            and (name == chosen or not _LARGE.search(known[name].schema.name))
        }
        for name in [name for name in self._heard if name not in wanted]:
            source.unsubscribe(name, self._receive)
            del self._heard[name]
        for name in sorted(wanted - self._heard.keys()):
            topic = known[name]
            self._heard[name] = _Heard(
                Topic(name, topic.schema, topic.message_encoding),
                self._worker.clock.now(),
            )
            source.subscribe(name, self._receive, self._receive_kept)

    def _reason(self, topic: SourceTopic, heard: _Heard | None) -> TopicReason | None:
        """Return the first reason that holds for a topic that can be read."""
        if not self._source.status.is_connected:
            # The line below the view says it, for all of them.
            return None
        if (nobody := no_publisher(topic.name, topic.publishers)) is not None:
            return nobody
        if heard is None:
            return not_listened() if _LARGE.search(topic.schema.name) else None
        last = heard.topic.last
        if last is None:
            waited = self._worker.clock.now() - heard.since
            return silent(topic.name) if waited > SILENT_AFTER else None
        if last is not heard.looked:
            heard.looked = last
            self._look(heard, last)
        return heard.reason or self._of_frame(heard) or self._stale(topic, heard)

    def _of_frame(self, heard: _Heard) -> TopicReason | None:
        refused = self._fault_of(heard.frame) if heard.frame else None
        if refused is None:
            return None
        return reasons.no_transform(heard.frame, refused.target, refused)

    def _look(self, heard: _Heard, message: Recorded) -> None:
        heard.reason, heard.frame = None, ""
        try:
            decoded = self._live.decoding.decode(message)
        except DecodeError as error:
            heard.reason = reasons.not_decodable(
                1, 1, str(error), is_all=False, is_live=True
            )
            return
        header = getattr(decoded, "header", None)
        if header is not None and message.topic not in self._live.topics.all:
            heard.frame = plain_name(str(getattr(header, "frame_id", "")))
        heard.reason = content_reason(decoded)

    def _stale(self, topic: SourceTopic, heard: _Heard) -> TopicReason | None:
        age, period = self.age(topic.name), heard.topic.period
        if topic.is_latched or age is None or period is None:
            return None
        return stopped() if age > max(reasons.STALE, 3 * period) else None

    # In the thread of the source

    def _receive(self, message: Recorded) -> None:
        heard = self._heard.get(message.topic)
        if heard is not None:
            with self._lock:
                heard.topic.take(message)

    def _receive_kept(self, message: Recorded) -> None:
        """Take a message that came before; it says nothing of the rate."""
        heard = self._heard.get(message.topic)
        if heard is not None:
            with self._lock:
                heard.topic.keep(message)


class _Heard:
    """What has come of a topic since somebody listens to it.

    Attributes:
        topic: counts the messages.
        since: when that began, by the clock of the session [s].
        looked: the message that was decoded last.
        reason: what is wrong with it.
        frame: of its header; "" without.
    """

    def __init__(self, topic: Topic, since: float) -> None:
        self.topic = topic
        self.since = since
        self.looked: Recorded | None = None
        self.reason: TopicReason | None = None
        self.frame = ""

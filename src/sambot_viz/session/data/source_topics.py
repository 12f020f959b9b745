"""What a session says of the topics of its sources."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from typing import Any

from sambot_viz.frames import FrameTree, LookupRefused
from sambot_viz.session.data.player import Player
from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.session.worker import Worker
from sambot_viz.sources.message import SourceTopic
from sambot_viz.topics import reasons
from sambot_viz.topics.heard import Heard
from sambot_viz.topics.live_reasons import (
    no_publisher,
    not_listened,
    qos_words,
    silent,
    stopped,
    unreadable,
)
from sambot_viz.topics.reasons import TopicReason, left_out
from sambot_viz.topics.report import TopicReport, TopicStatus
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.survey import Survey

PERIOD = 1.0
"""So often what is said of topics that are listened to is looked at again [s]."""
SILENT_AFTER = 5.0
"""A topic of which nothing has come for so long is said to be silent [s]."""
SLICE = 0.01
"""So long messages of a recording are looked at before others get their turn [s]."""
PAUSE = 0.01
"""The time that others get [s]."""
FaultOf = Callable[[str], LookupRefused | None]
_LARGE = re.compile(r"(Image|PointCloud2?|Video|Packet\w*)$")
"""Types of messages that would fill a wireless network."""


class SourceTopics:
    """Looks at the topics that somebody sees, and says what each of them has.

    The first messages of what can seek are looked at once. To what comes by itself it
    listens while its rows are on the screen; large messages are left alone until
    somebody chooses their row. One connection serves all sessions: what others listen
    to as well costs it nothing more.

    Args:
        moved_by: the sources.
        tree: the frames at the time of the player.
        player: its time is that of the ages; None without what can seek.
        fault_of: says why a frame has no place in the picture; None when it has one.
        change: tells what is said.
        worker: looks at the messages.

    Attributes:
        looked: told when something else is to be said.
    """

    def __init__(
        self,
        moved_by: SourceRobot,
        tree: FrameTree,
        player: Player | None,
        fault_of: FaultOf,
        change: Change,
        worker: Worker,
    ) -> None:
        self.looked = Signal(change, None)
        self._ticked = Signal(change, None)
        self._moved_by = moved_by
        self._live = moved_by.source.live
        self._player = player
        self._fault_of = fault_of
        self._worker = worker
        self._known: Mapping[str, SourceTopic] = {}
        self._names: Sequence[str] = ()
        self._viewers: dict[object, tuple[Collection[str], str]] = {}
        self._heard: dict[str, Heard] = {}
        self._said: dict[str, str] = {}
        self._is_ticking = False
        self._begins: dict[str, int] = {}
        self._is_surveyed = False
        self._report: TopicReport | None = None
        self._survey: Survey | None = None
        if player is not None:
            self._survey = Survey(moved_by)
            self._report = TopicReport(self._survey, tree)
            connect([player.stepped, player.playback], self._look_at_begins)
        self._tell = partial(worker.post, self.looked.touch)
        moved_by.on_topics.append(self._tell)

    @property
    def nothing(self) -> str:
        """What to say without any topic."""
        is_live = self._live is not None
        return "No topic is published yet" if is_live else "The recording has no topic"

    @property
    def names(self) -> Sequence[str]:
        """The names of the topics that there are now, sorted."""
        known = self._moved_by.source.topics()
        if self._known is not known:
            self._known, self._names = known, sorted(known)
            if self._report is not None:
                self._report.refresh()
        return self._names

    @property
    def is_complete(self) -> bool:
        """Whether all messages that are looked at at all were."""
        return self._survey is None or self._survey.is_complete

    @property
    def remade_by(self) -> Sequence[Signal[Any]]:
        """After these something else is to be said."""
        player = self._player
        return (self.looked,) if player is None else (self.looked, player.playback)

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """After these rates and ages are others."""
        player = self._player
        of_time = () if player is None else (player.stepped, player.playback)
        return of_time if self._live is None else (*of_time, self._ticked)

    def follow(
        self, viewer: object, names: Collection[str] | None, chosen: str = ""
    ) -> None:
        """Look at topics for a viewer, in the session's worker.

        Args:
            viewer: who sees them.
            names: of the topics; None when they are no longer on the screen.
            chosen: the one that may be large.
        """
        if names is None:
            self._viewers.pop(viewer, None)
        else:
            self._viewers[viewer] = (names, chosen)
        if self._viewers and self._survey is not None and not self._is_surveyed:
            self._is_surveyed = True
            self._worker.post(partial(self._step, self._survey))
        if self._live is not None:
            self._listen()
            if self._viewers and not self._is_ticking:
                self._is_ticking = True
                self._worker.post_later(PERIOD, self._tick)

    def close(self) -> None:
        """Look at nothing more."""
        self._moved_by.on_topics.remove(self._tell)
        self._viewers.clear()
        self._listen()
        if self._survey is not None:
            self._survey.is_complete = True

    def status(self, name: str) -> TopicStatus:
        """Return what is to be said of a topic now."""
        if (recorded := self._recorded(name)) is not None:
            report, player = recorded
            status = report.status(name, player.time_ns, ages=False)
            reason, begin = status.reason, report.first_ns(name)
            if (
                reason is not None
                and reason.code == "not-here-yet"
                and begin is not None
            ):
                self._begins[name] = begin
            return status
        topic = self._known[name]
        decoder = self._moved_by.decoder(topic)
        reason = unreadable(topic)
        if reason is None and decoder.reason is not None:
            reason = TopicReason(decoder.reason.code, decoder.reason.text)
        readable = reason is None
        if topic.left_out:
            reason = reason or left_out(topic.left_out)
        reason = reason or self._reason(topic, self._heard.get(name))
        self._said[name] = "" if reason is None else reason.code
        type_name = decoder.type_name or topic.schema.name
        count, rate = self.count(name), self.rate(name)
        return TopicStatus(name, type_name, count, rate, readable, reason)

    def count(self, name: str) -> int | None:
        """Return how many messages there are, or came; None while not known."""
        if (heard := self._heard.get(name)) is not None:
            return heard.count
        topic = self._known.get(name)
        return None if topic is None else topic.count

    def rate(self, name: str) -> float | None:
        """Return how often messages come [Hz]; None when there are less than two.

        Latched messages come when somebody asks for them: they have none.
        """
        if (recorded := self._recorded(name)) is not None:
            return recorded[0].rate(name)
        heard, live = self._heard.get(name), self._live
        topic = self._known.get(name)
        if heard is None or live is None or topic is None or topic.is_latched:
            return None
        return heard.rate(live.clock_ns())

    def age(self, name: str) -> float | None:
        """Return how long ago the last message came [s]; None before the first.

        That of a recording comes from the index, nothing is decoded.
        """
        if (recorded := self._recorded(name)) is not None:
            report, player = recorded
            last = report.last_ns(name, player.time_ns)
            return None if last is None else max(0, player.time_ns - last) * 1e-9
        heard, live = self._heard.get(name), self._live
        return None if heard is None or live is None else heard.age(live.clock_ns())

    def facts(self, name: str) -> Mapping[str, str]:
        """Return what else is known of a topic: who publishes it, and how."""
        topic, told = self._known[name], dict[str, str]()
        if topic.publishers is not None:
            names = topic.publishers
            told["Publishers"] = (
                str(names) if isinstance(names, int) else ", ".join(names) or "none"
            )
        if topic.qos is not None and (words := qos_words(topic.qos)):
            told["QoS"] = words
        return told

    # What can seek

    def _recorded(self, name: str) -> tuple[TopicReport, Player] | None:
        """Return what knows a topic of a recording; None for one that comes live."""
        report, player = self._report, self._player
        if report is None or player is None or name not in player.recording.topics:
            return None
        return report, player

    def _look_at_begins(self) -> None:
        """Tell when topics have begun of which it was said that they are to come."""
        now = 0 if self._player is None else self._player.time_ns
        if any(begin <= now for begin in self._begins.values()):
            self._begins.clear()
            self.looked.touch()

    def _step(self, survey: Survey) -> None:
        """Look at a few messages more; runs in the worker."""
        try:
            end = time.perf_counter() + SLICE
            while time.perf_counter() < end:
                if not survey.step():
                    self.looked.touch()
                    return
        except Exception:
            # Whatever a file does to it, the rest of the page goes on.
            survey.is_complete = True
            self.looked.touch()
            raise
        self._worker.post_later(PAUSE, partial(self._step, survey))

    # What comes by itself, in the worker

    def _tick(self) -> None:
        self._is_ticking = bool(self._viewers)
        if self._is_ticking:
            self._look_again()
            self._ticked.touch()
            self._worker.post_later(PERIOD, self._tick)

    def _look_again(self) -> None:
        """Tell all viewers when something else is to be said of a topic than before."""
        self._listen()
        before = {name: self._said.get(name) for name in self._seen()}
        for name in before:
            self.status(name)
        if any(self._said[name] != code for name, code in before.items()):
            self.looked.touch()

    def _seen(self) -> set[str]:
        """Return the topics that viewers see, of those that come by themselves."""
        named = {name for names, _ in self._viewers.values() for name in names}
        has_recorded = self._moved_by.has_recorded
        return {n for n in named & self._known.keys() if not has_recorded(n)}

    def _listen(self) -> None:
        """Subscribe to what viewers see, and to nothing else."""
        live, known = self._live, self._known
        if live is None:
            return
        chosen = {chosen for _, chosen in self._viewers.values()}
        wanted = {
            name
            for name in self._seen()
            if known[name].reason is None
            and (name in chosen or not _is_large(known[name]))
        }
        for name in [name for name in self._heard if name not in wanted]:
            live.unsubscribe(name, self._heard.pop(name).take)
        for name in sorted(wanted - self._heard.keys()):
            heard = self._heard[name] = Heard(self._worker.clock.now())
            live.subscribe(name, heard.take, heard.keep)

    def _reason(self, topic: SourceTopic, heard: Heard | None) -> TopicReason | None:
        """Return the first reason that holds for a topic that can be read."""
        if self._live is None or not self._live.status.is_connected:
            # The line below the view says it, for all of them.
            return None
        if (nobody := no_publisher(topic.name, topic.publishers)) is not None:
            return nobody
        if heard is None:
            return not_listened() if _is_large(topic) else None
        if heard.last is None:
            waited = self._worker.clock.now() - heard.since
            return silent(topic.name) if waited > SILENT_AFTER else None
        of_robot = topic.name in self._moved_by.topics.all
        heard.look(self._moved_by.decoding, is_placed=not of_robot)
        return heard.reason or self._of_frame(heard) or self._stale(topic, heard)

    def _of_frame(self, heard: Heard) -> TopicReason | None:
        refused = self._fault_of(heard.frame) if heard.frame else None
        if refused is None:
            return None
        return reasons.no_transform(heard.frame, refused.target, refused)

    def _stale(self, topic: SourceTopic, heard: Heard) -> TopicReason | None:
        age, period = self.age(topic.name), heard.period
        if topic.is_latched or age is None or period is None:
            return None
        return stopped() if age > max(reasons.STALE, 3 * period) else None


def _is_large(topic: SourceTopic) -> bool:
    return _LARGE.search(topic.schema.name) is not None

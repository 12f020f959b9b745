"""The accounts of a session's topics, as its pages show them."""

from __future__ import annotations

import sys
import time
from collections.abc import Collection, Mapping, Sequence
from functools import partial
from typing import Any

from sambot_viz.session.data.player import Player
from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.session.worker import Worker
from sambot_viz.sources.message import SourceTopic
from sambot_viz.topics import reasons
from sambot_viz.topics.account import Account, DrawingOf, account_of, unheard
from sambot_viz.topics.ends import ends_of
from sambot_viz.topics.heard import Heard
from sambot_viz.topics.live_evidence import LiveEvidence, is_large
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.report import TopicReport
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.survey import Survey

PERIOD = 1.0
"""Period of the accounts of live topics [s]."""
SLICE = 0.01
"""So long messages of a recording are looked at before others get their turn [s]."""
PAUSE = 0.01
"""The time that others get [s]."""
NEVER = sys.maxsize


class SourceTopics:
    """Inspects the topics on the screen, and gives the account of each.

    The first messages of a recording are read once. A live topic is subscribed to while
    its row is on the screen; one with large messages only while its row is selected.
    One connection serves all sessions, so a second subscriber costs nothing more.

    Args:
        moved_by: the sources.
        report: the report about recordings; None without any.
        live: the facts about live topics.
        drawing_of: returns what displays do with a topic.
        player: gives the time for ages; None without a recording.
        change: sends the accounts.
        worker: reads the messages.

    Attributes:
        looked: emitted when an account has changed.
    """

    def __init__(
        self,
        moved_by: SourceRobot,
        report: TopicReport | None,
        live: LiveEvidence,
        drawing_of: DrawingOf,
        player: Player | None,
        change: Change,
        worker: Worker,
    ) -> None:
        self.looked = Signal(change, None)
        self._ticked = Signal(change, None)
        self._moved_by = moved_by
        self._live = moved_by.source.live
        self._player = player
        self._evidence = live
        self._drawing_of = drawing_of
        self._worker = worker
        self._known: Mapping[str, SourceTopic] = {}
        self._names: Sequence[str] = ()
        self._viewers: dict[object, tuple[Collection[str], str]] = {}
        self._heard = live.own
        self._said: dict[str, str] = {}
        self._is_ticking = False
        # Topic → what was said of it, and the log time from which that may be wrong.
        self._until: dict[str, tuple[TopicReason | None, int]] = {}
        self._is_surveyed = self._is_closed = False
        self._report = report
        self._survey = None if report is None else report.survey
        if player is not None:
            connect([player.stepped, player.playback], self._look_at_until)
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
        """Inspect topics for a viewer, in the session's worker.

        Args:
            viewer: the viewer that has them on the screen.
            names: the names of the topics; None when they have left the screen.
            chosen: the selected topic, which may have large messages.
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
        self._is_closed = True
        self._moved_by.on_topics.remove(self._tell)
        self._viewers.clear()
        self._listen()
        if self._survey is not None:
            self._survey.is_complete = True

    def finish(self) -> None:
        """Look at once at all messages of what can seek that are looked at at all."""
        if self._survey is not None and not self._survey.is_complete:
            self._survey.finish()
            self.looked.touch()

    def account(self, name: str) -> Account:
        """Return the present account of a topic."""
        if (recorded := self._recorded(name)) is not None:
            made, until = self._of_recorded(name, *recorded)
            self._until[name] = made.reason, until
            return made
        live, count, rate = self._evidence, self.count(name), self.rate(name)
        drawing = self._drawing_of(name, live.decoder(name).type_name)
        made = account_of(live, name, count, rate, drawing)
        self._said[name] = "" if made.reason is None else made.reason.code
        return made

    def reason(self, name: str) -> TopicReason | None:
        """Return why a topic shows nothing, or a note about it.

        `looked` is emitted when that changes.
        """
        recorded = self._recorded(name)
        if self._is_closed:
            return None
        if recorded is None:
            return self.account(name).reason
        made, until = self._of_recorded(name, *recorded)
        # What others were told before is still to be told again.
        self._until.setdefault(name, (made.reason, until))
        return made.reason

    def unheard(self, name: str) -> TopicReason | None:
        """Return why a topic gives displays nothing, or not all that it should."""
        recorded = self._recorded(name)
        return unheard(self._evidence if recorded is None else recorded[0], name)

    def count(self, name: str) -> int | None:
        """Return how many messages there are, or came; None while not known."""
        if (heard := self._any_heard(name)) is not None:
            return heard.count
        topic = self._known.get(name)
        return None if topic is None else topic.count

    def rate(self, name: str) -> float | None:
        """Return the rate of messages [Hz]; None for fewer than two.

        Latched messages come with a subscription: they have no rate.
        """
        if (recorded := self._recorded(name)) is not None:
            return recorded[0].rate(name)
        heard, live = self._any_heard(name), self._live
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
        heard, live = self._any_heard(name), self._live
        return None if heard is None or live is None else heard.age(live.clock_ns())

    def facts(self, name: str) -> Mapping[str, str]:
        """Return what else is known of a topic: who has it, and how."""
        topic, told = self._known[name], dict[str, str]()
        ends = [*ends_of(topic)]
        if topic.publishers is not None:
            named = [str(one) for one in ends if one.publishes]
            count = topic.publishers if isinstance(topic.publishers, int) else 0
            told["Publishers"] = "; ".join(named) or str(count or "none")
        if named := [str(one) for one in ends if not one.publishes]:
            told["Subscribers"] = "; ".join(named)
        if topic.qos is not None and (words := reasons.qos_words(topic.qos)):
            told["QoS"] = words
        return told

    # What can seek

    def _recorded(self, name: str) -> tuple[TopicReport, Player] | None:
        """Return the report about a topic of a recording; None for a live topic."""
        report, player = self._report, self._player
        if report is None or player is None or name not in player.recording.topics:
            return None
        report.at_ns = player.time_ns
        return report, player

    def _of_recorded(
        self, name: str, report: TopicReport, player: Player
    ) -> tuple[Account, int]:
        """Return an account, and the log time until which it holds [ns]."""
        made = report.account(name, self._drawing_of)
        return made, self._holds_until(made, report, player)

    def _holds_until(
        self, account: Account, report: TopicReport, player: Player
    ) -> int:
        """Return the log time until which nothing else is to be said of a topic."""
        code, now = account.reason and account.reason.code, player.time_ns
        name, rate = account.name, account.rate
        if code == "not-here-yet":
            return report.first_ns(name) or NEVER
        if code in ("stale", "ended"):
            coming = player.recording.next(name, now)
            return NEVER if coming is None else coming.log_ns
        last = report.last_ns(name, now)
        if rate is None or last is None:
            return NEVER
        longest = max(reasons.STALE, reasons.PERIODS / rate)
        return max(now, last) + round(longest * 1e9)

    def _look_at_until(self) -> None:
        """Tell when topics have begun, or have fallen silent."""
        now = 0 if self._player is None else self._player.time_ns
        due = [n for n, (_, until) in self._until.items() if until <= now]
        before = [self._until[name][0] for name in due]
        if [self.account(name).reason for name in due] != before:
            self.looked.touch()

    def _step(self, survey: Survey) -> None:
        """Look at a few messages more; runs in the worker."""
        try:
            end = time.perf_counter() + SLICE
            while time.perf_counter() < end:
                if survey.is_complete or not survey.step():
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
            self.account(name)
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
            and (name in chosen or not is_large(known[name]))
        }
        for name in [name for name in self._heard if name not in wanted]:
            live.unsubscribe(name, self._heard.pop(name).take)
        for name in sorted(wanted - self._heard.keys()):
            heard = self._heard[name] = Heard(self._worker.clock.now())
            live.subscribe(name, heard.take, heard.keep)

    def _any_heard(self, name: str) -> Heard | None:
        """Return what has come by itself of a topic, whoever has listened."""
        if self._moved_by.has_recorded(name):
            return None
        return self._evidence.heard(name)

"""What a session says of the topics of its recording."""

from __future__ import annotations

import time
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from sambot_viz.frames import FrameTree
from sambot_viz.session.data.player import Player
from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.session.worker import Worker
from sambot_viz.topics.report import TopicReport, TopicStatus
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.survey import Survey

SLICE = 0.01
"""Messages are looked at for so long before others get their turn [s]."""
PAUSE = 0.01
"""The time that others get [s]."""


class RecordedTopics:
    """Looks at the first messages of all topics, once somebody wants to know.

    Args:
        recorded: the recording.
        tree: the frames at the time of the player.
        player: its time is that of the ages.
        change: tells what is said.
        worker: looks at the messages.

    Attributes:
        nothing: what to say without any topic.
        report: what is to be said of each topic.
        looked: told when all messages were looked at, and when topics have begun.
    """

    nothing = "The recording has no topic"

    def __init__(
        self,
        recorded: SourceRobot,
        tree: FrameTree,
        player: Player,
        change: Change,
        worker: Worker,
    ) -> None:
        self.looked = Signal(change, None)
        self._player = player
        self._begins: dict[str, int] = {}
        self._survey = Survey(recorded)
        self.recording = self._survey.recording
        self.report = TopicReport(self._survey, tree)
        self._worker = worker
        self._begun = False
        self._names: list[str] = []
        connect(self.moved_by, self._look_again)

    @property
    def names(self) -> Sequence[str]:
        """The names of the topics; those of a growing recording become more."""
        topics = self.recording.topics
        if len(self._names) != len(topics):
            self.report.refresh()
            self._names = sorted(topics)
        return self._names

    def has(self, name: str) -> bool:
        """Return whether a topic is one of the recording."""
        return name in self.recording.topics

    @property
    def is_complete(self) -> bool:
        """Whether all messages that are looked at at all were."""
        return self._survey.is_complete

    @property
    def remade_by(self) -> Sequence[Signal[Any]]:
        """After these something else is to be said."""
        return (self.looked, self._player.playback)

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """After these the ages are others."""
        return (self._player.stepped, self._player.playback)

    def follow(
        self, viewer: object, names: Collection[str] | None, chosen: str = ""
    ) -> None:
        """Look at the messages for a viewer, in the session's worker, a few at a time.

        Args:
            viewer: who sees the topics.
            names: of the topics, of which all are looked at; None when they are no
                longer on the screen.
            chosen: the one that is selected.
        """
        del viewer, chosen
        if names is not None and not self._begun:
            self._begun = True
            self._worker.post(self._step)

    def status(self, name: str) -> TopicStatus:
        """Return what is to be said of a topic at the player's time."""
        status = self.report.status(name, self._player.time_ns, ages=False)
        reason, begin = status.reason, self.report.first_ns(name)
        if reason is not None and reason.code == "not-here-yet" and begin is not None:
            self._begins[name] = begin
        return status

    def count(self, name: str) -> int | None:
        """Return how many messages there are; None while that is not known."""
        return self.recording.topics[name].count

    def rate(self, name: str) -> float | None:
        """Return how often messages come [Hz]; None when there are less than two."""
        return self.report.rate(name)

    def age(self, name: str) -> float | None:
        """Return how long ago the last message came [s]; None before the first.

        It comes from the index, nothing is decoded.
        """
        now = self._player.time_ns
        last = self.report.last_ns(name, now)
        return None if last is None else max(0, now - last) * 1e-9

    def facts(self, name: str) -> Mapping[str, str]:
        """Return what else is known of a topic."""
        del name
        return {}

    def close(self) -> None:
        """Look at nothing more."""
        self._survey.is_complete = True

    def _look_again(self) -> None:
        """Tell when topics have begun of which it was said that they are to come."""
        now = self._player.time_ns
        if any(begin <= now for begin in self._begins.values()):
            self._begins.clear()
            self.looked.touch()

    def _step(self) -> None:
        try:
            end = time.perf_counter() + SLICE
            while time.perf_counter() < end:
                if not self._survey.step():
                    self.looked.touch()
                    return
        except Exception:
            # Whatever a file does to it, the rest of the page goes on.
            self._survey.is_complete = True
            self.looked.touch()
            raise
        self._worker.post_later(PAUSE, self._step)

"""What a session says of the topics of its recording."""

from __future__ import annotations

import time
from collections.abc import Sequence

from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.worker import Worker
from sambot_viz.topics.recorded_robot import RecordedRobot
from sambot_viz.topics.report import TopicReport
from sambot_viz.topics.survey import Survey

SLICE = 0.01
"""Messages are looked at for so long before others get their turn [s]."""
PAUSE = 0.01
"""The time that others get [s]."""


class RecordedTopics:
    """Looks at the first messages of all topics, once somebody wants to know.

    Args:
        recorded: the recording.

    Attributes:
        report: what is to be said of each topic.
        names: of the topics, sorted.
        looked: told when all messages were looked at.
        is_complete: they were.
    """

    def __init__(self, recorded: RecordedRobot, change: Change, worker: Worker) -> None:
        self.recording = recorded.recording
        self.looked = Signal(change, None)
        self._survey = Survey(recorded)
        self.report = TopicReport(self._survey)
        self._worker = worker
        self._begun = False
        self._names: list[str] = []

    @property
    def names(self) -> Sequence[str]:
        """The names of the topics; those of a growing recording become more."""
        topics = self.recording.topics
        if len(self._names) != len(topics):
            self.report.refresh()
            self._names = sorted(topics)
        return self._names

    @property
    def is_complete(self) -> bool:
        """Whether all messages that are looked at at all were."""
        return self._survey.is_complete

    def begin(self) -> None:
        """Look at the messages, in the session's worker, a few at a time."""
        if not self._begun:
            self._begun = True
            self._worker.post(self._step)

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

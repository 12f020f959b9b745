"""What a session says of the topics of its sources, recorded or live."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from sambot_viz.session.data.live_topics import LiveTopics
from sambot_viz.session.data.recorded_topics import RecordedTopics
from sambot_viz.session.signals import Signal
from sambot_viz.topics.report import TopicStatus


class SourceTopics:
    """Asks what knows a topic: the index of a recording, or what was listened to.

    Args:
        recorded: of what can seek; None without that.
        live: of what comes by itself; None without that.
    """

    def __init__(
        self, recorded: RecordedTopics | None, live: LiveTopics | None
    ) -> None:
        self.recorded, self.live = recorded, live
        self._all = [one for one in (recorded, live) if one is not None]

    @property
    def nothing(self) -> str:
        """What to say without any topic."""
        return self._all[-1].nothing

    @property
    def names(self) -> Sequence[str]:
        """The names of the topics that there are now, sorted."""
        if len(self._all) == 1:
            return self._all[0].names
        return sorted({name for one in self._all for name in one.names})

    @property
    def is_complete(self) -> bool:
        """Whether all messages that are looked at at all were."""
        return all(one.is_complete for one in self._all)

    @property
    def remade_by(self) -> Sequence[Signal[Any]]:
        """After these something else is to be said."""
        return [signal for one in self._all for signal in one.remade_by]

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """After these rates and ages are others."""
        return [signal for one in self._all for signal in one.moved_by]

    def follow(
        self, viewer: object, names: Collection[str] | None, chosen: str = ""
    ) -> None:
        """Look at messages for a viewer, in the session's worker.

        Args:
            viewer: who sees the topics.
            names: of the topics; None when they are no longer on the screen.
            chosen: the one that is selected, and may be large.
        """
        for one in self._all:
            one.follow(viewer, names, chosen)

    def close(self) -> None:
        """Look at nothing more."""
        for one in self._all:
            one.close()

    def status(self, name: str) -> TopicStatus:
        """Return what is to be said of a topic now."""
        return self._of(name).status(name)

    def count(self, name: str) -> int | None:
        """Return how many messages there are, or came; None while not known."""
        return self._of(name).count(name)

    def rate(self, name: str) -> float | None:
        """Return how often messages come [Hz]; None when there are less than two."""
        return self._of(name).rate(name)

    def age(self, name: str) -> float | None:
        """Return how long ago the last message came [s]; None before the first."""
        return self._of(name).age(name)

    def facts(self, name: str) -> Mapping[str, str]:
        """Return what else is known of a topic."""
        return self._of(name).facts(name)

    def _of(self, name: str) -> RecordedTopics | LiveTopics:
        recorded, live = self.recorded, self.live
        if recorded is not None and (live is None or recorded.has(name)):
            return recorded
        return self._all[-1] if live is None else live

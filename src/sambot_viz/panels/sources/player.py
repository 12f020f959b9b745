"""The player below the view: the time of a recording, and what moves it on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sambot_viz.panels.command import FLAG, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Row
from sambot_viz.session.data.player import FASTEST, SLOWEST, Player
from sambot_viz.session.signals import Signal

PERIOD = 1.0
"""A playing page goes on by itself; it is told the time this often [s]."""
TIME, PLAYING = "player/time", "player/playing"
ANY = "any"
"""Instead of a topic: messages of all topics that are shown."""


MOST_TOPICS = 300
"""So many topics are offered to step by."""


class PlayerPanel(Panel):
    """Plays, stops and jumps; who has control does it for all.

    Args:
        player: the time of the session's recording.
        name: of the recording.
    """

    name = "player"
    period = PERIOD

    def __init__(self, player: Player, name: str) -> None:
        self.changed_by = (player.playback,)
        self._player = player
        self._name = name
        self._topic = ANY

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """The steps of the player."""
        return (self._player.stepped,)

    def data(self) -> Sequence[Data]:
        """Return the name of the recording, and when it begins [s since 1970]."""
        return [
            Data("player/name", self._name),
            Data("player/begin", self._player.start_ns * 1e-9),
        ]

    def rows(self) -> Sequence[Row]:
        """Return what can be set: the time from the begin [s], playing, rate, loop."""
        player, playback = self._player, self._player.playback.value
        duration = (player.end_ns - player.start_ns) / 1e9
        topics = [ANY, *sorted(player.recording.topics)[:MOST_TOPICS]]
        return [
            Row(
                TIME,
                "",
                "slider",
                "Time",
                value=self._time(),
                unit="s",
                least=0.0,
                most=duration,
                help="Time from the first message; drag it to go there.",
                set=self._jump,
            ),
            Row(
                PLAYING,
                "",
                "bool",
                "Playing",
                value=playback.playing,
                help="Space plays and pauses.",
                set=self._play,
            ),
            Row(
                "player/rate",
                "",
                "float",
                "Rate",
                value=playback.rate,
                least=SLOWEST,
                most=FASTEST,
                help="How much faster than it was recorded.",
                set=player.set_rate,
            ),
            Row(
                "player/loop",
                "",
                "bool",
                "Loop",
                value=playback.loop,
                help="Begin again at the end.",
                set=player.set_loop,
            ),
            Row(
                "player/topic",
                "",
                "enum",
                "Step to messages of",
                value=self._topic,
                options=topics,
                help="Whose messages the steps go to: all that are shown, or one.",
                set=self._set_topic,
            ),
        ]

    def changed_rows(self) -> Sequence[Row]:
        """Return all: there are a few."""
        return self.rows()

    def values(self) -> dict[str, Any]:
        """Return the time."""
        return {TIME: self._time()}

    def _time(self) -> float:
        # As exact as it was set, for permalinks of single messages.
        return (self._player.time_ns - self._player.start_ns) / 1e9

    # What a hand does

    def _jump(self, seconds: float) -> None:
        self._player.jump(self._player.start_ns + round(seconds * 1e9))

    def _play(self, playing: bool) -> None:
        if playing:
            self._player.play()
        else:
            self._player.pause()

    def _set_topic(self, topic: str) -> None:
        self._topic = topic
        self._player.playback.touch()

    @command("player/step", FLAG)
    def _step(self, back: bool) -> None:
        self._player.step(None if self._topic == ANY else self._topic, back=back)

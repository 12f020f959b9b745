"""The line below the view: the time of what can be played, and how live robots are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sambot_viz import limits
from sambot_viz.panels.command import FLAG, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Json, Row
from sambot_viz.session.data.player import FASTEST, SLOWEST, Player
from sambot_viz.session.data.robot_data import RobotData
from sambot_viz.session.data.session_sources import SessionSources
from sambot_viz.session.signals import Signal
from sambot_viz.topics.reasons import lagging

TIME, PLAYING, CLOCK = "player/time", "player/playing", "source/clock"
ANY = "any"
"""Instead of a topic: messages of all topics that are shown."""


class SourcePanel(Panel):
    """Shows what the sources can: those that seek are played, those with a clock told.

    Who has control plays, stops, jumps and records for all.

    Args:
        sources: of the session, which has some.
        offers_recording: whether users of this session may record a live robot, if the
            command line has named a folder for it.
    """

    name = "source"
    period = 1.0

    def __init__(self, sources: SessionSources, offers_recording: bool = False) -> None:
        self._sources = sources
        self._offers_recording = offers_recording
        self._topic = ANY
        self.refresh()

    def refresh(self) -> None:
        """Listen to the sources that there are by now."""
        data = self._data
        self.remade_by = (self._sources.replaced, data.status, data.topics.looked)
        self.changed_by = () if data.player is None else (data.player.playback,)

    @property
    def _data(self) -> RobotData:
        data = self._sources.data
        assert data is not None, "a session without sources has no line for them"
        return data

    @property
    def _player(self) -> Player | None:
        return self._data.player

    @property
    def _is_live(self) -> bool:
        return self._data.source.live is not None

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """The steps of the player; the clock, when a page cannot know it by itself."""
        steps = () if self._player is None else (self._player.stepped,)
        return (*steps, self._data.clock.state) if self._is_live else steps

    def data(self) -> Sequence[Data]:
        """Return the topics, the recording, its start [s since 1970], and robots."""
        # Those that have rows in the Topics panel; its search finds the others.
        found = [
            Data("names/topics", [*self._data.topics.names[: limits.TOPIC_ROWS.value]])
        ]
        if (player := self._player) is not None:
            found.append(Data("player/name", player.source.uri))
            found.append(Data("player/begin", player.start_ns * 1e-9))
        if self._is_live:
            found += [Data("source/status", self._status()), Data(CLOCK, self._clock())]
        return found

    def rows(self) -> Sequence[Row]:
        """Return what can be set: the time since the start [s], playing, rate, loop."""
        return () if self._player is None else self._controls(self._player)

    def changed_rows(self) -> Sequence[Row]:
        """Return all: there are a few."""
        return self.rows()

    def values(self) -> dict[str, Json]:
        """Return the times of the player and of the robot."""
        times: dict[str, Json] = {}
        if self._player is not None:
            times[TIME] = _time(self._player)
        if self._is_live:
            times[CLOCK] = self._clock()
        return times

    # What can seek

    def _controls(self, player: Player) -> Sequence[Row]:
        playback = player.playback.value
        topics = [ANY, *sorted(player.recording.topics)[: limits.STEP_TOPICS.value]]
        if self._topic not in topics:
            self._topic = ANY
        return [
            Row(
                TIME,
                "",
                "slider",
                "Time",
                value=_time(player),
                unit="s",
                least=0.0,
                most=(player.end_ns - player.start_ns) / 1e9,
                help="Time from the first message; drag it to go there.",
                set=lambda seconds: player.jump(player.start_ns + round(seconds * 1e9)),
            ),
            Row(
                PLAYING,
                "",
                "bool",
                "Playing",
                value=playback.playing,
                help="Space plays and pauses.",
                set=lambda playing: player.play() if playing else player.pause(),
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

    def _set_topic(self, topic: str) -> None:
        self._topic = topic
        if self._player is not None:
            self._player.playback.touch()

    @command("player/step", FLAG)
    def _step(self, back: bool) -> None:
        if self._player is not None:
            topic = None if self._topic == ANY else self._topic
            self._player.step(topic, back=back)

    # What has a clock

    def _status(self) -> Json:
        """Return the sentence of the robots, and whether messages can come."""
        robot = self._data.moved_by
        status, sentence = robot.source.status, robot.sentence
        is_connected = status.is_connected and status.is_whole
        if status.retry_s is not None and not is_connected:
            sentence += f"; next attempt in {max(1, round(status.retry_s))} s"
        if self._data.doubt is not None:
            sentence += f"; {self._data.doubt.text}"
        behind = lagging(status.dropped + self._data.inbox.lost, "this computer")
        if behind is not None:
            sentence += f"; {behind.text}"
        live = self._data.source.live
        return {
            "name": robot.name if live is None else live.uri,
            "connected": is_connected,
            "sentence": sentence,
            "recording": self._recording(),
        }

    def _clock(self) -> Json:
        state = self._data.clock.state.value
        return {"simulated": state.simulated, "time": state.time, "rate": state.rate}

    def _recording(self) -> Json:
        """Return how the present or last recording is; None without one."""
        recorder = self._data.moved_by.recorder
        status = None if recorder is None else recorder.status
        if status is None:
            return None
        return {
            "name": status.name,
            "running": status.is_running,
            "seconds": int(status.seconds),
            "size": status.size,
            "trouble": status.trouble or status.missing,
        }

    def offers(self, command_id: str) -> bool:
        """Offer to step, and to begin or end what the command line allows to record."""
        if command_id == "player/step":
            return self._player is not None
        recorder = self._data.moved_by.recorder
        if recorder is None or recorder.place is None or not self._offers_recording:
            return False
        status = recorder.status
        is_running = status is not None and status.is_running
        return is_running == (command_id == "source/stop")

    @command("source/record", name="Record")
    def _record(self) -> None:
        recorder = self._data.moved_by.recorder
        if recorder is not None:
            recorder.start()

    @command("source/stop", name="Stop recording")
    def _stop(self) -> None:
        recorder = self._data.moved_by.recorder
        if recorder is not None:
            recorder.stop(wait=False)


def _time(player: Player) -> float:
    # As exact as it was set, for permalinks of single messages.
    return (player.time_ns - player.start_ns) / 1e9

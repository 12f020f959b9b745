"""A recording in several files, whose maker and clock a test is."""

from __future__ import annotations

from pathlib import Path

from live_peers import cdr_string

from sambot_viz.messages import Schema
from sambot_viz.sources.message import Recorded, TopicChannel
from sambot_viz.sources.split_recording import SplitRecording

PART_S = 5.0
_STRING = Schema("std_msgs/msg/String", "ros2msg", "string data\n")
_CHANNELS = {
    name: TopicChannel(name, _STRING, "cdr", is_latched=name != "/words")
    for name in ("/words", "/tf_static", "/robot_description")
}


class PartedRecording:
    """Records words of a robot, whose clock is not that of this computer.

    Args:
        folder: is made.
        start_ns: the time of the first word [ns].
    """

    def __init__(self, folder: Path, start_ns: int = 10**18) -> None:
        folder.mkdir()
        self.folder = folder
        self._recording = SplitRecording(folder, PART_S, 1.0)
        self._recording.begin()
        self._parts = 0
        self._now_ns = start_ns

    def say(self, *words: str, topic: str = "/words") -> None:
        """Record some words, a millisecond after each other."""
        for word in words:
            self._now_ns += 10**6
            channel, now = _CHANNELS[topic], self._now_ns
            message = Recorded(topic, channel, now, now, cdr_string(word))
            self._recording.write(message, now)

    def set_clock(self, now_ns: int) -> None:
        """Set the clock of the robot [ns]."""
        self._now_ns = now_ns

    def part(self, *words: str) -> None:
        """Record some words, and close the file."""
        self.say(*words)
        self._parts += 1
        self._recording.keep(self._parts * PART_S)

    def flush(self) -> None:
        """Write out what came, as is done once a second."""
        self._recording.keep(self._parts * PART_S + 1.5)

    def end(self) -> None:
        """End the recording."""
        self._recording.finish()

    def kill(self) -> None:
        """Let go of the file, as when the recorder is killed."""
        self._recording.close()

    def names(self) -> list[str]:
        """Return the files that are there, sorted."""
        return sorted(path.name for path in self.folder.glob("*.mcap"))

"""A robot on the network that publishes what a recording has."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

import foxglove
from foxglove.websocket import ChannelView, Client
from live_peers import FoxglovePeer

from sambot_viz.sources.bag import Recording, open_recording

START = 1_750_000_000_000_000_000
_Peer = TypeVar("_Peer", bound="RobotPeer")


class RobotPeer(FoxglovePeer):
    """Publishes what a recording has."""

    def __init__(self, recording: Recording, **options: Any) -> None:
        self.recording = recording
        super().__init__(**options)
        for name, topic in recording.topics.items():
            if topic.is_latched:
                self._latched[name] = []
        for message in recording.latched():
            self._latched[message.topic].append(bytes(message.payload))
        for name in self.at_once():
            self.offer(name)

    def at_once(self) -> Iterable[str]:
        """The topics that are there from the start."""
        return self.recording.topics

    def offer(self, name: str) -> None:
        """Begin to publish a topic."""
        topic = self.recording.topics[name]
        text = topic.schema.text
        self._channels[name] = foxglove.Channel(
            name,
            schema=foxglove.Schema(
                name=topic.schema.name,
                encoding=topic.schema.encoding,
                data=text.encode() if isinstance(text, str) else text,
            ),
            message_encoding=topic.message_encoding,
            context=self.context,
        )

    def play(
        self,
        until_s: float,
        from_s: float = 0.0,
        topics: Sequence[str] = ("/tf", "/joint_states"),
    ) -> None:
        """Publish all that moves, between two times [s]."""
        begin, end = (START + round(time * 1e9) for time in (from_s, until_s))
        for message in self.recording.messages(begin, end, topics):
            self._channels[message.topic].log(bytes(message.payload))


class BusyPeer(RobotPeer):
    """Publishes all that moves, up to a time [s], as soon as somebody wants it."""

    until_s = 9.05

    def on_subscribe(self, client: Client, channel: ChannelView) -> None:
        super().on_subscribe(client, channel)
        end = START + round(self.until_s * 1e9)
        if channel.topic not in self._latched:
            for message in self.recording.messages(None, end, (channel.topic,)):
                self._channels[channel.topic].log(bytes(message.payload))


class HesitantPeer(RobotPeer):
    """Offers one topic after the other, and says again and again what is not kept."""

    def at_once(self) -> Iterable[str]:
        return ()

    def say_all(self) -> None:
        """Publish all that moves, of the topics that are there."""
        for name in self._channels.keys() - self._latched.keys():
            for message in self.recording.messages(None, None, (name,)):
                self._channels[name].log(bytes(message.payload))


@contextmanager
def square_peer(repository: Path, kind: type[_Peer]) -> Generator[_Peer]:
    """A robot that drives the square of `assets/`."""
    with open_recording(repository / "assets" / "square.mcap") as recording:
        peer = kind(recording)
        try:
            yield peer
        finally:
            peer.stop()

"""The messages that displays draw: those of a recording, or of a live robot."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Literal

from sambot_viz.displays.robot_display import WantedQos
from sambot_viz.displays.topic_messages import TopicDoubt, topics_of
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.session.data.descriptions import wanted_qos
from sambot_viz.session.data.player import Player
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.qos import Qos
from sambot_viz.text import capitalized
from sambot_viz.topics import reasons
from sambot_viz.topics.decoding import Decoding
from sambot_viz.topics.live_reasons import QOS_WORDS, no_publisher, qos_mismatch
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.subscription import Subscription


class DisplayTopics:
    """Keeps what displays have subscribed to; the two kinds of sources derive from it.

    Args:
        decoding: of their messages.
        report: tells an exception that no display should have raised.
    """

    def __init__(
        self,
        decoding: Decoding,
        report: Callable[[Exception], None],
    ) -> None:
        self._decoding = decoding
        self._report = report
        self._subscriptions: list[Subscription] = []

    def subscribe(
        self,
        topics: tuple[str, ...],
        came: Callable[[], None],
        *,
        depth_s: float,
        size: int,
        base: str = "",
        minds_older: bool = False,
    ) -> Subscription:
        """Ask for the messages of some topics."""
        made = Subscription(
            topics,
            self._decoding.in_turn(),
            came,
            depth_s=depth_s,
            size=size,
            base=base,
            minds_older=minds_older,
        )
        self._subscriptions.append(made)
        self._begin(made)
        return made

    def unsubscribe(self, subscription: Subscription) -> None:
        """Ask for them no longer."""
        self._subscriptions.remove(subscription)
        self._end(subscription)

    @property
    def has_news(self) -> bool:
        """Whether something has come, or waits for a transform."""
        return any(one.has_news for one in self._subscriptions)

    def deliver(self) -> None:
        """Let those draw for whom something has come, or who wait for a transform."""
        for one in list(self._subscriptions):
            if one.has_news:
                try:
                    one.came()
                except Exception as error:
                    # The messages are taken, and the other displays draw theirs.
                    self._report(error)

    def reset(self) -> None:
        """Forget all messages: the time has gone back."""
        for one in self._subscriptions:
            one.clear()

    def close(self) -> None:
        """Ask for nothing any longer."""
        for one in list(self._subscriptions):
            self.unsubscribe(one)

    def _begin(self, subscription: Subscription) -> None:
        raise NotImplementedError

    def _end(self, subscription: Subscription) -> None:
        raise NotImplementedError


class RecordedDisplayTopics(DisplayTopics):
    """The messages of a recording, at the time of its player.

    Args:
        recorded: the recording.
        player: gives its messages.
        report: as for `DisplayTopics`.
    """

    def __init__(
        self,
        recorded: SourceRobot,
        player: Player,
        report: Callable[[Exception], None],
    ) -> None:
        super().__init__(Decoding(recorded.decoding.types), report)
        self._recorded = recorded
        self._player = player
        self._types: Mapping[str, str] = {}

    def now_ns(self) -> int:
        """Return the log time of the player [ns]."""
        return self._player.time_ns

    def types(self) -> Mapping[str, str]:
        """Return the types of the messages of all topics, by their names."""
        topics = self._recorded.source.topics()
        if len(self._types) != len(topics):
            # Those of a growing recording become more.
            decoder = self._recorded.decoder
            self._types = {name: decoder(one).type_name for name, one in topics.items()}
        return self._types

    def offered(self, topic: str) -> WantedQos | None:
        """Return the quality of service that suits a topic; None if not known."""
        known = self._recorded.source.topics().get(topic)
        return None if known is None else _suiting(known.qos, known.is_latched)

    def doubt(
        self, topic: str, meanings: Collection[Meaning], qos: WantedQos
    ) -> TopicDoubt | None:
        """Return why a topic gives nothing; QoS is a matter of the past here."""
        del qos
        recorded = self._recorded
        known = recorded.source.topics().get(topic)
        if known is None:
            return not_there(topic, meanings, self.types())
        decoder = recorded.decoder(known)
        if meaning_of(decoder.type_name) not in meanings:
            return wrong_type(meanings, decoder.type_name)
        if decoder.reason is not None:
            return TopicDoubt("Error", capitalized(decoder.reason.text))
        if known.count == 0:
            return TopicDoubt("Warn", capitalized(reasons.no_message(topic).text))
        return None

    def _begin(self, subscription: Subscription) -> None:
        self._player.add(subscription)

    def _end(self, subscription: Subscription) -> None:
        self._player.remove(subscription)


class LiveDisplayTopics(DisplayTopics):
    """The messages of a live robot, as they come.

    Args:
        live: the robot.
        wake: called in the thread of the source when something has come.
        report: as for `DisplayTopics`.
    """

    def __init__(
        self,
        live: SourceRobot,
        wake: Callable[[], None],
        report: Callable[[Exception], None],
    ) -> None:
        super().__init__(Decoding(live.decoding.types), report)
        self._live = live
        self._wake = wake
        self._receivers: dict[Subscription, Callable[[Recorded], object]] = {}

    def now_ns(self) -> int:
        """Return the time of the robot, which may be simulated [ns]."""
        return self._live.source.clock_ns()

    def types(self) -> Mapping[str, str]:
        """Return the types of the messages of all topics, by their names."""
        live = self._live
        known = live.source.topics().items()
        return {name: live.decoder(one).type_name for name, one in known}

    def offered(self, topic: str) -> WantedQos | None:
        """Return the quality of service that suits a topic; None if not known."""
        known = self._live.source.topics().get(topic)
        return None if known is None else _suiting(known.qos, known.is_latched)

    def doubt(
        self, topic: str, meanings: Collection[Meaning], qos: WantedQos
    ) -> TopicDoubt | None:
        """Return why a topic gives nothing, also what its publishers do not offer."""
        source = self._live.source
        known = source.topics().get(topic)
        if known is None:
            if not source.status.is_connected:
                return TopicDoubt("Warn", source.status.sentence)
            return not_there(topic, meanings, self.types(), "Warn")
        if known.reason is not None:
            return TopicDoubt("Error", capitalized(known.reason))
        decoder = self._live.decoder(known)
        if meaning_of(decoder.type_name) not in meanings:
            return wrong_type(meanings, decoder.type_name)
        if decoder.reason is not None:
            return TopicDoubt("Error", capitalized(decoder.reason.text))
        why = no_publisher(topic, known.publishers)
        why = why or qos_mismatch(known.qos, wanted_qos(qos))
        return None if why is None else TopicDoubt("Warn", capitalized(why.text))

    def _begin(self, subscription: Subscription) -> None:
        receive = partial(self._receive, subscription)
        self._receivers[subscription] = receive
        for topic in subscription.topics:
            self._live.source.subscribe(topic, receive)

    def _end(self, subscription: Subscription) -> None:
        receive = self._receivers.pop(subscription)
        for topic in subscription.topics:
            self._live.source.unsubscribe(topic, receive)

    def _receive(self, subscription: Subscription, message: Recorded) -> None:
        """Leave a message to the worker; runs in the thread of the source."""
        subscription.take(message)
        self._wake()


def _suiting(qos: Qos | None, is_latched: bool) -> WantedQos:
    """Return what a display should ask for, as RViz does for a topic from its list."""
    reliability = "Reliable" if qos is None else QOS_WORDS.get(qos.reliability, "")
    durability = "Transient Local" if is_latched else "Volatile"
    return WantedQos(reliability or "Reliable", durability)


def not_there(
    topic: str,
    wanted: Collection[Meaning],
    known: Mapping[str, str],
    level: Literal["Warn", "Error"] = "Error",
) -> TopicDoubt:
    """Say that there is no such topic, and which one was meant.

    Args:
        topic: its name.
        wanted: what the display draws.
        known: all topics, with their types.
        level: of the status.
    """
    fitting = topics_of(known, wanted)
    text = reasons.no_such_topic(topic, fitting or known).text
    return TopicDoubt(level, capitalized(text), reasons.meant_topic(topic, fitting))


def wrong_type(meanings: Collection[Meaning], type_name: str) -> TopicDoubt:
    """Say that a topic has messages that the display does not draw."""
    wanted = " or ".join(sorted(one.value for one in meanings))
    text = capitalized(reasons.wrong_type(wanted, type_name).text)
    return TopicDoubt("Error", text, is_other_type=True)

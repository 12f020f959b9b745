"""The messages that displays draw."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Literal

from sambot_viz.displays.robot_display import WantedQos
from sambot_viz.displays.topic_messages import Rests, TopicDoubt, topics_of
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.session.data.descriptions import wanted_qos
from sambot_viz.session.data.feed import Feed
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.qos import Qos
from sambot_viz.text import capitalized
from sambot_viz.topics import reasons
from sambot_viz.topics.live_reasons import QOS_WORDS, no_publisher, qos_mismatch
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.subscription import Subscription


class DisplayTopics:
    """Keeps what displays have subscribed to.

    While nobody looks, what may rest is neither asked for nor decoded.

    Args:
        moved_by: decodes the messages.
        feed: has them.
        wake: called in the thread of a live source when something has come.
        report: tells an exception that no display should have raised.
    """

    def __init__(
        self,
        moved_by: SourceRobot,
        feed: Feed,
        wake: Callable[[], None],
        report: Callable[[Exception], None],
    ) -> None:
        self._moved_by = moved_by
        self._feed = feed
        self._wake = wake
        self._report = report
        self._decoding = moved_by.new_decoding()
        self._subscriptions: dict[Subscription, Rests] = {}
        self._asleep: set[Subscription] = set()
        self._is_seen = True
        self._types: tuple[object, Mapping[str, str]] = (None, {})

    def subscribe(
        self,
        topics: tuple[str, ...],
        came: Callable[[], None],
        *,
        depth_s: float,
        size: int,
        base: str = "",
        minds_older: bool = False,
        rests: Rests = "never",
        joints: bool = False,
    ) -> Subscription:
        """Ask for the messages of some topics; see `TopicMessages`."""
        index = self._moved_by.joint_index(topics) if joints else None
        made = Subscription(
            topics,
            self._decoding.in_turn(),
            came,
            depth_s=depth_s,
            size=size,
            base=base,
            minds_older=minds_older,
            holding=None if index is None else index.holding,
        )
        self._subscriptions[made] = rests
        if self._is_seen or not self._rests(made):
            self._feed.add(made, partial(self._receive, made))
        else:
            self._asleep.add(made)
        return made

    def unsubscribe(self, subscription: Subscription) -> None:
        """Ask for them no longer."""
        del self._subscriptions[subscription]
        if subscription in self._asleep:
            self._asleep.remove(subscription)
        else:
            self._feed.remove(subscription)

    def rest(self) -> None:
        """Ask for what may rest no longer: nobody looks."""
        self._is_seen = False
        for one in self._subscriptions.keys() - self._asleep:
            if self._rests(one):
                self._asleep.add(one)
                self._feed.remove(one)

    def wake(self) -> None:
        """Ask for all again: somebody looks. Recorded messages of now wait at once."""
        self._is_seen = True
        for one in self._asleep:
            one.clear()
            self._feed.add(one, partial(self._receive, one))
        self._asleep.clear()

    def _rests(self, subscription: Subscription) -> bool:
        rests = self._subscriptions[subscription]
        if rests == "where recorded":
            return any(map(self._feed.is_recorded, subscription.topics))
        return rests == "always"

    @property
    def has_news(self) -> bool:
        """Whether something has come, or waits for a transform."""
        return any(one.has_news for one in self._subscriptions)

    def deliver(self) -> None:
        """Let those draw for whom something has come, or who wait for a transform."""
        for one in list(self._subscriptions):
            if one.has_news and one not in self._asleep:
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

    def now_ns(self, topic: str) -> int:
        """Return the time of the source of a topic [ns]."""
        return self._feed.time_ns(topic)

    def types(self) -> Mapping[str, str]:
        """Return the types of the messages of all topics, by their names."""
        topics = self._feed.source.topics()
        if self._types[0] is not topics:
            # New topics, or those of a growing recording, come as another mapping.
            decoder = self._moved_by.decoder
            types = {name: decoder(one).type_name for name, one in topics.items()}
            self._types = topics, types
        return self._types[1]

    def offered(self, topic: str) -> WantedQos | None:
        """Return the quality of service that suits a topic; None if not known."""
        known = self._feed.source.topics().get(topic)
        return None if known is None else _suiting(known.qos, known.is_latched)

    def doubt(
        self, topic: str, meanings: Collection[Meaning], qos: WantedQos
    ) -> TopicDoubt | None:
        """Return why a topic gives nothing, also what its publishers do not offer.

        The QoS of a recording is a matter of the past.
        """
        source = self._feed.source
        known = source.topics().get(topic)
        if known is None:
            if not source.status.is_connected:
                return TopicDoubt("Warn", source.status.sentence)
            # What is not published may come.
            level = "Warn" if "clock" in source.capabilities else "Error"
            return not_there(topic, meanings, self.types(), level)
        if known.reason is not None:
            return TopicDoubt("Error", capitalized(known.reason))
        decoder = self._moved_by.decoder(known)
        if meaning_of(decoder.type_name) not in meanings:
            return wrong_type(meanings, decoder.type_name)
        if decoder.reason is not None:
            return TopicDoubt("Error", capitalized(decoder.reason.text))
        why = reasons.no_message(topic) if known.count == 0 else None
        if not self._feed.is_recorded(topic):
            why = no_publisher(topic, known.publishers)
            why = why or qos_mismatch(known.qos, wanted_qos(qos))
        return None if why is None else TopicDoubt("Warn", capitalized(why.text))

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

"""The messages that displays draw."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Literal

from sambot_viz.displays.robot_display import WantedQos
from sambot_viz.displays.topic_messages import Rests, TopicDoubt, topics_of
from sambot_viz.errors import DecodeError, SourceError
from sambot_viz.frames import LookupRefused
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.session.data.descriptions import wanted_qos
from sambot_viz.session.data.feed import Feed
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.qos import Qos
from sambot_viz.sources.source import Reply
from sambot_viz.topics import reasons
from sambot_viz.topics.heard import Heard
from sambot_viz.topics.placement import Placement
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.service_message import ServiceMessage
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.subscription import Subscription

_UNREAD = ("encoding", "type-unknown", "not-decodable")


class DisplayTopics:
    """Keeps the subscriptions of displays.

    While no page is open, displays that may rest get no messages, and none are decoded.

    Args:
        moved_by: decodes the messages.
        feed: delivers them.
        placement: explains why a frame has no place.
        wake: called in the thread of a live source when a message has come.
        report: reports an exception that a display should not have raised.

    Attributes:
        unheard: returns why a topic gives nothing to any display.
    """

    def __init__(
        self,
        moved_by: SourceRobot,
        feed: Feed,
        placement: Placement,
        wake: Callable[[], None],
        report: Callable[[Exception], None],
    ) -> None:
        self._moved_by = moved_by
        self._feed = feed
        self._placement = placement
        self._wake = wake
        self._report = report
        self._decoding = moved_by.new_decoding()
        self._subscriptions: dict[Subscription, Rests] = {}
        self._asleep: set[Subscription] = set()
        self._is_seen = True
        self._refusals: deque[Callable[[], object]] = deque()
        self.unheard: Callable[[str], TopicReason | None] = lambda topic: None
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
            self._sleep(made)
        return made

    def unsubscribe(self, subscription: Subscription) -> None:
        """Ask for them no longer."""
        del self._subscriptions[subscription]
        if subscription in self._asleep:
            self._asleep.remove(subscription)
        else:
            self._feed.remove(subscription)

    def call(self, service: ServiceMessage, subscription: Subscription) -> None:
        """Call a service; see `TopicMessages`. It is answered in another thread."""
        beside = self._feed.source.topics().get(subscription.topics[0])
        prefix = "" if beside is None else beside.frame_prefix

        def answered(reply: Reply) -> None:
            why, now_ns = reply.refusal, self.now_ns(service.topic)
            try:
                if not why:
                    subscription.take(service.message(reply, now_ns, prefix))
            except DecodeError as error:
                why = f"its answer makes no sense: {error}"
            if why:
                self._refusals.append(partial(service.refused, why))
            self._wake()

        try:
            self._moved_by.source.call(service.service, service.request, answered)
        except SourceError as error:
            service.refused(str(error))

    def rest(self) -> None:
        """Unsubscribe displays that may rest: no page is open."""
        self._is_seen = False
        for one in self._subscriptions.keys() - self._asleep:
            if self._rests(one):
                self._sleep(one)
                self._feed.remove(one)

    def wake(self) -> None:
        """Subscribe to all again; recorded messages of this time wait at once."""
        self._is_seen = True
        for one in self._asleep:
            one.clear()
            one.is_asleep = False
            self._feed.add(one, partial(self._receive, one))
        self._asleep.clear()

    def _sleep(self, subscription: Subscription) -> None:
        subscription.is_asleep = True
        self._asleep.add(subscription)

    def _rests(self, subscription: Subscription) -> bool:
        rests = self._subscriptions[subscription]
        if rests == "where recorded":
            return any(map(self._feed.is_recorded, subscription.topics))
        return rests == "always"

    @property
    def has_news(self) -> bool:
        """Whether something has come, or waits for a transform."""
        return bool(self._refusals) or any(one.has_news for one in self._subscriptions)

    def deliver(self) -> None:
        """Let those draw for whom something has come, or who wait for a transform."""
        while self._refusals:
            self._refusals.popleft()()
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
                sentence = source.status.sentence
                return TopicDoubt("Warn", TopicReason("not-connected", sentence))
            # A topic that is not published yet may still come.
            level = "Warn" if "clock" in source.capabilities else "Error"
            return not_there(topic, meanings, self.types(), level)
        type_name = self._moved_by.decoder(known).type_name
        if known.reason is None and meaning_of(type_name) not in meanings:
            wanted = " or ".join(sorted(one.value for one in meanings))
            why = reasons.wrong_type(wanted, type_name)
            return TopicDoubt("Error", why, is_other_type=True)
        why = self.unheard(topic)
        if why is None and not self._feed.is_recorded(topic):
            why = reasons.qos_mismatch(known.qos, wanted_qos(qos))
        if why is None:
            return None
        return TopicDoubt("Error" if why.code in _UNREAD else "Warn", why)

    def heard(self, topic: str) -> Heard | None:
        """Return what has come of a topic that a display listens to; None for none."""
        awake = self._subscriptions.keys() - self._asleep
        found = (one.heard[topic] for one in awake if topic in one.heard)
        return next(found, None)

    def unplaced(self, topic: str, refused: LookupRefused) -> TopicReason | None:
        """Return why a message has no place; None where what comes next brings it."""
        player = self._feed.player
        is_recorded = player is not None and self._feed.is_recorded(topic)
        at_ns = player.time_ns if player is not None and is_recorded else None
        return self._placement.reason(topic, refused, at_ns)

    def is_recorded(self, topic: str) -> bool:
        """Return whether all that there is of a topic up to now has come."""
        return self._feed.is_recorded(topic)

    def _receive(self, subscription: Subscription, message: Recorded) -> None:
        """Leave a message to the worker; runs in the thread of the source."""
        subscription.take(message)
        self._wake()


def _suiting(qos: Qos | None, is_latched: bool) -> WantedQos:
    """Return the QoS that RViz would request for a topic from its list."""
    words = reasons.QOS_WORDS
    reliability = "Reliable" if qos is None else words.get(qos.reliability, "")
    durability = "Transient Local" if is_latched else "Volatile"
    return WantedQos(reliability or "Reliable", durability)


def not_there(
    topic: str,
    wanted: Collection[Meaning],
    known: Mapping[str, str],
    level: Literal["Warn", "Error"] = "Error",
) -> TopicDoubt:
    """Return the status for a missing topic, with the nearest name.

    Args:
        topic: the missing name.
        wanted: the types that the display draws.
        known: all topics, with their types.
        level: the level of the status.
    """
    fitting = topics_of(known, wanted)
    why = reasons.no_such_topic(topic, fitting or known)
    return TopicDoubt(level, why, reasons.meant_topic(topic, fitting))

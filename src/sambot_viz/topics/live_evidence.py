"""The facts about the topics of a robot on the network."""

from __future__ import annotations

import re
from collections.abc import Callable

from sambot_viz.frames import LookupRefused
from sambot_viz.messages import Decoder
from sambot_viz.sources.message import SourceTopic
from sambot_viz.topics import reasons
from sambot_viz.topics.heard import Heard
from sambot_viz.topics.looked import Looked
from sambot_viz.topics.placement import Placement
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.source_robot import SourceRobot

SILENT_AFTER = 5.0
"""Time without a message after which a topic is reported as silent [s]."""
FaultOf = Callable[[str], LookupRefused | None]
_LARGE = re.compile(r"(Image|PointCloud2?|Video|Packet\w*)$")
"""Types of messages that would fill a wireless network."""


def is_large(topic: SourceTopic) -> bool:
    """Return whether a topic of this type is only subscribed to on demand."""
    return _LARGE.search(topic.schema.name) is not None


class LiveEvidence:
    """Collects the received messages of each topic (see `Evidence`).

    Args:
        moved_by: the robot.
        placement: explains why a frame has no place.
        fault_of: returns why a frame has no place in the picture; None if it has one.
        heard_of: returns the messages that a display received; None without a display.
        now: returns the time of the session [s].

    Attributes:
        own: topic → the messages that the list of topics received.
    """

    def __init__(
        self,
        moved_by: SourceRobot,
        placement: Placement,
        fault_of: FaultOf,
        heard_of: Callable[[str], Heard | None],
        now: Callable[[], float],
    ) -> None:
        self.own: dict[str, Heard] = {}
        self._moved_by = moved_by
        self._placement = placement
        self._fault_of = fault_of
        self._heard_of = heard_of
        self._now = now

    def heard(self, name: str) -> Heard | None:
        """Return the received messages of a topic; None without a subscription."""
        return self.own.get(name) or self._heard_of(name)

    # The evidence

    def topic(self, name: str) -> SourceTopic:
        """Return what the robot says of a topic."""
        return self._moved_by.source.topics()[name]

    def decoder(self, name: str) -> Decoder:
        """Return the decoder of its messages, or the reason why there is none."""
        return self._moved_by.decoder(self.topic(name))

    def looked(self, name: str) -> Looked:
        """Return what was seen of its newest message, unless a display looks at it."""
        heard = self.own.get(name)
        if heard is None or self._heard_of(name) is not None:
            return Looked()
        return heard.look(self._moved_by.decode)

    def unreceived(self, name: str) -> TopicReason | None:
        """Return why nothing of it comes."""
        live, topic = self._moved_by.source.live, self.topic(name)
        if live is not None and not live.status.is_connected:
            return TopicReason("not-connected", live.status.sentence)
        found, own = reasons.unreceived(topic), self.own.get(name)
        if found is None and self.heard(name) is None:
            return reasons.not_listened() if is_large(topic) else None
        # It may be of the one of several that is not connected.
        is_whole = live is None or live.status.is_whole
        if found is None and own is not None and own.last is None and is_whole:
            waited = self._now() - own.since
            return reasons.no_message_yet(topic) if waited > SILENT_AFTER else None
        return found

    def of_robot(self, name: str) -> TopicReason | None:
        """Return the fault of its transforms or its robot, or what hides them."""
        return self._placement.of_robot(name)

    def to_come(self, name: str) -> TopicReason | None:
        """Return None: the future messages of a robot are unknown."""

    def unplaced(self, name: str) -> TopicReason | None:
        """Return why the frame of its newest message has no place."""
        looked = self.looked(name)
        if name in self._moved_by.topics.descriptions:
            return self._placement.unplaced_robot(name, self._fault_of)
        if not looked.frame or name in self._moved_by.topics.all:
            return None
        stamp = None if looked.stamps is None else looked.stamps[1]
        refused = self._fault_of(looked.frame)
        if refused is None:
            return self._placement.other_clock(name, stamp)
        return self._placement.reason(name, refused, None)

    def silent(self, name: str) -> TopicReason | None:
        """Return that its messages come no more."""
        heard, live = self.heard(name), self._moved_by.source.live
        if self.topic(name).is_latched or heard is None or live is None:
            return None
        age = heard.age(live.clock_ns())
        return None if age is None else reasons.stale(age, heard.period)

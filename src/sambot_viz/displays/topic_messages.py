"""Where displays of data get their messages: a recording or a live robot."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol, TypeAlias

from sambot_viz.displays.robot_display import WantedQos
from sambot_viz.frames import LookupRefused
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.text import capitalized
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.service_message import ServiceMessage
from sambot_viz.topics.subscription import Subscription

Rests: TypeAlias = Literal["never", "where recorded", "always"]
"""Whether messages come while nobody looks.

Those of a recording are there again with the first page, as after a jump. Of a robot
only a stream of large messages may rest, each of which takes the place of the last.
"""


@dataclass(frozen=True, slots=True)
class TopicDoubt:
    """Why a topic gives a display nothing.

    Attributes:
        level: of the status.
        reason: the cause and the remedy.
        instead: a topic to use in place of this one; empty when none is meant.
        is_other_type: its messages mean something that the display does not draw.
    """

    level: Literal["Warn", "Error"]
    reason: TopicReason
    instead: str = ""
    is_other_type: bool = False

    @property
    def sentence(self) -> str:
        """The cause and the remedy, as a status says it."""
        return capitalized(self.reason.text)


def topics_of(types: Mapping[str, str], wanted: Collection[Meaning]) -> Sequence[str]:
    """Return the topics whose messages have one of some meanings, sorted.

    Args:
        types: topic → type.
        wanted: meanings.
    """
    return sorted(topic for topic, one in types.items() if meaning_of(one) in wanted)


def values_of_topic(
    path: str, topic: str, qos: WantedQos | None
) -> Mapping[str, object]:
    """Return the values of a property that names a topic, and of its QoS, by path.

    Args:
        path: of the property.
        topic: its name.
        qos: that suits the topic; None keeps the defaults.
    """
    values: dict[str, object] = {path: topic}
    if qos is not None:
        values[f"{path}/Reliability Policy"] = qos.reliability
        values[f"{path}/Durability Policy"] = qos.durability
    return values


class TopicMessages(Protocol):
    """The messages of the topics of a recording or of a live robot."""

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
        """Ask for the messages of some topics (see `Subscription` for the others).

        Those that hold at the present time wait already, in a recording.

        Args:
            topics: their names.
            came: called when there are some.
            depth_s: how far back messages count.
            size: maximum number of waiting messages.
            base: what changes are made to.
            minds_older: whether older ones matter.
            rests: whether they are left alone while nobody looks.
            joints: they are joint states: the last one of each joint counts.
        """
        ...

    def unsubscribe(self, subscription: Subscription) -> None:
        """Ask for them no longer."""
        ...

    def call(self, service: ServiceMessage, subscription: Subscription) -> None:
        """Call a service once; its answer comes to the subscription as a message."""
        ...

    @property
    def has_news(self) -> bool:
        """Whether something has come, or waits for a transform."""
        ...

    def deliver(self) -> None:
        """Let those draw for whom something has come, or who wait for a transform."""
        ...

    def now_ns(self, topic: str) -> int:
        """Return the time of the source of a topic [ns]."""
        ...

    def types(self) -> Mapping[str, str]:
        """Return the types of the messages of all topics, by their names."""
        ...

    def offered(self, topic: str) -> WantedQos | None:
        """Return the quality of service that suits a topic; None if not known."""
        ...

    def doubt(
        self, topic: str, meanings: Collection[Meaning], qos: WantedQos
    ) -> TopicDoubt | None:
        """Return why a topic gives nothing to a display of some meanings, or None."""
        ...

    def unplaced(self, topic: str, refused: LookupRefused) -> TopicReason | None:
        """Return why a message has no place; None where what comes next brings it.

        Args:
            topic: of the message.
            refused: tf2's answer.
        """
        ...

    def is_recorded(self, topic: str) -> bool:
        """Return whether all that there is of a topic up to now has come."""
        ...

"""Base of the displays that draw the messages of a topic."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, ClassVar

from sambot_viz import limits
from sambot_viz.displays.data.display_node import nodes_of
from sambot_viz.displays.display import Display, DisplayContext, Status
from sambot_viz.displays.picking.pick_geometry import PickGeometry
from sambot_viz.displays.picking.placed import HERE, Placed, PlacedShapes
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.picking.triangle_mesh import Part
from sambot_viz.displays.robot_display import Repair, WantedQos
from sambot_viz.displays.topic_messages import (
    Rests,
    TopicDoubt,
    topics_of,
    values_of_topic,
)
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.rviz import FILTER_SIZE, QOS_PROPERTIES, DisplayConfig, TopicProperty
from sambot_viz.text import capitalized
from sambot_viz.topics.decoding import frame_and_stamp
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.subscription import Subscription

TOPIC = "Topic"
"""The path of the property that names the topic, and the key of its status."""
NO_SOURCE = "No messages: open a recording or a live robot (--source)"


def topic_property(
    name: str = TOPIC, *, is_filtered: bool = True, default: str = "", ros1: str = ""
) -> TopicProperty:
    """Return the property that names a topic, with its quality of service.

    Args:
        name: of the property.
        is_filtered: whether messages wait for their transform.
        default: the topic of a new display.
        ros1: the key that files of ROS 1 have instead; empty for the same.
    """
    children = (*QOS_PROPERTIES, FILTER_SIZE) if is_filtered else QOS_PROPERTIES
    return TopicProperty(
        name,
        default=default,
        help="The topic whose messages are drawn.",
        children=children,
        aliases=(ros1,) if ros1 else (),
    )


class TopicDisplay(Display):
    """Draws the messages of a topic while it is shown; otherwise it is not subscribed.

    A display declares what it draws in `meanings`, accepts messages in `messages_came`,
    and drops its drawing in `forget`.

    Attributes:
        nodes: the nodes that its class declares (`DisplayNode`).
        subscription: its messages; None while it has none.
        refusal: the fault of the newest message, shown in place of the number of
            messages; empty without one.
        nothing: a sentence if that message is empty; None if it is not.
    """

    is_data = True
    meanings: ClassVar[frozenset[Meaning]]
    """What the messages mean that it draws."""
    topic_path: ClassVar[str] = TOPIC
    """The path of the property that names the topic."""

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self.nodes = nodes_of(type(self), context.scene, key)
        self.subscription: Subscription | None = None
        self.refusal = ""
        self.nothing: TopicReason | None = None

    @classmethod
    def topic_values(
        cls, topic: str, type_name: str, qos: WantedQos | None
    ) -> Mapping[str, object] | None:
        """Return the values of a new display of a topic whose messages it draws."""
        if meaning_of(type_name) not in cls.meanings:
            return None
        path = cls.topic_path
        has_qos = any(one.name == path and one.children for one in cls.properties)
        return values_of_topic(path, topic, qos if has_qos else None)

    # For the displays that derive from it

    def messages_came(self) -> None:
        """Take what waits in the subscription, and draw it."""
        raise NotImplementedError

    def redraw(self) -> None:
        """Draw what was taken again, with other properties or in another frame."""
        raise NotImplementedError

    def forget(self) -> None:
        """Take everything out of the scene: it is of another time or topic."""
        raise NotImplementedError

    def begin(self) -> None:
        """Take note that messages of another time or topic follow."""

    @property
    def item(self) -> Selectable | None:
        """The target of a click on it; None for nothing, as in most RViz displays."""
        return None

    def placed(self) -> Iterator[Placed]:
        """Yield what its nodes show now, for rays."""
        for node in self.nodes.values():
            yield from node.placed(HERE, self.item)

    def remove(self) -> None:
        """Take its nodes out of the scene."""
        for node in self.nodes.values():
            node.remove()

    @property
    def depth_s(self) -> float:
        """How far back messages count after a jump in a recording [s]."""
        return 1.0

    @property
    def base_topic(self) -> str:
        """The topic whose last message begins what counts after a jump; "" for none."""
        return ""

    @property
    def minds_older(self) -> bool:
        """Whether older messages than those that count may still hold."""
        return False

    @property
    def most_waiting(self) -> int:
        """Maximum number of waiting messages between two pictures."""
        return limits.DISPLAY_WAITING.value

    @property
    def rests(self) -> Rests:
        """Whether its messages may wait until a page is open."""
        is_large = any(meaning.is_large for meaning in self.meanings)
        return "always" if is_large else "where recorded"

    def other_topics(self) -> Sequence[str]:
        """Return what it listens to beside its topic."""
        return ()

    def tell_time(self, message: Any) -> None:
        """Say of which time a message is that is drawn, to those that wait for it."""
        time = self.context.time
        if time is not None and self.tells_time:
            _, stamp_ns = frame_and_stamp(message)
            if stamp_ns is not None:
                time.told(self.config.name, stamp_ns)

    # What the others call

    @property
    def all_topics(self) -> Sequence[str]:
        """What it listens to, or would."""
        return (self.topic, *self.other_topics()) if self.topic else ()

    @property
    def is_awake(self) -> bool:
        """Whether it reads messages now; otherwise no page shows it."""
        return self.subscription is None or not self.subscription.is_asleep

    def unseen(self) -> TopicReason | None:
        """Return why it shows nothing, or not all, of its topics; as its status."""
        for row in self.status.rows.values():
            if row.level != "Ok":
                return TopicReason(row.code or "not-drawn", row.text)
        return None

    def unseen_topics(self) -> Iterator[tuple[str, TopicReason]]:
        """Yield its topic, if it shows nothing of it, or not all."""
        if (why := self.unseen()) is not None:
            yield self.topic, why

    def pick_geometry(self) -> PickGeometry:
        """Return what it shows now, for rays."""
        return PlacedShapes(tuple(self.placed()))

    def parts(
        self, of: Callable[[Selectable | None], bool]
    ) -> Iterator[tuple[Selectable | None, Part]]:
        """Yield what it shows of some items."""
        for one in self.placed():
            yield from one.parts(of)

    def draw(self) -> None:
        """Listen to the topic, and draw what has come."""
        self._listen()
        self.redraw()
        self.report_topic()

    def clear(self) -> None:
        """Listen no longer, and take everything out of the scene."""
        self._stop()
        self.forget()

    def property_changed(self, path: str) -> None:
        """A property has a new value."""
        if self.shown and path == self.topic_path:
            self._stop()
            self.forget()
            self.status.clear()
        super().property_changed(path)

    def time_passed(self) -> None:
        """Say how many messages have come, and listen if that was of no use before."""
        if self.shown:
            self._listen()
            self.report_topic()

    @property
    def topic(self) -> str:
        """The name of the topic; empty when none is set."""
        return str(self.config.get(self.topic_path))

    @property
    def wanted_qos(self) -> WantedQos:
        """The quality of service that it asks for."""
        get = self.config.get
        reliability = str(get(f"{TOPIC}/Reliability Policy"))
        return WantedQos(reliability, str(get(f"{TOPIC}/Durability Policy")))

    def _listen(self) -> None:
        messages = self.context.messages
        topics = (self.topic, *self.other_topics())
        if self.subscription is not None and self.subscription.topics != topics:
            self._stop()
            self.forget()
        if messages is None or not self.topic or self.subscription is not None:
            return
        doubt = self._doubt()
        if doubt is not None and doubt.is_other_type:
            return
        self.subscription = messages.subscribe(
            topics,
            self._take,
            depth_s=self.depth_s,
            size=self.most_waiting,
            base=self.base_topic,
            minds_older=self.minds_older,
            rests=self.rests,
        )
        self.begin()
        self._take()

    def _take(self) -> None:
        subscription = self.subscription
        if subscription is None:
            return
        if subscription.is_outdated:
            self.forget()
            self.begin()
        self.messages_came()

    def _stop(self) -> None:
        if self.subscription is not None and self.context.messages is not None:
            self.context.messages.unsubscribe(self.subscription)
        self.subscription = None

    # Statuses

    def report_topic(self) -> None:
        """Set the status of the topic."""
        found = self._topic_status()
        self.status.set(TOPIC, found.level, found.text, found.code)

    def _topic_status(self) -> Status:
        messages = self.context.messages
        if messages is None:
            return Status("Ok", "OK")
        if not self.topic:
            return Status("Error", "Error subscribing: Empty topic name")
        doubt = self._doubt()
        if doubt is not None:
            if doubt.is_other_type and self.subscription is not None:
                # A live topic may come later, or again with another type.
                self._stop()
                self.forget()
            return Status(doubt.level, doubt.sentence, doubt.reason.code)
        if self.refusal:
            return Status("Error", self.refusal)
        subscription = self.subscription
        count = 0 if subscription is None else subscription.heard[self.topic].count
        if not count or subscription is None:
            return Status("Ok", "OK")
        rate = subscription.rate(self.topic, messages.now_ns(self.topic))
        came = f"{count} messages received at {rate:.1f} hz."
        if self.nothing is not None:
            text = f"{came} {capitalized(self.nothing.text)}"
            return Status("Warn", text, self.nothing.code)
        return Status("Ok", came)

    def _doubt(self) -> TopicDoubt | None:
        messages = self.context.messages
        if messages is None or not self.topic:
            return None
        return messages.doubt(self.topic, self.meanings, self.wanted_qos)

    def notes(self) -> Mapping[str, str]:
        """Return why nothing comes, where no messages come at all."""
        return {self.topic_path: NO_SOURCE} if self.context.messages is None else {}

    def options(self) -> Mapping[str, Sequence[str]]:
        """Return the topics that it could draw."""
        messages = self.context.messages
        if messages is None:
            return {}
        return {self.topic_path: topics_of(messages.types(), self.meanings)}

    def repairs(self) -> Mapping[str, Repair]:
        """Return a button for the topic that was meant."""
        doubt = self._doubt()
        if doubt is None or not doubt.instead:
            return {}
        repair = Repair(f"Use {doubt.instead}", self.topic_path, doubt.instead)
        return {TOPIC: repair}

"""rosbridge: ROS over a websocket, with rosapi beside it for the list of topics.

rosbridge fixes the durability of a subscription when it begins: one that begins before
its publisher never gets the publisher's latched messages. So a topic is subscribed to
when it appears, and again when its first publisher does. Where rosapi cannot report
publishers, topics that are usually latched are tried again until a message has come.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from functools import partial
from itertools import count

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.sources import rosbridge_wire as wire
from sambot_viz.sources.action_names import action_of, status_topic
from sambot_viz.sources.live.conversation import Conversation, Ends
from sambot_viz.sources.live.outgoing_topic import OutgoingTopic
from sambot_viz.sources.live.service_calls import ServiceCalls
from sambot_viz.sources.message import (
    Recorded,
    SourceTopic,
    TopicChannel,
    is_latched_name,
)
from sambot_viz.sources.rosapi import Rosapi
from sambot_viz.sources.rosbridge_actions import RosbridgeActions
from sambot_viz.sources.source import (
    Capability,
    Encoding,
    OutgoingAction,
    Receivers,
    Source,
)
from sambot_viz.sources.websocket.trouble import WrongServer, other_protocol
from sambot_viz.text import text

_MAP = "/map"
_CALL = "sambot-viz-service-"
_LINE_LASTS = 30.0
_NO_ROSAPI = (
    "its topics are not known, since rosapi does not run there: start both with "
    "`ros2 launch rosbridge_server rosbridge_websocket_launch.xml`"
)


@dataclass(slots=True)
class _Subscription:
    """A subscription at the server.

    Attributes:
        name: which the server knows it by.
        type_name: of the messages, when it began.
        had_publishers: when it began, or later; None if that is not known.
        channels: by whether its messages are JSON.
    """

    name: str
    type_name: str
    had_publishers: bool | None
    channels: dict[bool, TopicChannel] = field(default_factory=dict[bool, TopicChannel])


class RosbridgeConversation(Conversation):
    """One connection to a rosbridge server.

    Nothing that is published is latched: the server keeps it for a second.
    """

    publishes: Encoding = "json"

    def __init__(self, ends: Ends) -> None:
        super().__init__(ends)
        self.calls = ServiceCalls(self._call, self.publishes)
        self._outgoing: list[OutgoingTopic] = []
        self._actions = RosbridgeActions(ends, self.goals)
        self._rosapi = Rosapi(ends.send, self._listed)
        self._subscriptions: dict[str, _Subscription] = {}
        self._wanted: frozenset[str] = frozenset()
        self._ids = count(1)
        self._line, self._line_end = "", 0.0

    def begin(self) -> None:
        """Ask for the topics and the definitions of their messages."""
        self._rosapi.poll()

    def receive(self, frame: str | bytes) -> None:
        """Accept a frame; malformed ones are counted."""
        try:
            operation = wire.parse_operation(frame)
        except wire.MalformedOperation:
            self.unreadable += 1
            return
        if isinstance(operation, wire.Publication):
            self._publication(operation)
        elif isinstance(operation, wire.ServiceResponse):
            known = self._rosapi.take(operation) or self._take_reply(operation)
            self.is_ready = known or self.is_ready
        elif isinstance(operation, wire.StatusLine):
            self.is_ready = True
            is_about_goal = self._actions.is_about_goal(operation)
            if operation.level in ("error", "warning") and not is_about_goal:
                self._note_refusal(operation)
                self._line = operation.msg
                self._line_end = time.monotonic() + _LINE_LASTS
        elif isinstance(operation, wire.GoalResult):
            self._actions.take(operation)
        elif operation == wire.ForeignOperation("serverInfo"):
            raise WrongServer(
                f"{self.ends.address.label} speaks Foxglove's protocol, not "
                f"rosbridge's: {other_protocol(self.ends.address)}"
            )
        self._note_changes()

    def topic_of(self, head: bytes) -> str:
        """Return the topic of a message, which the servers write before its fields."""
        topic = wire.topic_of(head)
        return topic if topic in self._subscriptions else ""

    @property
    def offers(self) -> frozenset[Capability]:
        """What the server can do: publish, and with rosapi graph."""
        can: list[Capability] = ["publish"]
        return frozenset([*can, "graph"] if self._rosapi.is_there else can)

    @property
    def unpublishable(self) -> str:
        """Nothing: each rosbridge takes messages."""
        return ""

    def advertise(self, outgoing: OutgoingTopic) -> None:
        """Tell the server of a topic that is published."""
        outgoing.number = next(self._ids)
        self._outgoing.append(outgoing)
        name, type_name = _name_of(outgoing), self._spelled(outgoing)
        self.ends.send(wire.advertise(name, outgoing.topic, type_name))
        self._ask_receivers()

    def publish(self, outgoing: OutgoingTopic, message: bytes) -> None:
        """Send a message."""
        if outgoing in self._outgoing:
            name, topic = _name_of(outgoing), outgoing.topic
            self.ends.send(wire.published(name, topic, message))

    def unadvertise(self, outgoing: OutgoingTopic) -> None:
        """Tell the server that a topic is published no longer."""
        if outgoing in self._outgoing:
            self._outgoing.remove(outgoing)
            self.ends.send(wire.unadvertise(_name_of(outgoing), outgoing.topic))

    def action(self, name: str, type_name: str, source: Source) -> OutgoingAction:
        """Return an action, where the server has answered that it sends goals to it."""
        if self._rosapi.is_there and status_topic(name) not in self._rosapi.types:
            raise SourceError(f"the robot has no action {text(name, 80)}")
        return self._actions.action(name, type_name)

    def update(self, wanted: frozenset[str]) -> None:
        """Subscribe to the wanted topics that exist, and to no others."""
        for topic in self._wanted - wanted:
            self._unsubscribe(topic)
        new = wanted - self._wanted
        self._wanted = wanted
        for topic in new:
            self._prepare(topic)
            if name := action_of(topic):
                self._actions.ask(name)
        self.ends.assets.refuse_all(
            "rosbridge hands out no files",
            "give the folder of the package with --package-path",
        )

    def tick(self, now: float) -> None:
        """Ask for the topics again when it is time."""
        if now > self._line_end:
            self._line = ""
        self.calls.tick(now)
        # Without rosapi, some servers do not answer at all.
        self.is_ready = self._rosapi.tick(now) or self.is_ready
        self._note_changes()

    def silence(self) -> str:
        """Return the sentence for a server that answers nothing."""
        return f"{self.ends.address.label} does not answer in rosbridge's protocol"

    def notes(self) -> list[str]:
        """Return the server's warnings, and sentences about left out topics."""
        notes = [] if self._rosapi.is_there else [_NO_ROSAPI]
        if self._line:
            notes.append(f"it says: {text(self._line, 200)}")
        if len(self._rosapi.types) >= limits.TOPICS.value:
            notes.append(
                f"only the first {limits.TOPICS.value} of its topics are listed"
            )
        return notes

    def topics(self) -> dict[str, SourceTopic]:
        """Return the topics that rosapi has listed."""
        found: dict[str, SourceTopic] = {}
        for name, type_name in self._rosapi.types.items():
            schema = wire.definition(type_name, self._definition(type_name))
            found[name] = SourceTopic(
                name,
                schema,
                wire.encoding(type_name),
                is_latched=is_latched_name(name),
                publishers=self._rosapi.publishers.get(name),
                left_out=self.left_out(name),
            )
        return found

    def _call(self, number: int, service: str, request: bytes) -> None:
        self.ends.send(wire.call_with(f"{_CALL}{number}", service, request))

    def _take_reply(self, response: wire.ServiceResponse) -> bool:
        """Take the answer of a service; return whether it was asked for."""
        number = response.id.removeprefix(_CALL)
        if number == response.id or not number.isdecimal():
            return False
        if response.result:
            return self.calls.take(int(number), bytes(response.values))
        return self.calls.fail(int(number), text(bytes(response.values).decode(), 400))

    def _spelled(self, outgoing: OutgoingTopic) -> str:
        """Return the type as the server's ROS writes it."""
        types = self._rosapi.types.values()
        is_ros1 = any(types) and not any(map(wire.is_ros2, types))
        return wire.plain_name(outgoing.type_name) if is_ros1 else outgoing.type_name

    def _ask_receivers(self) -> None:
        """Ask who has subscribed to the topics that are published."""
        for outgoing in self._outgoing:
            take = partial(self._take_receivers, outgoing)
            self._rosapi.ask_subscribers(outgoing.topic, take)

    def _take_receivers(
        self, outgoing: OutgoingTopic, names: tuple[str, ...] | None
    ) -> None:
        type_name = self._rosapi.types.get(outgoing.topic, "")
        outgoing.receivers = Receivers(names, type_name)

    def _note_refusal(self, line: wire.StatusLine) -> None:
        """Note a line of the server for the topic that it is about."""
        about = [one for one in self._outgoing if _name_of(one) == line.id]
        if not line.id:
            named = [one for one in self._outgoing if one.topic in line.msg]
            about = named or self._outgoing
        if len(about) == 1:
            about[0].refused = line.msg

    def _note_changes(self) -> None:
        self.topics_changed = self.topics_changed or self._rosapi.has_changed
        self._rosapi.has_changed = False

    def _publication(self, published: wire.Publication) -> None:
        subscription = self._subscriptions.get(published.topic)
        if subscription is None:
            return
        if published.stamp_ns is not None:
            self.ends.clock.note_message(published.stamp_ns)
        stamp = published.stamp_ns or self.ends.clock.now_ns()
        channel = self._channel(published.topic, subscription, published.is_json)
        self.ends.put(
            Recorded(published.topic, channel, stamp, None, published.payload)
        )

    def _channel(
        self, topic: str, subscription: _Subscription, is_json: bool
    ) -> TopicChannel:
        known = subscription.channels.get(is_json)
        if known is not None:
            return known
        type_name = subscription.type_name
        schema = wire.definition(type_name, self._definition(type_name))
        encoding = "json" if is_json else wire.encoding(type_name)
        is_latched = is_latched_name(topic)
        channel = TopicChannel(topic, schema, encoding, is_latched=is_latched)
        subscription.channels[is_json] = channel
        return channel

    def _definition(self, type_name: str) -> str:
        return self._rosapi.definitions.get(type_name, "")

    def _listed(self) -> None:
        """Follow the list of topics: some are gone, others have another type now."""
        types = self._rosapi.types
        self._ask_receivers()
        for topic, subscription in list(self._subscriptions.items()):
            if self._rosapi.is_there and types.get(topic) != subscription.type_name:
                self._unsubscribe(topic)
        for topic in self._wanted:
            if not self._rosapi.is_there:
                self._try_again(topic)
            self._prepare(topic)

    def _try_again(self, topic: str) -> None:
        """End a subscription without rosapi that may have begun too early."""
        subscription = self._subscriptions.get(topic)
        if (
            subscription is not None
            and not subscription.channels
            and (is_latched_name(topic) or topic == _MAP)
        ):
            self._unsubscribe(topic)

    def _prepare(self, topic: str) -> None:
        """Subscribe when the definition and the publishers have been asked for."""
        if topic in self._rosapi.types:
            if self._rosapi.needs_details(topic):
                self._rosapi.ask_details(topic, partial(self._prepare_wanted, topic))
            else:
                then = partial(self._take_publishers, topic)
                self._rosapi.ask_publishers(topic, then)
        elif not self._rosapi.is_there and topic not in self._subscriptions:
            self._subscribe(topic, wire.TYPES_BY_NAME.get(topic, ""), None)

    def _prepare_wanted(self, topic: str) -> None:
        if topic in self._wanted:
            self._prepare(topic)

    def _take_publishers(self, topic: str, has_publishers: bool | None) -> None:
        type_name = self._rosapi.types.get(topic)
        if topic not in self._wanted or type_name is None:
            return
        subscription = self._subscriptions.get(topic)
        if subscription is None:
            self._subscribe(topic, type_name, has_publishers)
        elif subscription.had_publishers is False and has_publishers:
            self._unsubscribe(topic)
            self._subscribe(topic, type_name, has_publishers)
        elif has_publishers is False:
            subscription.had_publishers = False

    def _subscribe(
        self, topic: str, type_name: str, has_publishers: bool | None
    ) -> None:
        name = f"sambot-viz-{next(self._ids)}"
        self._subscriptions[topic] = _Subscription(name, type_name, has_publishers)
        is_latched = is_latched_name(topic)
        self.ends.send(wire.subscribe(name, topic, type_name, is_latched=is_latched))

    def _unsubscribe(self, topic: str) -> None:
        subscription = self._subscriptions.pop(topic, None)
        if subscription is not None:
            self.ends.send(wire.unsubscribe(subscription.name, topic))


def _name_of(outgoing: OutgoingTopic) -> str:
    """Return what the server knows a published topic by."""
    return f"sambot-viz-topic-{outgoing.number}"

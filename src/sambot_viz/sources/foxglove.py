"""Foxglove's websocket protocol: foxglove_bridge, or a server of Foxglove's SDK.

Schemas, files, parameters and the graph come over the same connection. What goes out is
CDR; its QoS is the bridge's. No parameter is set.
"""

from __future__ import annotations

import re
import time
from itertools import count

from sambot_viz import limits
from sambot_viz.errors import SourceError
from sambot_viz.messages import Schema
from sambot_viz.sources import foxglove_wire as wire
from sambot_viz.sources.action_names import (
    result_service,
    send_service,
    status_topic,
)
from sambot_viz.sources.foxglove_services import FoxgloveServices
from sambot_viz.sources.live.conversation import Conversation, Ends
from sambot_viz.sources.live.hidden_action import HiddenAction
from sambot_viz.sources.live.outgoing_topic import OutgoingTopic
from sambot_viz.sources.message import (
    Recorded,
    SourceTopic,
    TopicChannel,
    is_latched_name,
)
from sambot_viz.sources.source import (
    Capability,
    Encoding,
    OutgoingAction,
    Receivers,
    Source,
)
from sambot_viz.sources.websocket.trouble import NewSession, WrongServer, other_protocol
from sambot_viz.text import text

_ALLOW = (
    "if the file is there, add a pattern for it to the parameter "
    "`asset_uri_allowlist` of foxglove_bridge"
)
_OFFERS: dict[str, Capability] = {
    "assets": "files",
    "clientPublish": "publish",
    "connectionGraph": "graph",
}
"""What the server calls them → what they are here."""
_ERROR = 2
"""The level of a line of the server."""
_UNKNOWN_CHANNEL = re.compile(r"[Uu]nknown channel\D{0,9}(\d{1,18})")
_DESCRIPTION = "robot_description"
_TICKS_FOR_TOPICS = 2
_LINE_LASTS = 30.0
_MOST_NOTES = 3


class FoxgloveConversation(Conversation):
    """One connection to a Foxglove server."""

    publishes: Encoding = "cdr"

    def __init__(self, ends: Ends) -> None:
        super().__init__(ends)
        self._services = FoxgloveServices(ends)
        self.calls = self._services.calls
        self._encodings: tuple[str, ...] = ()
        self._outgoing: dict[int, OutgoingTopic] = {}
        self._subscribers: dict[str, tuple[str, ...]] = {}
        self._channels: dict[int, TopicChannel] = {}
        self._by_topic: dict[str, list[int]] = {}
        self._publishers: dict[str, tuple[str, ...]] = {}
        self._subscriptions: dict[int, int] = {}  # id of the subscription by channel
        self._subscribed: dict[
            int, TopicChannel
        ] = {}  # channel by id of the subscription
        self._begun: set[int] = set()
        self._ids = count(1)
        self._wanted: frozenset[str] = frozenset()
        # Descriptions that no topic has and a parameter may have.
        self._asked: set[str] = set()
        self._from_parameters: dict[str, TopicChannel] = {}
        self._ticks = 0
        # What the server says about itself: by id until it takes it back; without one
        # it is an event, and shown for a while.
        self._lines: dict[str, str] = {}
        self._line = ""
        self._line_end = 0.0

    def begin(self) -> None:
        """Say nothing: the server speaks first."""

    def receive(self, frame: str | bytes) -> None:
        """Accept a frame; malformed ones are counted."""
        try:
            if isinstance(frame, bytes):
                self._binary(frame)
            else:
                self._text(frame)
        except wire.Malformed:
            self.unreadable += 1

    def topic_of(self, head: bytes) -> str:
        """Return the topic of a message that was too large; refuse such a file."""
        try:
            parsed = wire.parse_binary(head)
        except wire.Malformed:
            return ""
        if isinstance(parsed, wire.MessageFrame):
            channel = self._subscribed.get(parsed.subscription_id)
            return channel.topic if channel is not None else ""
        if isinstance(parsed, wire.AssetFrame):
            why = f"a frame may hold {limits.MESSAGE.value:,} bytes, the file has more"
            self.ends.assets.answer(parsed.request_id, b"", why, "")
        return ""

    @property
    def offers(self) -> frozenset[Capability]:
        """What the server can do: files, publish and graph."""
        told: set[Capability] = {
            _OFFERS[name] for name in self.capabilities & _OFFERS.keys()
        }
        if self.unpublishable:
            told.discard("publish")
        return frozenset(told)

    @property
    def unpublishable(self) -> str:
        """Why nothing can be published, with the remedy; empty when it can be."""
        label = self.ends.address.label
        if "clientPublish" not in self.capabilities:
            return (
                f"the server at {label} takes no messages; with foxglove_bridge, add "
                "clientPublish to its parameter `capabilities`"
            )
        if self._encodings and self.publishes not in self._encodings:
            takes = text(", ".join(self._encodings), 80)
            return f"the server at {label} takes {takes}, and not the CDR of ROS 2"
        return ""

    def advertise(self, outgoing: OutgoingTopic) -> None:
        """Tell the server of a topic that is published."""
        outgoing.number = next(self._ids)
        self._outgoing[outgoing.number] = outgoing
        self._note_receivers()
        self.ends.send(
            wire.advertise(outgoing.number, outgoing.topic, outgoing.type_name)
        )

    def publish(self, outgoing: OutgoingTopic, message: bytes) -> None:
        """Send a message."""
        if outgoing.number in self._outgoing:
            self.ends.send(wire.published(outgoing.number, message))

    def unadvertise(self, outgoing: OutgoingTopic) -> None:
        """Tell the server that a topic is published no longer."""
        if self._outgoing.pop(outgoing.number, None) is not None:
            self.ends.send(wire.unadvertise(outgoing.number))

    def action(self, name: str, type_name: str, source: Source) -> OutgoingAction:
        """Return an action whose hidden services and topics the server shows."""
        self._services.require(send_service(name))
        self._services.require(result_service(name))
        if status_topic(name) not in source.topics():
            label = self.ends.address.label
            raise SourceError(f"the server at {label} does not show {text(name, 80)}")
        return HiddenAction(name, type_name, source, self.goals)

    def update(self, wanted: frozenset[str]) -> None:
        """Subscribe to the channels of the wanted topics, and to no others."""
        gone = self._wanted - wanted
        self._wanted = wanted
        for topic in gone:
            for channel_id in self._by_topic.get(topic, ()):
                self._unsubscribe(channel_id)
        self._subscribe_missing()
        for topic in gone & self._from_parameters.keys():
            del self._from_parameters[topic]
            self._asked.discard(topic)
            self.topics_changed = True
        self._ask_for_assets()

    def tick(self, now: float) -> None:
        """Let lines of the server that have no id end after a while."""
        if now > self._line_end:
            self._line = ""
        self.calls.tick(now)
        # The bridge advertises topics one after the other; it is given a moment.
        if self.is_ready and "parameters" in self.capabilities:
            self._ticks += 1
            if self._ticks > _TICKS_FOR_TOPICS:
                self._ask_for_descriptions()

    def silence(self) -> str:
        """Return the sentence for a server that does not say who it is."""
        return (
            f"{self.ends.address.label} does not speak Foxglove's protocol: if "
            f"rosbridge runs there, {other_protocol(self.ends.address)}"
        )

    def notes(self) -> list[str]:
        """Return the server's warnings, and sentences about left out topics."""
        lines = [*self._lines.values(), *([self._line] if self._line else [])]
        notes = [f"it says: {text(line, 200)}" for line in lines[-_MOST_NOTES:]]
        if len(self._channels) >= limits.TOPICS.value:
            notes.append(
                f"only the first {limits.TOPICS.value} of its topics are listed"
            )
        return notes

    def topics(self) -> dict[str, SourceTopic]:
        """Return a topic for each name; of several channels the first counts."""
        found: dict[str, SourceTopic] = {}
        tells = "connectionGraph" in self.capabilities
        has_graph = tells and self._publishers
        has_readers = tells and (self._publishers or self._subscribers)
        for name, ids in self._by_topic.items():
            channel = self._channels[ids[0]]
            found[name] = SourceTopic(
                name,
                channel.schema,
                channel.message_encoding,
                qos=channel.qos,
                is_latched=channel.is_latched,
                publishers=self._publishers.get(name, ()) if has_graph else None,
                subscribers=self._subscribers.get(name, ()) if has_readers else None,
                left_out=self.left_out(name),
            )
        for name, channel in self._from_parameters.items():
            if name not in found:
                found[name] = SourceTopic(
                    name,
                    channel.schema,
                    channel.message_encoding,
                    is_latched=True,
                    publishers=(f"parameter of {_publisher_of(name)}",),
                )
        return found

    def _binary(self, frame: bytes) -> None:
        parsed = wire.parse_binary(frame)
        if isinstance(parsed, wire.MessageFrame):
            channel = self._subscribed.get(parsed.subscription_id)
            if channel is not None:
                # The first may be a latched one, which was logged long ago.
                if parsed.subscription_id in self._begun:
                    self.ends.clock.note_message(parsed.log_ns)
                self._begun.add(parsed.subscription_id)
                self.ends.put(
                    Recorded(
                        channel.topic, channel, parsed.log_ns, None, parsed.payload
                    )
                )
        elif isinstance(parsed, wire.TimeFrame):
            self.ends.clock.note_time(parsed.time_ns)
        elif isinstance(parsed, wire.AssetFrame):
            self.ends.assets.answer(
                parsed.request_id, parsed.content, parsed.error, _ALLOW
            )
            self._ask_for_assets()
        elif isinstance(parsed, wire.ServiceFrame):
            self._services.answered(parsed)

    def _text(self, frame: str) -> None:
        parsed = wire.parse_text(frame)
        self.unreadable += parsed.malformed
        content = parsed.content
        if isinstance(content, wire.ServerInfo):
            self._server_info(content)
        elif isinstance(content, wire.Unadvertised):
            for channel_id in content.channel_ids:
                self._remove(channel_id)
        elif isinstance(content, wire.ParameterValues):
            for parameter in content.parameters:
                self._parameter(parameter)
        elif isinstance(content, wire.ServerStatus):
            self._status(content)
        elif isinstance(content, wire.StatusesRemoved):
            for line_id in content.status_ids:
                self._lines.pop(line_id, None)
        elif isinstance(content, wire.GraphUpdate):
            self._graph(content)
        elif isinstance(content, wire.ServiceFailure):
            self._services.answered(content)
        elif isinstance(content, wire.ServicesAdvertised | wire.ServicesUnadvertised):
            self._services.take(content)
        elif isinstance(content, wire.Advertised):
            for channel in content.channels:
                self._add(channel)
        elif not self.is_ready and content is None:
            raise WrongServer(self.silence())

    def _server_info(self, info: wire.ServerInfo) -> None:
        if self.is_ready and info.session_id != self.session_id:
            # Its channels may have other ids now, and not all servers advertise them
            # again: a new connection gets them all.
            raise NewSession(f"{self.ends.address.label} has started again")
        self.is_ready = True
        self.server, self.session_id = info.name, info.session_id
        self.capabilities = frozenset(info.capabilities)
        self._encodings = info.supported_encodings
        self._services.are_offered = "services" in self.capabilities
        if self.ends.session_id != info.session_id:
            self.ends.assets.forget()
        if "connectionGraph" in self.capabilities:
            self.ends.send(wire.subscribe_connection_graph())
        self._ask_for_assets()

    def _add(self, server_channel: wire.ServerChannel) -> None:
        if len(self._channels) >= limits.TOPICS.value:
            return
        self._remove(server_channel.id)
        topic = server_channel.topic
        self._channels[server_channel.id] = TopicChannel(
            topic,
            server_channel.definition(),
            server_channel.encoding,
            qos=server_channel.qos,
            is_latched=is_latched_name(topic),
        )
        self._by_topic.setdefault(topic, []).append(server_channel.id)
        self.topics_changed = True
        self._note_receivers()

    def _remove(self, channel_id: int) -> None:
        channel = self._channels.get(channel_id)
        if channel is None:
            return
        # The server has ended the subscription together with the channel.
        self._forget_subscription(channel_id)
        del self._channels[channel_id]
        ids = self._by_topic[channel.topic]
        ids.remove(channel_id)
        if not ids:
            del self._by_topic[channel.topic]
        self.topics_changed = True

    def _subscribe_missing(self) -> None:
        """Subscribe to wanted channels, a moment after they were advertised.

        The server advertises a channel before it takes subscriptions to it.
        """
        for topic in self._wanted & self._by_topic.keys():
            for channel_id in self._by_topic[topic]:
                if channel_id not in self._subscriptions:
                    self._subscribe(channel_id)

    def _subscribe(self, channel_id: int) -> None:
        subscription = next(self._ids)
        self._subscriptions[channel_id] = subscription
        self._subscribed[subscription] = self._channels[channel_id]
        self.ends.send(wire.subscribe(subscription, channel_id))

    def _unsubscribe(self, channel_id: int) -> None:
        subscription = self._forget_subscription(channel_id)
        if subscription is not None:
            self.ends.send(wire.unsubscribe(subscription))

    def _forget_subscription(self, channel_id: int) -> int | None:
        subscription = self._subscriptions.pop(channel_id, None)
        if subscription is not None:
            del self._subscribed[subscription]
        return subscription

    def _graph(self, update: wire.GraphUpdate) -> None:
        for topic in update.published_topics:
            if (
                topic.name in self._publishers
                or len(self._publishers) < limits.TOPICS.value
            ):
                self._publishers[topic.name] = topic.publisher_ids
        for topic in update.subscribed_topics:
            known = topic.name in self._subscribers
            if known or len(self._subscribers) < limits.TOPICS.value:
                self._subscribers[topic.name] = topic.subscriber_ids
        for name in update.removed_topics:
            self._publishers.pop(name, None)
            self._subscribers.pop(name, None)
        self.topics_changed = True
        self._note_receivers()

    def _note_receivers(self) -> None:
        """Note who has subscribed to the topics that are published."""
        has_graph = "connectionGraph" in self.capabilities
        for outgoing in self._outgoing.values():
            ids = self._by_topic.get(outgoing.topic)
            type_name = self._channels[ids[0]].schema.name if ids else ""
            names = self._subscribers.get(outgoing.topic, ()) if has_graph else None
            outgoing.receivers = Receivers(names, type_name)

    def _ask_for_descriptions(self) -> None:
        """Ask for a robot's description by name; nothing waits for the answer.

        A request for all parameters would make some bridges ask nodes that are gone.
        """
        for topic in self._wanted - self._by_topic.keys() - self._asked:
            if topic.endswith(_DESCRIPTION):
                self._asked.add(topic)
                names = [_publisher_of(topic) + "." + _DESCRIPTION, topic]
                self.ends.send(wire.get_parameters(names, topic))

    def _parameter(self, parameter: wire.ParameterValue) -> None:
        for topic in self._asked - self._by_topic.keys():
            names = (_publisher_of(topic) + "." + _DESCRIPTION, topic)
            if parameter.name in names and isinstance(parameter.value, str):
                self._describe(topic, parameter.value)

    def _describe(self, topic: str, description: str) -> None:
        if topic not in self._from_parameters:
            schema = Schema("std_msgs/msg/String", "ros2msg", "string data\n")
            channel = TopicChannel(topic, schema, "cdr", is_latched=True)
            self._from_parameters[topic] = channel
            self.topics_changed = True
        content = description.encode("utf-8", "replace") + b"\0"
        # As a node would publish it, so that no other code sees a difference.
        payload = b"\0\1\0\0" + len(content).to_bytes(4, "little") + content
        now = self.ends.clock.now_ns()
        channel = self._from_parameters[topic]
        self.ends.put(Recorded(topic, channel, now, None, payload))

    def _status(self, status: wire.ServerStatus) -> None:
        if status.level >= _ERROR:
            self._note_refusal(status.message)
        if refused := _UNKNOWN_CHANNEL.search(status.message):
            # The next update subscribes again.
            self._forget_subscription(int(refused[1]))
        elif status.level >= 1:
            self._note(status)

    def _note_refusal(self, line: str) -> None:
        """Note an error of the server for the topic that it is about."""
        every = self._outgoing.values()
        about = [one for one in every if one.topic in line] or [*every]
        if len(about) == 1:
            about[0].refused = line

    def _note(self, status: wire.ServerStatus) -> None:
        if status.id is None:
            self._line = status.message
            self._line_end = time.monotonic() + _LINE_LASTS
        elif status.id in self._lines or len(self._lines) < limits.PEER_LINES.value:
            self._lines[status.id] = status.message

    def _ask_for_assets(self) -> None:
        if not self.is_ready:
            return
        if "assets" in self.capabilities:
            for request_id, uri in self.ends.assets.to_ask():
                self.ends.send(wire.fetch_asset(uri, request_id))
        else:
            self.ends.assets.refuse_all(
                f"the server at {self.ends.address.label} hands out no files",
                "with foxglove_bridge, add assets to its parameter `capabilities`",
            )


def _publisher_of(topic: str) -> str:
    """Return the node that has the description of a topic as a parameter."""
    return topic.removesuffix(_DESCRIPTION) + "robot_state_publisher"

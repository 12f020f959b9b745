"""The topics and nodes at the other side of a rosbridge, from the node rosapi.

rosapi announces nothing by itself: topics, definitions of their messages and publishers
are polled, and a server without it answers late or never.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import count
from typing import TypeVar

from sambot_viz import limits
from sambot_viz.sources import rosbridge_wire as wire

POLL = 2.0
"""Between two looks at the topics [s]."""
POLL_ABSENT = 5.0
"""The same while rosapi does not run [s]: each look is an error in the server's log."""
LONGEST_ANSWER = 8.0
"""A service that has not answered after so long will not [s]."""

_Answer = Callable[[wire.ServiceResponse | None], None]
_T = TypeVar("_T")


class Rosapi:
    """Asks rosapi, and keeps what it has answered.

    Args:
        send: sends an operation.
        on_list: called when the topics were listed again, or cannot be.

    Attributes:
        is_there: it answers; so until it is known that it does not.
        types: type by topic.
        definitions: full text of the definition by type; "" when there is none.
        publishers: names by topic, of those that were asked for.
        has_changed: set when one of these has; cleared by who reads it.
    """

    def __init__(
        self, send: Callable[[str], None], on_list: Callable[[], None]
    ) -> None:
        self.is_there = True
        self.types: dict[str, str] = {}
        self.definitions: dict[str, str] = {}
        self.publishers: dict[str, tuple[str, ...]] = {}
        self.has_changed = False
        self._send = send
        self._on_list = on_list
        self._calls: dict[str, tuple[_Answer, float]] = {}
        self._ids = count(1)
        self._now = time.monotonic()
        self._next_poll = 0.0
        self._has_raw_types = True
        self._is_polling = False

    def poll(self) -> None:
        """Ask for the topics, and the first time for all definitions."""
        self._is_polling = True
        if self._has_raw_types and not self.types:
            self._call("/rosapi/topics_and_raw_types", self._take_raw_topics)
        else:
            self._call("/rosapi/topics", self._take_topics)

    def take(self, response: wire.ServiceResponse) -> bool:
        """Take an answer; return whether it was asked for."""
        answer, _ = self._calls.pop(response.id, (None, 0.0))
        if answer is not None:
            answer(response)
        return answer is not None

    def tick(self, now: float) -> bool:
        """Ask again when it is time; return whether an answer was given up."""
        self._now = now
        late = [call for call, (_, due) in self._calls.items() if 0.0 < due < now]
        for call, (answer, due) in list(self._calls.items()):
            if due == 0.0:
                self._calls[call] = (answer, now + LONGEST_ANSWER)
        for call in late:
            self._calls.pop(call)[0](None)
        if now >= self._next_poll and not self._is_polling:
            self.poll()
        return bool(late)

    def needs_details(self, topic: str) -> bool:
        """Return whether the definition of a topic is still to be asked for."""
        return self.types[topic] not in self.definitions and not self._has_raw_types

    def ask_details(self, topic: str, then: Callable[[], None]) -> None:
        """Ask for the definition of the messages of a topic, once."""
        type_name = self.types[topic]
        self.definitions[type_name] = ""

        def take(response: wire.ServiceResponse | None) -> None:
            if found := _values(response, wire.MessageDetails):
                self.definitions[type_name] = wire.text_of_details(found)
                self.has_changed = True
            then()

        self._call("/rosapi/message_details", take, type=type_name)

    def ask_publishers(self, topic: str, then: Callable[[bool | None], None]) -> None:
        """Ask who publishes a topic; `then` gets None if that cannot be known."""

        def take(response: wire.ServiceResponse | None) -> None:
            found = _values(response, wire.PublisherList)
            if found is None:
                self.publishers.pop(topic, None)
            elif self.publishers.get(topic) != found.publishers and (
                topic in self.types
            ):
                self.publishers[topic] = found.publishers
                self.has_changed = True
            then(None if found is None else bool(found.publishers))

        if len(self._calls) < limits.CALLS.value:
            self._call("/rosapi/publishers", take, topic=topic)

    def ask_subscribers(
        self, topic: str, then: Callable[[tuple[str, ...] | None], None]
    ) -> None:
        """Request the subscribers of a topic; `then` gets None if they are unknown."""

        def take(response: wire.ServiceResponse | None) -> None:
            found = _values(response, wire.SubscriberList)
            then(None if found is None else found.subscribers)

        if len(self._calls) < limits.CALLS.value:
            self._call("/rosapi/subscribers", take, topic=topic)

    def _take_raw_topics(self, response: wire.ServiceResponse | None) -> None:
        found = _values(response, wire.TopicList)
        if found is None:
            self._has_raw_types = False
            self._call("/rosapi/topics", self._take_topics)
            return
        types = found.types[: limits.TOPICS.value]
        texts = zip(types, found.typedefs_full_text, strict=False)
        self.definitions = dict.fromkeys(types, "") | dict(texts)
        self._take_list(found)

    def _take_topics(self, response: wire.ServiceResponse | None) -> None:
        found = _values(response, wire.TopicList)
        if found is None:
            self.is_there = bool(self.types)
            self._finish_poll()
            return
        new = set(found.types[: limits.TOPICS.value]) - self.definitions.keys()
        if new and self._has_raw_types:
            self._call("/rosapi/topics_and_raw_types", self._take_raw_topics)
        else:
            self._take_list(found)

    def _take_list(self, found: wire.TopicList) -> None:
        self.is_there = True
        topics = found.topics[: limits.TOPICS.value]
        types = dict(zip(topics, found.types, strict=False))
        self.has_changed = self.has_changed or types != self.types
        self.types = types
        for topic in self.publishers.keys() - types.keys():
            del self.publishers[topic]
        self._finish_poll()

    def _finish_poll(self) -> None:
        self._is_polling = False
        self._next_poll = self._now + (POLL if self.is_there else POLL_ABSENT)
        self._on_list()

    def _call(self, service: str, answer: _Answer, **arguments: object) -> None:
        call = f"sambot-viz-call-{next(self._ids)}"
        # Its time begins at the next tick.
        self._calls[call] = (answer, 0.0)
        self._send(wire.call_service(call, service, **arguments))


def _values(response: wire.ServiceResponse | None, kind: type[_T]) -> _T | None:
    try:
        return wire.decode_values(response, kind)
    except wire.MalformedOperation:
        return None

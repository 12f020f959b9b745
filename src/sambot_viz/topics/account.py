"""The account of a topic: received, decoded, placed, drawn; or why not.

Each step is written by the code that does it: the source, the decoder, the placement of
frames, and the displays. Everything that reports it reads it here: the lists of topics
in the page and on the command line, statuses, problems and programs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Protocol

from sambot_viz.messages import Decoder
from sambot_viz.sources.message import SourceTopic
from sambot_viz.topics import reasons
from sambot_viz.topics.looked import Looked
from sambot_viz.topics.reasons import TopicReason


@dataclass(frozen=True, slots=True)
class Account:
    """The account of a topic.

    Attributes:
        name: the topic.
        type_name: the type of its messages; empty if unknown.
        count: number of its messages; None while unknown.
        rate: rate of its messages [Hz]; None for fewer than two.
        readable: whether messages of this type and encoding can be decoded.
        reason: why it shows nothing, or a note about it; None without one.
    """

    name: str
    type_name: str
    count: int | None
    rate: float | None
    readable: bool
    reason: TopicReason | None


@dataclass(frozen=True, slots=True)
class Drawing:
    """What displays do with a topic.

    Attributes:
        reason: why they show nothing of it; None when one does.
        has_looked: one of them looks at the messages, and knows better than anybody
            else whether they can be drawn where they are.
    """

    reason: TopicReason | None
    has_looked: bool = False


DrawingOf = Callable[[str, str], Drawing]
"""Topic and type of its messages → what displays do with it."""


class Evidence(Protocol):
    """The facts about the topics of a source, from a recording or a robot."""

    def topic(self, name: str) -> SourceTopic:
        """Return what the source says of a topic."""
        ...

    def decoder(self, name: str) -> Decoder:
        """Return the decoder of its messages, or the reason why there is none."""
        ...

    def looked(self, name: str) -> Looked:
        """Return what was seen of its messages."""
        ...

    def unreceived(self, name: str) -> TopicReason | None:
        """Return why nothing comes of it."""
        ...

    def of_robot(self, name: str) -> TopicReason | None:
        """Return the fault of its transforms or its robot, or what hides them."""
        ...

    def to_come(self, name: str) -> TopicReason | None:
        """Return that it begins later."""
        ...

    def unplaced(self, name: str) -> TopicReason | None:
        """Return why its frame has no place, where no display has looked for it."""
        ...

    def silent(self, name: str) -> TopicReason | None:
        """Return that its messages come no more."""
        ...


def account_of(
    evidence: Evidence,
    name: str,
    count: int | None,
    rate: float | None,
    drawing: Drawing | None = None,
) -> Account:
    """Return the account of a topic.

    Args:
        evidence: the facts about it.
        name: the topic.
        count: number of its messages; None while unknown.
        rate: rate of its messages [Hz]; None for fewer than two.
        drawing: what displays do with it; None without displays.
    """
    decoder, topic = evidence.decoder(name), evidence.topic(name)
    found = _reasons(evidence, name, decoder, drawing)
    return Account(
        name,
        decoder.type_name or topic.schema.name,
        count,
        rate,
        decoder.reason is None and topic.reason is None,
        next((one for one in found if one is not None), None),
    )


def unheard(evidence: Evidence, name: str) -> TopicReason | None:
    """Return why a topic gives a display nothing, or less than it should.

    This is the part of the account that does not depend on displays.
    """
    found = (
        evidence.unreceived(name),
        unread(evidence.decoder(name)),
        evidence.looked(name).undecodable(evidence.topic(name).count),
        evidence.silent(name),
    )
    return next((one for one in found if one is not None), None)


def unread(decoder: Decoder) -> TopicReason | None:
    """Return why the messages of a topic cannot be decoded."""
    reason = decoder.reason
    return None if reason is None else TopicReason(reason.code, reason.text)


def _reasons(
    evidence: Evidence, name: str, decoder: Decoder, drawing: Drawing | None
) -> Iterator[TopicReason | None]:
    """Yield what may be said of a topic, that which matters most first."""
    looked = evidence.looked(name)
    yield evidence.unreceived(name)
    yield unread(decoder)
    yield looked.undecodable(evidence.topic(name).count)
    yield evidence.of_robot(name)
    drawing = drawing or Drawing(None)
    if not drawing.has_looked and reasons.drawn_by(name, decoder.type_name) is None:
        drawing = Drawing(reasons.no_display(decoder.type_name, looked.fields))
    if (to_come := evidence.to_come(name)) is not None:
        # A topic that no display draws is not worth waiting for.
        yield None if drawing.has_looked else drawing.reason
        yield to_come
    if not drawing.has_looked:
        nothing = looked.nothing
        # A topic that is not drawn in a frame needs no transform.
        yield nothing if nothing is not None and nothing.code == "not-drawn" else None
        yield evidence.unplaced(name)
        yield nothing
    yield drawing.reason
    yield evidence.silent(name)
    if decoder.note is not None:
        yield TopicReason(decoder.note.code, decoder.note.text)

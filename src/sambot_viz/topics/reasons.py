"""Why a topic shows nothing: one short sentence, with the remedy.

Each function says one reason, or None where it does not hold. Which one is said when
several hold is the order in `report.py`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

from sambot_viz.errors import Severity, did_you_mean, nearest
from sambot_viz.frames.frame_errors import LookupRefused
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.topics.robot_topics import describes_robot

SEVERITIES: Mapping[str, Severity] = {
    "no-such-topic": "warning",
    "no-publisher": "warning",
    "no-message": "warning",
    "not-listened": "info",
    "qos": "warning",
    "encoding": "warning",
    "type-unknown": "warning",
    "not-decodable": "warning",
    "left-out": "warning",
    "not-here-yet": "info",
    "definition-wrong": "info",
    "two-clocks": "warning",
    "no-transform": "warning",
    "empty": "warning",
    "not-drawn": "warning",
    "no-display": "info",
    "wrong-type": "warning",
    "off": "info",
    "stale": "warning",
    "lagging": "warning",
}
"""All reasons of topics."""

STALE = 5.0
"""A topic that was silent for so long, and three of its periods, is said to be [s]."""
_FIELDS = 6
_HOUR = 3600.0


@dataclass(frozen=True, slots=True)
class TopicReason:
    """Why a topic shows nothing, or what to know about what it shows.

    Attributes:
        code: one of `SEVERITIES`.
        text: a sentence with the remedy, without the name of the topic in front and
            without a full stop.
    """

    code: str
    text: str

    @property
    def severity(self) -> Severity:
        """How bad it is."""
        return SEVERITIES.get(self.code, "warning")


def display_of(name: str, type_name: str) -> str | None:
    """Return the class of the display that draws a topic; None when there is none."""
    meaning = meaning_of(type_name)
    if meaning is Meaning.TEXT and not describes_robot(name, type_name):
        return None
    return None if meaning is None else meaning.display


def drawn_by(name: str, type_name: str) -> str | None:
    """Return the class of the display that draws a topic, alone or beside another one.

    Updates of a map have no display: that of their map draws them.
    """
    if meaning_of(type_name) is Meaning.GRID_UPDATE:
        return Meaning.GRID.display
    return display_of(name, type_name)


def no_such_topic(name: str, known: Iterable[str]) -> TopicReason:
    """Say that a topic that was named is not there, and which one was meant."""
    there = did_you_mean(name, known)
    return TopicReason("no-such-topic", f"there is no topic {name}; {there}")


def meant_topic(name: str, known: Sequence[str]) -> str:
    """Return the topic that was meant by a name that is none; empty for no idea.

    One that is not like it is meant all the same where there is no other.
    """
    return nearest(name, known) or (known[0] if len(known) == 1 else "")


def wrong_type(wanted: str, type_name: str) -> TopicReason:
    """Say that a display wants other messages."""
    text = f"the display draws {wanted}, this is {type_name}: choose another topic"
    return TopicReason("wrong-type", text)


def off(display: str) -> TopicReason:
    """Say that what draws the topic is switched off."""
    return TopicReason("off", f"the display {display} is off: tick its box")


def no_message(name: str) -> TopicReason:
    """Say that a topic was recorded, and nothing came."""
    return TopicReason(
        "no-message",
        "no message was recorded: nothing was published, or with another QoS than the "
        f"recorder wanted (ros2 topic info -v {name})",
    )


def left_out(what: str) -> TopicReason:
    """Say what of a recorded topic is too large, or in a part that is damaged."""
    return TopicReason("left-out", what)


def not_here_yet(begins: float, latched: bool) -> TopicReason:
    """Say when the first message comes.

    Args:
        begins: from the first message of the recording [s].
        latched: it holds from the start all the same.
    """
    how = (
        "it is used from the start, as it is latched"
        if latched
        else f"go there with the time bar or --at {begins:.1f}"
    )
    return TopicReason("not-here-yet", f"begins at {begins:.1f} s ({how})")


def not_decodable(
    bad: int, looked: int, cause: str, is_all: bool, *, is_live: bool = False
) -> TopicReason:
    """Say how many messages cannot be decoded.

    Args:
        bad: so many of those that were looked at.
        looked: so many were looked at.
        cause: why, of the first of them.
        is_all: there are no more messages.
        is_live: a robot sends them now.
    """
    of = f"{looked}" if is_all else f"the first {looked}"
    remedy = "look at what publishes it" if is_live else "record it again"
    left = remedy if bad == looked else "they are left out"
    are = "message" if looked == 1 else "messages"
    text = f"{bad} of {of} {are} cannot be decoded ({cause}): {left}"
    return TopicReason("not-decodable", text)


def two_clocks(name: str, stamp: float, others: tuple[float, float]) -> TopicReason:
    """Say that stamps are far from those of the transforms.

    Args:
        name: of the topic.
        stamp: of a message [s].
        others: the first and the last stamp of /tf [s].
    """
    first, last = others
    return TopicReason(
        "two-clocks",
        f"{name} is stamped {stamp:.1f}, /tf between {first:.1f} and {last:.1f}: one "
        "of the two nodes has the wrong use_sim_time",
    )


def are_two_clocks(stamp: float, others: tuple[float, float]) -> bool:
    """Tell whether a stamp is of another clock: more than an hour from all of /tf."""
    first, last = others
    return stamp < first - _HOUR or stamp > last + _HOUR


def no_transform(
    frame: str,
    fixed_frame: str,
    refused: LookupRefused,
    *,
    lacks_static: bool = False,
    remedy: str = "",
) -> TopicReason:
    """Say that the frame of the messages has no place.

    Args:
        frame: of the messages.
        fixed_frame: where it was looked for.
        refused: tf2's answer.
        lacks_static: there are transforms, but the recording has no /tf_static.
        remedy: what to do about the transforms, where that is known already.
    """
    if lacks_static and refused.times is None:
        why = (
            "/tf_static is not in this recording; record it too (ros2 bag record -a, "
            "or name it)"
        )
    else:
        why = f"{refused.tf2_text} ({remedy or _remedy(refused)})"
    return TopicReason(
        "no-transform", f"no transform from [{frame}] to [{fixed_frame}]: {why}"
    )


def transforms_begin(seconds: float, is_later: bool) -> str:
    """Say what to do about a time before the first transform.

    Args:
        seconds: when that comes [s from the first message].
        is_later: it is still to come.
    """
    begin = f"transforms begin at {seconds:.1f} s"
    if is_later:
        return f"{begin}: go there with the time bar or --at {seconds:.1f}"
    return f"{begin}, and this message is from before: go on to the next one"


def older_than_buffer(seconds: float, duration: float) -> str:
    """Say what to do about a message that is older than all that tf2 keeps.

    Args:
        seconds: by how much [s].
        duration: so much is kept [s].
    """
    return (
        f"tf2 keeps {duration:.0f} s, and the message is {seconds:.1f} s older: what "
        "publishes it is too slow, or stamps it with another clock"
    )


def behind(seconds: float, is_last: bool) -> str:
    """Say what to do about a message after the last transform.

    Args:
        seconds: by how much [s].
        is_last: no transform comes after that.
    """
    if is_last:
        return (
            f"the last transform is {seconds:.1f} s older than the message: what "
            "publishes it had stopped, go back in time"
        )
    return (
        f"the newest transform is {seconds:.1f} s older than the message: what "
        "publishes it is late, or the clocks of the two nodes differ"
    )


def _remedy(refused: LookupRefused) -> str:
    if refused.times is not None:
        return (
            "the transforms on the way have no time in common: one of their nodes had "
            "stopped before another began, or their clocks differ"
        )
    if refused.reason == "ring":
        return "two nodes publish against each other: see the Problems"
    between = f"{refused.target} {refused.source}"
    return (
        "add it: --static-transform, or ros2 run tf2_ros static_transform_publisher "
        f"0 0 0 0 0 0 {between}"
    )


def empty(what: str) -> TopicReason:
    """Say that messages come, and nothing is in them."""
    return TopicReason("empty", f"{what}: look at what publishes it")


def not_drawn(why: str) -> TopicReason:
    """Say that messages come, and their display cannot draw them."""
    return TopicReason("not-drawn", f"cannot be shown: {why}")


def no_display(type_name: str, fields: Collection[str]) -> TopicReason:
    """Say that nothing draws messages of a type, and what they have."""
    if type_name.endswith("_Event") and "/srv/" in type_name:
        return TopicReason(
            "no-display", "events of a service: there is nothing to draw"
        )
    if meaning_of(type_name) is Meaning.GRID_UPDATE:
        return TopicReason("no-display", "Map draws it with its map: add that topic")
    named = type_name or "messages without a type"
    listed = [*fields][:_FIELDS]
    more = ", …" if len(fields) > len(listed) else ""
    has = f"; its fields are {', '.join(listed)}{more}" if listed else ""
    return TopicReason("no-display", f"nothing draws {named} yet{has}")


def stale(age: float) -> TopicReason:
    """Say that nothing has come for long, on the clock of the recording [s]."""
    text = f"the last message came {age:.1f} s ago: whatever publishes it had stopped"
    return TopicReason("stale", text)

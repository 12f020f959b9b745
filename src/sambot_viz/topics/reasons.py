"""The reasons why a topic shows nothing: one short sentence each, with the remedy.

Each function returns one reason, or None if it does not hold, for recordings and live
robots alike. If several hold, the order in `account.py` decides.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

from sambot_viz.errors import Severity, did_you_mean, nearest
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.sources.message import SourceTopic
from sambot_viz.sources.qos import Qos
from sambot_viz.text import text
from sambot_viz.topics.robot_topics import describes_robot

SEVERITIES: Mapping[str, Severity] = {
    "no-such-topic": "warning",
    "no-publisher": "warning",
    "awaited": "info",
    "no-message": "warning",
    "not-connected": "info",
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
    "ended": "info",
    "lagging": "warning",
    "topic-hidden": "warning",
    "tf-loop": "warning",
    "two-parents": "warning",
}
"""All reasons of topics."""

OF_PARENTS = ("tf-loop", "two-parents")
"""Reasons of transforms that are problems of the whole tree."""
QOS_WORDS = {
    "reliable": "Reliable",
    "best_effort": "Best Effort",
    "transient_local": "Transient Local",
    "volatile": "Volatile",
}
"""RViz's words for what ROS offers."""
STALE, PERIODS = 5.0, 3
"""A topic that was silent for this time [s], and this number of periods, is stale."""
_FIELDS = 6
_NAMES = 3
_LOOK = "look at what publishes it"


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


# What draws it


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


def not_shown(display: str) -> TopicReason:
    """Say that what would draw the topic is not there.

    Args:
        display: its kind, without the package.
    """
    article = "an" if display[0] in "AEIOU" else "a"
    return TopicReason("no-display", f"not shown: add {article} {display} display")


def off(display: str) -> TopicReason:
    """Say that what draws the topic is switched off."""
    return TopicReason("off", f"the display {display} is off: tick its box")


# Subscriptions


def no_such_topic(name: str, known: Iterable[str]) -> TopicReason:
    """Say that a topic that was named is not there, and which one was meant."""
    there = did_you_mean(name, known)
    return TopicReason("no-such-topic", f"there is no topic {name}; {there}")


def meant_topic(name: str, known: Sequence[str]) -> str:
    """Return the topic that a wrong name probably means; empty if there is no guess.

    If there is only one candidate, it is returned even if the name is not similar.
    """
    return nearest(name, known) or (known[0] if len(known) == 1 else "")


def wrong_type(wanted: str, type_name: str) -> TopicReason:
    """Say that a display wants other messages."""
    text = f"the display draws {wanted}, this is {type_name}: choose another topic"
    return TopicReason("wrong-type", text)


def weaker_policy(offered: Qos, wanted: Qos) -> tuple[str, str, str] | None:
    """Return the QoS policy for which publishers offer less than requested.

    Args:
        offered: the QoS of all publishers together.
        wanted: the requested QoS; an empty policy accepts everything.

    Returns:
        Its name, the offered and the requested value, in RViz's words; None if all
        policies are compatible.
    """
    pairs = (
        ("Reliability", "best_effort", "reliable"),
        ("Durability", "volatile", "transient_local"),
    )
    for policy, weak, strong in pairs:
        field = policy.lower()
        if (getattr(offered, field), getattr(wanted, field)) == (weak, strong):
            return policy, QOS_WORDS[weak], QOS_WORDS[strong]
    return None


def qos_mismatch(offered: Qos | None, wanted: Qos) -> TopicReason | None:
    """Return a reason if publishers offer less than a display requests.

    Args:
        offered: the QoS of all publishers together; None if unknown.
        wanted: the QoS of the display; an empty policy adapts, as System Default does.
    """
    found = None if offered is None else weaker_policy(offered, wanted)
    if found is None:
        return None
    policy, weak, strong = found
    return TopicReason(
        "qos",
        f"a publisher offers {weak}, the display wants {strong}: set its {policy} "
        f"Policy to {weak} or System Default",
    )


def transforms_qos(offered: Qos | None, *, is_static: bool) -> TopicReason | None:
    """Say that publishers of transforms offer less than tf2's listeners want.

    Args:
        offered: by all publishers together, None when it is not known.
        is_static: whether the transforms hold at all times.
    """
    wanted = Qos("reliable", "transient_local" if is_static else "volatile")
    found = qos_mismatch(offered, wanted)
    if found is None:
        return None
    differs = found.text.partition(":")[0].replace("the display wants", "tf2 wants")
    remedy = "RViz and other nodes get nothing from it: change its QoS"
    return TopicReason("qos", f"{differs}; {remedy}")


def qos_words(qos: Qos) -> str:
    """Return QoS in RViz's words, such as "Reliable, Transient Local"."""
    policies = (qos.reliability, qos.durability)
    return ", ".join(QOS_WORDS[policy] for policy in policies if policy in QOS_WORDS)


# What comes


def unreceived(topic: SourceTopic) -> TopicReason | None:
    """Say why nothing comes of a topic, as far as its source knows."""
    name = topic.name
    if topic.reason is not None:
        return TopicReason("encoding", topic.reason)
    if topic.left_out:
        return TopicReason("left-out", topic.left_out)
    if topic.count == 0:
        return TopicReason(
            "no-message",
            "no message was recorded: nothing was published, or with another QoS than "
            f"the recorder wanted (ros2 topic info -v {name})",
        )
    if topic.publishers is None or topic.publishers:
        return None
    if topic.subscribers:
        names = ", ".join(topic.subscribers[:_NAMES])
        waits = "wait for it" if len(topic.subscribers) > 1 else "waits for it"
        return TopicReason(
            "awaited",
            f"nobody publishes it, {text(names, 200)} {waits}: start the node that "
            f"should, or see whether one has it under another name (ros2 topic list)",
        )
    return TopicReason(
        "no-publisher",
        f"nobody publishes it: start the node that should (ros2 topic info {name})",
    )


def no_message_yet(topic: SourceTopic) -> TopicReason:
    """Say that a topic has a publisher, and nothing has come."""
    name, silent = topic.name, "whatever publishes it is silent"
    if topic.endpoints is None:
        silent += ", or offers a QoS that the bridge does not ask for"
    return TopicReason(
        "no-message", f"nothing has come yet: {silent} (ros2 topic info -v {name})"
    )


def nothing_came(seconds: float) -> TopicReason:
    """Say that a topic or a robot was silent, and how to listen longer."""
    text = f"nothing came within {seconds:g} s: listen longer with --for SECONDS"
    return TopicReason("no-message", text)


def latched_but_silent(name: str) -> str:
    """Say that nothing came of a live robot's latched topic, and how to get it."""
    return (
        f"{name} is published, but no message of it came: let its publisher be latched "
        "(Transient Local), start its node again, or listen longer with --for"
    )


def not_listened() -> TopicReason:
    """Say that messages are not asked for, as they would fill the network."""
    return TopicReason(
        "not-listened", "its messages are large: select this row to listen to them"
    )


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


def stale(age: float, period: float | None) -> TopicReason | None:
    """Say that messages came, and come no more.

    Args:
        age: of the last message, on the clock of its source [s].
        period: between the messages [s]; None where that is not known.
    """
    if period is None or age <= max(STALE, PERIODS * period):
        return None
    return TopicReason("stale", f"its messages come no more: {_LOOK}")


def over(last: float, coming: float | None, has_ended: bool) -> TopicReason:
    """Return why a topic of a recording is silent at a time, and when it is not.

    Args:
        last: time of its last message [s from the first message].
        coming: time of the next one; None for never.
        has_ended: whether its recording has ended while another one goes on.
    """
    back = f"go back there with the time bar or --at {last:.1f}"
    if has_ended:
        return TopicReason("ended", f"its recording ended at {last:.1f} s: {back}")
    if coming is not None:
        text = f"silent from {last:.1f} s to {coming:.1f} s: {_LOOK}"
        return TopicReason("stale", text)
    text = f"its last message came at {last:.1f} s: {back}, or {_LOOK}"
    return TopicReason("stale", text)


def lagging(dropped: int, where: str) -> TopicReason | None:
    """Return a reason if messages were dropped because they came too fast.

    Args:
        dropped: number of dropped messages.
        where: the slow part: "the network", "this program".
    """
    if dropped <= 0:
        return None
    messages = "message was" if dropped == 1 else "messages were"
    return TopicReason(
        "lagging",
        f"{dropped:,} {messages} dropped, as {where} cannot keep up: "
        "show less, or publish less often",
    )


# Contents


def not_decodable(bad: int, looked: int, cause: str, is_all: bool) -> TopicReason:
    """Say how many messages cannot be decoded.

    Args:
        bad: number of bad messages among them.
        looked: number of messages looked at.
        cause: why, of the first of them.
        is_all: there are no more messages.
    """
    if bad == looked:
        return TopicReason("not-decodable", f"cannot be decoded ({cause}): {_LOOK}")
    of = f"{looked}" if is_all else f"the first {looked}"
    text = f"{bad} of {of} messages cannot be decoded ({cause}): they are left out"
    return TopicReason("not-decodable", text)


def empty(what: str) -> TopicReason:
    """Say that messages come, and nothing is in them."""
    return TopicReason("empty", f"{what}: {_LOOK}")


def not_drawn(why: str) -> TopicReason:
    """Say that messages come, and their display cannot draw them."""
    return TopicReason("not-drawn", why)

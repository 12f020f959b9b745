"""Why a topic of a robot on the network shows nothing; a recording has none of these.

Each function says one reason with its remedy, or None where it does not hold.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping

from sambot_viz.sources.message import SourceTopic
from sambot_viz.sources.qos import Qos
from sambot_viz.topics.reasons import TopicReason, left_out
from sambot_viz.topics.report import TopicStatus

_HOUR = 3600.0
_SIMULATED = 100_000_000.0
"""Simulations begin at 0: an earlier time is of none of today's clocks [s]."""
QOS_WORDS = {
    "reliable": "Reliable",
    "best_effort": "Best Effort",
    "transient_local": "Transient Local",
    "volatile": "Volatile",
}
"""RViz's words for what ROS offers."""


def nothing_came(seconds: float) -> str:
    """Say that a topic or a robot was silent, and how to listen longer."""
    return f"nothing came within {seconds:g} s: listen longer with --for SECONDS"


def silent_topics(
    known: Mapping[str, SourceTopic], came: Container[str], seconds: float
) -> Iterator[TopicStatus]:
    """Yield what is to be said of topics that were listened to in vain, by name.

    Args:
        known: all topics of the source.
        came: those of which there is a message.
        seconds: how long was listened.
    """
    for name in sorted(known):
        topic = known[name]
        if name not in came:
            reason = (
                unreadable(topic)
                or (left_out(topic.left_out) if topic.left_out else None)
                or no_publisher(name, topic.publishers)
                or TopicReason("no-message", nothing_came(seconds))
            )
            readable = topic.reason is None
            yield TopicStatus(name, topic.schema.name, 0, None, readable, reason)


def unreadable(topic: SourceTopic) -> TopicReason | None:
    """Say why a source cannot read a topic."""
    return TopicReason("encoding", topic.reason) if topic.reason is not None else None


def silent(name: str) -> TopicReason:
    """Say that a topic has a publisher, and nothing has come."""
    return TopicReason(
        "no-message",
        "nothing has come yet: whatever publishes it is silent, or offers a QoS that "
        f"the bridge does not ask for (ros2 topic info -v {name})",
    )


def stopped() -> TopicReason:
    """Say that messages came, and come no more."""
    return TopicReason("stale", "it has fallen silent: look at what publishes it")


def not_listened() -> TopicReason:
    """Say that messages are not asked for, as they would fill the network."""
    return TopicReason(
        "not-listened", "its messages are large: select this row to listen to them"
    )


def qos_words(qos: Qos) -> str:
    """Return QoS in RViz's words, such as "Reliable, Transient Local"."""
    policies = (qos.reliability, qos.durability)
    return ", ".join(QOS_WORDS[policy] for policy in policies if policy in QOS_WORDS)


def no_publisher(
    name: str, publishers: tuple[str, ...] | int | None
) -> TopicReason | None:
    """Say that nobody publishes a topic.

    Args:
        name: of the topic.
        publishers: their names, how many they are, or None when it is not known.
    """
    if publishers is None or publishers:
        return None
    remedy = f"start the node that should (ros2 topic info {name})"
    return TopicReason("no-publisher", f"nobody publishes it: {remedy}")


def qos_mismatch(offered: Qos | None, wanted: Qos) -> TopicReason | None:
    """Say that publishers offer less than a display wants, so that nothing comes.

    Args:
        offered: by all publishers together, None when it is not known.
        wanted: by the display; what is empty adapts, as System Default does.
    """
    if offered is None:
        return None
    pairs = (
        ("Reliability", "best_effort", "reliable"),
        ("Durability", "volatile", "transient_local"),
    )
    for policy, weak, strong in pairs:
        field = policy.lower()
        if (getattr(offered, field), getattr(wanted, field)) == (weak, strong):
            return TopicReason(
                "qos",
                f"a publisher offers {QOS_WORDS[weak]}, the display wants "
                f"{QOS_WORDS[strong]}: set its {policy} Policy to {QOS_WORDS[weak]} or "
                "System Default",
            )
    return None


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


def wrong_clock(
    stamp: float, clock: float, has_topic: bool, is_told: bool
) -> TopicReason | None:
    """Say that the transforms are stamped by another clock than that of the robot.

    Args:
        stamp: the newest of /tf [s]; 0 without any.
        clock: the time of the robot [s].
        has_topic: whether /clock is published.
        is_told: whether its messages come.
    """
    if stamp and abs(stamp - clock) > _HOUR:
        if not is_told and stamp < _SIMULATED:
            text = f"/tf is stamped {stamp:.1f} in simulation time, but no /clock comes"
            why = "resume the simulation" if has_topic else "start the simulation"
            return TopicReason(
                "two-clocks",
                f"{text}: {why}, or set use_sim_time of the nodes to false",
            )
        if not is_told:
            return TopicReason(
                "two-clocks",
                f"/tf is stamped {stamp:.1f}, the robot's clock says {clock:.1f}: "
                "playing a bag? Use ros2 bag play --clock",
            )
        return TopicReason(
            "two-clocks",
            f"/tf is stamped {stamp:.1f}, /clock says {clock:.1f}: one of the nodes "
            "has the wrong use_sim_time",
        )
    if has_topic and not is_told:
        return TopicReason(
            "no-message",
            "no message of /clock has come: is the simulation paused? Until then the "
            "time is that of this computer",
        )
    return None


def lagging(dropped: int, where: str) -> TopicReason | None:
    """Say that messages were dropped because they came too fast.

    Args:
        dropped: so many.
        where: what could not keep up: "the network", "this program".
    """
    if dropped <= 0:
        return None
    messages = "message was" if dropped == 1 else "messages were"
    return TopicReason(
        "lagging",
        f"{dropped:,} {messages} dropped, as {where} cannot keep up: "
        "show less, or publish less often",
    )

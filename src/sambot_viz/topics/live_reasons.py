"""Why a topic of a robot on the network shows nothing; a recording has none of these.

Each function says one reason with its remedy, or None where it does not hold.
"""

from __future__ import annotations

from sambot_viz.sources.qos import Qos
from sambot_viz.topics.reasons import TopicReason

_WORDS = {
    "reliable": "Reliable",
    "best_effort": "Best Effort",
    "transient_local": "Transient Local",
    "volatile": "Volatile",
}
"""RViz's words for what ROS offers."""


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
                f"a publisher offers {_WORDS[weak]}, the display wants "
                f"{_WORDS[strong]}: set its {policy} Policy to {_WORDS[weak]} or "
                "System Default",
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


def mesh_not_served(uri: str, peer_text: str) -> TopicReason:
    """Say that a robot's bridge does not hand out a mesh.

    Args:
        uri: of the mesh.
        peer_text: what the bridge said.
    """
    return TopicReason(
        "mesh-not-served",
        f"the bridge does not hand out {uri} ({peer_text}): add it to the bridge's "
        "asset_uri_allowlist",
    )

"""The QoS that publishers offer, from the text that rosbag2 writes.

The text is YAML of a fixed form, written with words since Iron and with rmw's numbers
before; fields may be missing. A parser of YAML takes a millisecond for each of them, a
bag has thousands.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from sambot_viz import limits

_FIELD = re.compile(r"\b(history|depth|reliability|durability):\s*\"?(\w+)")

_WORDS = {
    "history": {"1": "keep_last", "2": "keep_all"},
    "reliability": {"1": "reliable", "2": "best_effort"},
    "durability": {"1": "transient_local", "2": "volatile"},
}
_UNKNOWN = {"", "0", "3", "system_default", "unknown"}


@dataclass(frozen=True, slots=True)
class Qos:
    """What the publishers of a topic offer together, as RViz adapts to it.

    Attributes:
        reliability: "reliable"; "best_effort" if one of them offers only that; "" when
            it is not known.
        durability: "transient_local" if all of them offer that, else "volatile"; "".
        history: "keep_last", "keep_all" or "".
        depth: of the first of them, 0 when it is not known.
        is_any_transient_local: one of them keeps its messages for late subscribers.
    """

    reliability: str = ""
    durability: str = ""
    history: str = ""
    depth: int = 0
    is_any_transient_local: bool = False


@lru_cache(maxsize=1024)
def parse_qos(text: str) -> Qos | None:
    """Read the QoS profiles of a topic; None when the text has none.

    Args:
        text: of ``offered_qos_profiles``, one profile for each publisher.
    """
    found: dict[str, list[str]] = {}
    for field, value in _FIELD.findall(text[: limits.QOS.value]):
        word = str(_WORDS.get(field, {}).get(value, value))
        if word not in _UNKNOWN:
            found.setdefault(field, []).append(word)
    if not found:
        return None
    reliability = found.get("reliability", [])
    durability = found.get("durability", [])
    kept = [word == "transient_local" for word in durability]
    depth = found.get("depth", ["0"])[0]
    return Qos(
        "best_effort" if "best_effort" in reliability else "".join(reliability[:1]),
        "".join(durability[:1]) if len(set(durability)) < 2 else "volatile",
        "".join(found.get("history", [])[:1]),
        int(depth) if depth.isascii() and depth.isdigit() and len(depth) < 10 else 0,
        any(kept),
    )


def profile_text(qos: Qos) -> str:
    """Write QoS as rosbag2 does since Iron, as the profile of one publisher."""
    forever = "\n    sec: 9223372036\n    nsec: 854775807"
    return (
        f"- history: {qos.history or 'unknown'}\n"
        f"  depth: {qos.depth}\n"
        f"  reliability: {qos.reliability or 'unknown'}\n"
        f"  durability: {qos.durability or 'unknown'}\n"
        f"  deadline:{forever}\n"
        f"  lifespan:{forever}\n"
        "  liveliness: automatic\n"
        f"  liveliness_lease_duration:{forever}\n"
        "  avoid_ros_namespace_conventions: false"
    )

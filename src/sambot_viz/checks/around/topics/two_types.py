"""Report two displays of one RViz config that read a topic as two types."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.displays import DisplayTopic
from sambot_viz.errors import Problem

_WORDS = {
    "Image": r"image|rgb|depth|color",
    "PointCloud2": r"points?|cloud",
    "LaserScan": r"scan|laser",
    "Odometry": r"odom",
    "OccupancyGrid": r"map|grid",
    "Path": r"path|plan",
    "Imu": r"imu",
    "MarkerArray": r"markers?",
}
"""Type → the last words of its topics, as people name them."""


def two_types(named: list[tuple[str, DisplayTopic]]) -> Iterator[Problem]:
    """Report displays that read a topic as a type that its name does not mean.

    Args:
        named: the full name of the topic of each display of a config, without tools.
    """
    first: dict[str, DisplayTopic] = {}
    for name, each in named:
        other = first.setdefault(name, each)
        kinds = [one.message.rpartition("/")[2] for one in (other, each)]
        fits = [_fits(name, kind) for kind in kinds]
        if kinds[0] == kinds[1] or fits[0] == fits[1]:
            continue
        wrong, fine = (each, other) if fits[0] else (other, each)
        place = wrong.topic.place
        yield Problem.at(
            place,
            "warning",
            "topic-type",
            f"the displays {wrong.name} and {fine.name} "
            f"({where(fine.topic.place, place)}) read {name} as two types, "
            f"{wrong.message} and {fine.message}: a topic has one, and {wrong.name} "
            "shows nothing",
            f"write a topic of the type {wrong.message}",
        )


def _fits(topic: str, kind: str) -> bool:
    """Return whether the name of a topic means a type, by its last part."""
    words = _WORDS.get(kind)
    return words is not None and re.search(words, topic.rpartition("/")[2]) is not None

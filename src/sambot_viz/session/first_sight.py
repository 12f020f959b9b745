"""The displays of a recording or a robot that is opened without a config.

RViz shows only its config. Users who open a recording want to see its content: one
display for each topic that can be drawn, the most useful first, at visible sizes. A
config is shown as it is, without additions.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.displays.robot_display import WantedQos
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.rviz import DisplayConfig, RvizConfig
from sambot_viz.rviz.declarations import short_name
from sambot_viz.topics.first_topics import is_costmap, shown_at_first

_COLORS = ("25; 130; 255", "255; 120; 30", "40; 190; 90", "215; 60; 170")
"""Of paths and outlines, one after the other, so that they can be told apart."""
_COLORED = frozenset({"Path", "Polygon"})
_OF_POINTS = frozenset({"PointCloud2", "PointCloud", "LaserScan"})
_VALUES: Mapping[str, Mapping[str, object]] = {
    "Odometry": {"Keep": 1, "Covariance": False},
}
"""What RViz's defaults hide, or bury."""
_COSTMAP = {"Color Scheme": "costmap", "Alpha": 0.4}
"""As Nav2's own config: the walls of the map below stay visible."""
_DOTS = ((300, 6), (3_000, 4), (50_000, 3))
"""Number of points, and the size of dots up to it [pixels]: few points, large dots."""
_LOOSE = WantedQos("Best Effort", "Volatile")
_SMALLEST_DOT = 2
_ROBOT = "/robot_description"
"""The topic of the robot in a config that fits any."""


def show_topics(
    document: RvizConfig,
    types: Mapping[str, str],
    points_of: Callable[[str], int | None],
    robots: Sequence[str] = (),
    loose: Collection[str] = (),
) -> list[DisplayConfig]:
    """Add a display to a config for each topic that is shown at first.

    Args:
        document: the config that comes with the program.
        types: topic → type of its messages; what the config names is left out, and
            what was shown before.
        points_of: returns how many points a message of a topic has; None if that is
            not known.
        robots: topics of descriptions; the config shows the robot of the first one.
        loose: topics whose publishers now offer no more than Best Effort.

    Returns:
        The displays that were added.
    """
    named = {*_named(document.displays), *document.offered}
    added: list[DisplayConfig] = []
    for topic, kind in shown_at_first(types):
        qos = _LOOSE if topic in loose else None
        values = DISPLAYS[kind].topic_values(topic, types[topic], qos)
        if topic in named or values is None:
            continue
        short = short_name(kind)
        values = {**values, **_VALUES.get(short, {})}
        if short in _COLORED:
            same = sum(one.kind == kind for one in document.displays)
            values["Color"] = _COLORS[same % len(_COLORS)]
        if short in _OF_POINTS:
            values |= {"Style": "Points", "Size (Pixels)": dot_size(points_of(topic))}
        if short == "Map":
            values |= _COSTMAP if is_costmap(topic) else {"Draw Behind": True}
        document.offered.add(topic)
        display = document.add_display(kind, f"{short} {topic}")
        for path, value in values.items():
            display.set(path, value)
        added.append(display)
    own = robots[:1] if _ROBOT in named else ()
    for topic in robots:
        if topic not in named and topic not in own:
            document.offered.add(topic)
            display = document.add_display(RobotModelDisplay.kind, f"Robot {topic}")
            display.set("Description Topic", topic)
            added.append(display)
    document.unasked = (*document.unasked, *added)
    return added


def dot_size(points: int | None) -> int:
    """Return how large each of some points is drawn [pixels].

    Args:
        points: how many there are; None if that is not known.
    """
    if points is None:
        return 3
    return next((size for most, size in _DOTS if points <= most), _SMALLEST_DOT)


def is_map(display: DisplayConfig) -> bool:
    """Return whether a display is a map, in which all else moves."""
    return short_name(display.kind) == "Map"


def _named(displays: Iterable[DisplayConfig]) -> Iterator[str]:
    """Yield the topics that displays show."""
    for display in displays:
        for path in ("Topic", "Description Topic"):
            if path in display.declared:
                yield str(display.get(path))

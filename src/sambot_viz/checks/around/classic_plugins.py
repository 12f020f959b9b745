"""Plugins of Gazebo Classic: their libraries, elements and messages."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import Plugin, plugins
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import rename_element, write, write_attribute
from sambot_viz.errors import Problem, nearest
from sambot_viz.robot.model import Robot
from sambot_viz.robot.slips.vocabulary import is_one_slip

_TABLE = "classic_plugins"
_CODE = "gazebo-plugin"
_LIKENESS = 0.75
_MESSAGES = tuple(
    f"sensor_msgs/{name}"
    for name in ("LaserScan", "PointCloud", "PointCloud2", "Range")
)
"""What a lidar of Classic publishes."""


def unknown_libraries(robot: Robot) -> Iterator[Problem]:
    """Report a library that is almost one of Gazebo Classic's."""
    known = vocabulary(_TABLE)
    for plugin in plugins(robot.gazebo):
        said = plugin.filename.strip()
        bare = f"lib{said.removeprefix('lib').removesuffix('.so')}.so"
        near = [name for name in known if _same_or_slip(bare, name)]
        if said in known or len(near) != 1 or "gazebo_ros" not in near[0]:
            continue
        yield Problem.at(
            plugin.element.place,
            "warning",
            _CODE,
            f"Gazebo has no plugin {said}: it does not load it",
            write_attribute(plugin.element.place, "filename", said, near[0]),
        )


def _same_or_slip(written: str, name: str) -> bool:
    """Tell whether a name was meant by another one; underscores may be missing."""
    one, other = written.lower(), name.lower()
    plain = [re.sub("[_-]", "", text) for text in (one, other)]
    return is_one_slip(one, other) or plain[0] == plain[1]


def words_of_plugins(robot: Robot) -> Iterator[Problem]:
    """Report elements and messages of these plugins that are misspelt."""
    for plugin in plugins(robot.gazebo):
        known = vocabulary(_TABLE).get(plugin.filename, ())
        if known:
            yield from _elements(plugin, known)
            yield from _messages(plugin)


def _elements(plugin: Plugin, known: tuple[str, ...]) -> Iterator[Problem]:
    present = {child.tag for child in plugin.element.children}
    for child in plugin.element.children:
        near = [tag for tag in known if _same_or_slip(child.tag, tag)]
        if child.tag in known or len(near) != 1 or near[0] in present:
            continue
        # Names of ROS 1, in other letters, have most often the value of the default.
        habit = re.sub("_", "", near[0]) == child.tag.lower()
        habit &= "frame" not in near[0] or child.text.strip() == plugin.link
        yield Problem.at(
            child.place,
            "info" if habit else "warning",
            "gazebo-element-unknown",
            f"{plugin.filename} does not read <{child.tag}>, but <{near[0]}>: it uses "
            "its own default",
            rename_element(child.place, child.tag, near[0], f"write <{near[0]}>"),
        )


def _messages(plugin: Plugin) -> Iterator[Problem]:
    for fact in plugin.all("output_type"):
        last = re.split("[/:]", fact.value)[-1]
        near = nearest(f"sensor_msgs/{last}", _MESSAGES, _LIKENESS)
        if fact.value in _MESSAGES or near is None:
            continue
        yield Problem.at(
            fact.place,
            "warning",
            _CODE,
            f"{plugin.filename} knows no message {fact.value}: it publishes a "
            "PointCloud2",
            write(fact.place, fact.value, near),
        )

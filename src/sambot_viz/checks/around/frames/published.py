"""Find frames that other nodes publish: odometry, maps, fixed transforms."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.around.frames.names import DRIVE_ODOMS
from sambot_viz.checks.around.parameters.navigation import bare_frame, filters
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.robot.slips.vocabulary import is_one_slip

_FRAME = re.compile(r"(^|_)frame(_id)?$", re.IGNORECASE)
"""Parameters with such a name contain a frame."""
_MAPS = re.compile(
    r"\b(nav2_\w+|amcl|map_server|slam_toolbox|cartographer_ros|rtabmap\w*"
    r"|robot_localization)\b"
)
_OF_MAPS = frozenset({"map", "odom"})
"""Frames that localization publishes, and needs."""
_LAUNCHED = (".launch", ".launch.xml", ".launch.yaml", ".launch.yml")
_HELD_BY = re.compile(r"<virtual_joint\b[^>]*\bparent_frame\s*=\s*[\"']([^\"']+)")
_PUBLISHERS = (*DRIVE_ODOMS, "odom_frame")


def may_be_published(around: Surroundings, frame: str) -> bool:
    """Return whether a node of the packages may publish a frame that is not a link.

    A package may do so when it names the frame, or starts an unknown node. In the
    second case only a misspelt link is certainly not such a frame.
    """
    name = bare_frame(frame)
    if name in _named(around) or around.said_elsewhere(name):
        return True
    if any(is_one_slip(name, link) for link in around.links):
        return False
    prefixed = name.rpartition("/")[2] in around.links
    return (prefixed and around.namespaced) or not around.running.is_known


def _named(around: Surroundings) -> Iterator[str]:
    """Yield the frames of plugins, parameters and localization."""
    for plugin in around.plugins:
        for fact in plugin.all(*_PUBLISHERS):
            yield bare_frame(fact.value)
        if plugin.is_drive or "odometry" in plugin.filename:
            yield "odom"
    for one in filters(around):
        yield from (one.odom_frame, one.map_frame, one.world_frame)
    for parameter in around.parameters:
        if _FRAME.search(parameter.name):
            yield bare_frame(parameter.fact.value)
        elif parameter.name == "left_wheel_names":
            yield "odom"
    for package in around.packages:
        # MoveIt publishes the transform of its virtual joint.
        for path in package.ending(".srdf", ".srdf.xacro"):
            yield from _HELD_BY.findall(package.text(path) or "")
    if any(_MAPS.search(text) for text in _started(around)):
        yield from _OF_MAPS
    if any(_MAPS.search(node) for file in around.yaml_files for node in file.nodes):
        yield from _OF_MAPS


def _started(around: Surroundings) -> Iterator[str]:
    for launch in around.launches:
        yield from launch.strings
        yield from (fact.value for fact in launch.paths)
    yield from _launch_texts(around)


def _launch_texts(around: Surroundings) -> Iterator[str]:
    for package in around.packages:
        for path in package.ending(*_LAUNCHED):
            yield package.text(path) or ""

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
_LIDAR = "libgazebo_ros_ray_sensor.so"
_READS = {
    "libgazebo_ros_bumper.so": ("contact",),
    "libgazebo_ros_camera.so": ("camera", "depth", "multicamera", "wideanglecamera"),
    "libgazebo_ros_gps_sensor.so": ("gps",),
    "libgazebo_ros_imu_sensor.so": ("imu",),
    _LIDAR: ("ray", "gpu_ray", "sonar"),
}
"""Plugin of a sensor → the types of sensors that it reads."""
OF_MODELS = (
    "_drive.so",
    "_joint_state_publisher.so",
    "_planar_move.so",
    "ros2_control.so",
)
"""Endings of plugin names that belong to a model."""
_MESSAGES = tuple(
    f"sensor_msgs/{name}"
    for name in ("LaserScan", "PointCloud", "PointCloud2", "Range")
)
"""The message types of a Classic lidar."""


def unknown_libraries(robot: Robot) -> Iterator[Problem]:
    """Report a misspelt library of Gazebo Classic."""
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
    """Return whether a text misspells a name; underscores may be missing."""
    one, other = written.lower(), name.lower()
    plain = [re.sub("[_-]", "", text) for text in (one, other)]
    return is_one_slip(one, other) or plain[0] == plain[1]


def outside_of_sensors(robot: Robot) -> Iterator[Problem]:
    """Report a plugin of a sensor that stands beside it, or in no sensor at all."""
    for part in robot.gazebo:
        for element in part.find_all("plugin") if part.get("reference") else ():
            kinds = _READS.get(element.get("filename") or "", ())
            sensors = [s for s in part.find_all("sensor") if s.get("type") in kinds]
            free = [sensor for sensor in sensors if sensor.find("plugin") is None]
            if not kinds:
                continue
            hint = f"write it into the <sensor> of type {kinds[0]} that it belongs to"
            if len(free) == 1 and free[0].place.file == element.place.file:
                name = free[0].get("name")
                named = "" if name is None else f' name="{name}"'
                hint = f"move <plugin> into <sensor{named}> (line {free[0].place.line})"
            yield Problem.at(
                element.place,
                "warning",
                _CODE,
                f"{element.get('filename')} is a plugin of a sensor, and stands in no "
                "<sensor>: Gazebo Classic does not load it",
                hint,
            )


def words_of_plugins(robot: Robot) -> Iterator[Problem]:
    """Report misspelt elements and messages of these plugins."""
    for plugin in plugins(robot.gazebo):
        known = vocabulary(_TABLE).get(plugin.filename, ())
        if known:
            yield from _elements(plugin, known)
            yield from _messages(plugin)
        if plugin.filename in vocabulary(_TABLE):
            yield from _nameless(plugin)
            yield from _of_another_sensor(plugin)


def _nameless(plugin: Plugin) -> Iterator[Problem]:
    """Report a plugin without a name, which SDF up to 1.8 requires."""
    if plugin.element.get("name") is None:
        name = plugin.filename.removeprefix("lib").removesuffix(".so")
        yield Problem.at(
            plugin.element.place,
            "warning",
            _CODE,
            f"the plugin {plugin.filename} has no name: Gazebo Classic does not load "
            "the robot with it",
            f'add name="{name}"',
        )


def _of_another_sensor(plugin: Plugin) -> Iterator[Problem]:
    """Report a plugin in a sensor of a type that it does not read."""
    sensor, place, reads = plugin.sensor, plugin.element.place, plugin.filename
    kind = "" if sensor is None else sensor.get("type") or ""
    own = [name for name, kinds in _READS.items() if kind in kinds]
    if sensor is None or not own or reads in own:
        return
    what = "is not for a sensor"
    fix = write_attribute(place, "filename", reads, own[0])
    if reads in _READS:
        other, *_ = _READS[reads]
        what = f"reads sensors of type {other}"
        if sensor.find(kind) is None and any(map(sensor.find, _READS[reads])):
            place = sensor.place
            fix = write_attribute(place, "type", kind, other)
    elif not reads.endswith(OF_MODELS):
        return
    yield Problem.at(
        place,
        "warning",
        "gazebo-sensor",
        f"{reads} {what}, and {sensor.get('name') or 'this one'} is of type {kind}: "
        "Gazebo Classic does not load it",
        fix,
    )


def _elements(plugin: Plugin, known: tuple[str, ...]) -> Iterator[Problem]:
    present = {child.tag for child in plugin.element.children}
    for child in plugin.element.children:
        near = [tag for tag in known if _same_or_slip(child.tag, tag)]
        if child.tag in known or len(near) != 1 or near[0] in present:
            continue
        # ROS 1 names, spelt differently, mostly have the default value.
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
    """Report a message that a lidar cannot publish; others do not read it."""
    for fact in plugin.all("output_type") if plugin.filename == _LIDAR else ():
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

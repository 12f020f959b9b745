"""The topics of Gazebo that the sensors and plugins of a model send and take."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from sambot_viz.checks.around.files.gazebo import Fact, Plugin, facts, sensors
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.errors import Place, nearest
from sambot_viz.robot.xml.element import Element

_SENSORS: dict[str, tuple[tuple[str, str], ...]] = {
    "imu": (("IMU", ""),),
    "camera": (("Image", ""),),
    "depth_camera": (("Image", ""), ("PointCloudPacked", "/points")),
    "rgbd_camera": (
        ("Image", "/image"),
        ("Image", "/depth_image"),
        ("PointCloudPacked", "/points"),
    ),
    "navsat": (("NavSat", ""),),
    "magnetometer": (("Magnetometer", ""),),
    "air_pressure": (("FluidPressure", ""),),
    "force_torque": (("Wrench", ""),),
    **dict.fromkeys(
        ("gpu_lidar", "gpu_ray", "lidar", "ray"),
        (("LaserScan", ""), ("PointCloudPacked", "/points")),
    ),
}
"""Type of a sensor → the types that it sends, and what is added to its topic."""

_SENDS = (
    ("diff-drive-system", "odom_topic", "Odometry"),
    ("ackermann-steering-system", "odom_topic", "Odometry"),
    ("odometry-publisher-system", "odom_topic", "Odometry"),
    ("mecanum-drive-system", "odom_topic", "Odometry"),
    ("joint-state-publisher-system", "topic", "Model"),
)
_MISSPELT = 0.75
_TAKES = ("diff-drive-system", "ackermann-steering-system", "mecanum-drive-system")


@dataclass(frozen=True, slots=True)
class GazeboTopic:
    """A topic of Gazebo that the model sends or takes.

    Attributes:
        name: the topic.
        kind: its type.
        what: what sends or takes it.
        wanted: a bridge probably carries it; few want the points of a lidar.
    """

    name: Fact
    kind: str
    what: str
    wanted: bool = True


def sent(around: Surroundings) -> list[GazeboTopic]:
    """Return the topics of Gazebo that the model sends, where it names them."""
    found = [t for _, s in sensors(around.robot.gazebo) for t in topics_of_sensor(s)]
    return [*found, *_of_plugins(around.plugins, _SENDS)]


def topics_of_sensor(sensor: Element) -> Iterator[GazeboTopic]:
    """Give the topics of a sensor; none for one of Gazebo Classic."""
    kind = (sensor.get("type") or "").removesuffix("_sensor")
    if any("libgazebo_" in (child.get("filename") or "") for child in sensor.children):
        return
    for fact in facts(sensor, "topic")[:1]:
        for gz_type, more in _SENSORS.get(kind, ()):
            name = Fact(fact.value + more, fact.place)
            wanted = not more or "camera" in kind
            yield GazeboTopic(name, gz_type, f"the sensor {sensor.get('name')}", wanted)


@dataclass(frozen=True, slots=True)
class Unnamed:
    """A sensor or a plugin whose topic Gazebo makes up, below the name of the model.

    Attributes:
        place: its line.
        kind: the type of the topic.
        what: what it is.
        tag: the element that would name the topic.
        more: what Gazebo adds to that name.
    """

    place: Place
    kind: str
    what: str
    tag: str
    more: str


def unnamed(around: Surroundings) -> list[Unnamed]:
    """Return what sends or takes topics of Gazebo that the model does not name."""
    found: list[Unnamed] = []
    for _, sensor in sensors(around.robot.gazebo):
        kind = (sensor.get("type") or "").removesuffix("_sensor")
        classic = any(
            "libgazebo_" in (child.get("filename") or "") for child in sensor.children
        )
        what = f"the sensor {sensor.get('name')}"
        for gz_type, more in _SENSORS.get(kind, ()):
            if not classic and sensor.find("topic") is None:
                found.append(Unnamed(sensor.place, gz_type, what, "topic", more))
    rows = (*_SENDS, *((part, "topic", "Twist") for part in _TAKES))
    for plugin in around.plugins:
        for part, tag, kind in rows:
            tags = [child.tag for child in plugin.element.children]
            if part in plugin.filename and nearest(tag, tags, _MISSPELT) is None:
                what = f"the plugin {plugin.filename}"
                found.append(Unnamed(plugin.element.place, kind, what, tag, ""))
    return found


def doubled_topics(around: Surroundings) -> frozenset[str]:
    """Return the topics that sensors of different types have."""
    kinds: dict[str, set[str]] = {}
    for _, sensor in sensors(around.robot.gazebo):
        for fact in facts(sensor, "topic")[:1] if any(topics_of_sensor(sensor)) else ():
            kinds.setdefault(bare(fact.value), set()).add(sensor.get("type") or "")
    return frozenset(topic for topic, types in kinds.items() if len(types) > 1)


def taken(around: Surroundings) -> list[GazeboTopic]:
    """Return the topics for velocities that the model takes, where it names them."""
    rows = tuple((part, "topic", "Twist") for part in _TAKES)
    return list(_of_plugins(around.plugins, rows))


def _of_plugins(
    found: Sequence[Plugin], rows: Sequence[tuple[str, str, str]]
) -> Iterator[GazeboTopic]:
    for plugin in found:
        for part, tag, kind in rows:
            fact = plugin.one(tag) if part in plugin.filename else None
            if fact is not None:
                yield GazeboTopic(fact, kind, f"the plugin {plugin.filename}")

"""What a bridge between Gazebo and ROS carries, against what the model sends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from sambot_viz.checks.around.files.gazebo import sensors
from sambot_viz.checks.around.gazebo_topics import (
    GazeboTopic,
    doubled_topics,
    sent,
    taken,
    topics_of_sensor,
    unnamed,
)
from sambot_viz.checks.around.navigation import filters
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import (
    DIRECTIONS,
    BridgeEntry,
    bare,
    entries_in,
    entries_of_file,
)
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Problem, nearest
from sambot_viz.robot.xml.element import Element

_TO_ROS, _TO_GZ, _BOTH = DIRECTIONS
_OF_IMAGES = "image_bridge"
"""Carries only images, and finds their types itself."""
_BRIDGES = ("parameter_bridge", _OF_IMAGES)


def entries(around: Surroundings) -> list[BridgeEntry]:
    """Return all topics that bridges carry, as files and arguments name them."""
    found = [e for file in around.yaml_files for e in entries_of_file(file)]
    for launch in around.launches:
        for node in launch.nodes:
            found += entries_in(node.arguments, node.remappings, node.place)
    return found


def bridge_directions(around: Surroundings) -> Iterator[Problem]:
    """Report entries that carry a topic of the model the wrong way."""
    ways = [(t, _TO_ROS, "sends") for t in sent(around)]
    ways += [(t, _TO_GZ, "takes") for t in taken(around)]
    every = entries(around)
    for topic, right, verb in ways:
        for entry in every:
            said = entry.direction
            same = bare(entry.gz.value) == bare(topic.name.value)
            wrong = said.value in (_TO_ROS, _TO_GZ) and said.value != right
            if same and entry.kind == topic.kind and wrong:
                yield Problem.at(
                    said.place,
                    "warning",
                    "bridge-direction",
                    f"the bridge carries {entry.gz.value} {said.value}, but "
                    f"{topic.what} {verb} it ({where(topic.name.place, said.place)})",
                    write(
                        said.place, said.value, right, hint=f"write direction: {right}"
                    ),
                )


def bridge_topics(around: Surroundings) -> Iterator[Problem]:
    """Report entries for a topic that the model calls otherwise."""
    nodes = [node for launch in around.launches for node in launch.nodes]
    if any(n.executable in _BRIDGES and not n.arguments_known for n in nodes):
        return
    pictures = {
        bare(text) for n in nodes if n.executable == _OF_IMAGES for text in n.arguments
    }
    every = entries(around)
    # Which of two sensors with one topic is meant is said at the sensor.
    doubled = tuple(doubled_topics(around))
    names = [(bare(topic.name.value), topic) for topic in sent(around)]
    free = [
        topic
        for name, topic in names
        if name not in pictures and not name.startswith(doubled)
    ]
    own = _own_names(around)
    yield from _misnamed(every, free, (_TO_ROS, _BOTH), "sends", own)
    yield from _misnamed(every, taken(around), (_TO_GZ, _BOTH), "takes", own)
    yield from _unnamed(every, around)


def _own_names(around: Surroundings) -> dict[str, frozenset[str]]:
    """What the model may be called in Gazebo, for types whose topics it all names."""
    names = {around.robot.name, *(t for one in around.launches for t in one.strings)}
    open_ = {one.kind for one in unnamed(around)}
    named = {topic.kind for topic in (*sent(around), *taken(around))}
    return dict.fromkeys(named - open_, frozenset(names))


def _is_own(entry: BridgeEntry, own: Mapping[str, frozenset[str]]) -> bool:
    """True for a name that Gazebo would make up for this model, if it did."""
    parts = bare(entry.gz.value).split("/")
    at = parts.index("model") + 1 if "model" in parts else len(parts)
    return at < len(parts) and parts[at] in own.get(entry.kind, ())


def _unnamed(every: Sequence[BridgeEntry], around: Surroundings) -> Iterator[Problem]:
    """Report topics without a name in the model that a bridge carries by one."""
    known = {bare(t.name.value) for t in (*sent(around), *taken(around))}
    found = unnamed(around)
    for entry in every:
        name = bare(entry.gz.value)
        alike = [one for one in found if one.kind == entry.kind]
        # Of joint states there is a finding of their own.
        if entry.scoped or name in known or len(alike) != 1 or entry.kind == "Model":
            continue
        if any(t.kind == entry.kind for t in (*sent(around), *taken(around))):
            continue
        (one,) = alike
        topic = name.removesuffix(one.more)
        if not name.endswith(one.more):
            continue
        if around.said_elsewhere(name, as_topic=True, launched=True):
            continue
        yield Problem.at(
            one.place,
            "warning",
            "bridge-topic",
            f"{one.what} has no <{one.tag}>, so its topic in Gazebo is a long one "
            f"below the name of the model, but the bridge carries {entry.gz.value} "
            f"({where(entry.gz.place, one.place)}): nothing passes",
            f"add <{one.tag}>{topic}</{one.tag}> to it",
        )


def _misnamed(
    every: Sequence[BridgeEntry],
    topics: Sequence[GazeboTopic],
    ways: Sequence[str],
    verb: str,
    own: Mapping[str, frozenset[str]],
) -> Iterator[Problem]:
    carried = {bare(entry.gz.value) for entry in every}
    for entry in every:
        alike = {bare(t.name.value): t for t in topics if t.kind == entry.kind}
        name = bare(entry.gz.value)
        if name in alike or entry.direction.value not in ways:
            continue
        if entry.scoped and not _is_own(entry, own):
            continue
        left = {k: t for k, t in alike.items() if t.wanted and k not in carried}
        alone = len(alike) == 1 and sum(e.kind == entry.kind for e in every) == 1
        near = nearest(name, left, 0.0 if alone else 0.6)
        if near is not None:
            topic, place = left[near], entry.gz.place
            yield Problem.at(
                place,
                "warning",
                "bridge-topic",
                f"the bridge carries {entry.gz.value}, but {topic.what} {verb} "
                f"{topic.name.value} ({where(topic.name.place, place)}), which no "
                "bridge carries",
                write(
                    place,
                    entry.gz.value,
                    near if place.file.endswith(".py") else f"/{near}",
                ),
            )


def scoped_frames(around: Surroundings) -> Iterator[Problem]:
    """Report sensors whose messages reach ROS with a frame that Gazebo makes up."""
    every = entries(around)
    if any(e.kind == "Pose_V" and e.scoped for e in every):
        # A bridge may bring the frames of Gazebo too.
        return
    said = {text for launch in around.launches for text in launch.strings}
    filtered = {
        bare(parameter.fact.value)
        for one in filters(around)
        for parameter in one.inputs("imu")
    }
    for link, sensor in sensors(around.robot.gazebo):
        name = sensor.get("name") or ""
        scoped = f"{link}/{name}"
        if _names_frame(sensor) or any(text.endswith(f"/{name}") for text in said):
            continue
        for topic in topics_of_sensor(sensor):
            entry = next((e for e in every if _brings(e, topic)), None)
            read = entry is not None and bare(entry.ros.value) in filtered
            if entry is not None and (topic.kind in _PLACED or read):
                place = topic.name.place
                yield Problem.at(
                    place,
                    "warning",
                    "sensor-frame",
                    f"the bridge brings the messages of the sensor {name} to ROS "
                    f"({where(entry.gz.place, place)}) in a frame that Gazebo makes "
                    f"up, such as {around.robot.name}/{scoped}: no transform leads "
                    "there",
                    f"add <gz_frame_id>{link}</gz_frame_id> to the sensor",
                )
                break


_PLACED = frozenset({"LaserScan", "PointCloudPacked"})
"""Messages that are of no use without a transform."""


def _names_frame(sensor: Element) -> bool:
    return any("frame_id" in element.tag for element in sensor.iter())


def _brings(entry: BridgeEntry, topic: GazeboTopic) -> bool:
    same = bare(entry.gz.value) == bare(topic.name.value)
    return same and entry.kind == topic.kind and entry.reaches_ros

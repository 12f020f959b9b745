"""Compare the topics of a bridge between Gazebo and ROS with those of the model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from sambot_viz.checks.around.files.gazebo import SENSOR_FRAMES, sensors
from sambot_viz.checks.around.gazebo.topics import (
    GazeboTopic,
    doubled_topics,
    model_topics,
    topics_of_sensor,
    unnamed,
)
from sambot_viz.checks.around.parameters.navigation import filters
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import (
    DIRECTIONS,
    IMAGE_BRIDGE,
    BridgeEntry,
    bare,
)
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Problem, nearest
from sambot_viz.robot.xml.element import Element

_TO_ROS, _TO_GZ, _BOTH = DIRECTIONS
_BRIDGES = ("parameter_bridge", IMAGE_BRIDGE)


def bridge_directions(around: Surroundings) -> Iterator[Problem]:
    """Report entries that carry a topic of the model the wrong way."""
    for topic in model_topics(around):
        right = _TO_ROS if topic.end.publishes else _TO_GZ
        for entry in around.bridged:
            said = entry.direction
            wrong = said.value in (_TO_ROS, _TO_GZ) and said.value != right
            if wrong and _fits(entry, topic):
                yield Problem.at(
                    said.place,
                    "warning",
                    "bridge-direction",
                    f"the bridge carries {entry.gz.value} {said.value}, but "
                    f"{topic.what} {topic.verb} it "
                    f"({where(topic.end.place, said.place)})",
                    entry.turned(right),
                )


def _fits(entry: BridgeEntry, topic: GazeboTopic) -> bool:
    return entry.kind == topic.kind and bare(entry.gz.value) == topic.name


def bridge_topics(around: Surroundings) -> Iterator[Problem]:
    """Report entries for a topic that has another name in the model."""
    nodes = [n for n in around.running.started if n.executable in _BRIDGES]
    if any(None in node.arguments for node in nodes):
        return
    # The finding at the sensor says which of two sensors with one topic is right.
    doubled = tuple(doubled_topics(around))
    topics = model_topics(around)
    free = [topic for topic in topics if not topic.name.startswith(doubled)]
    own = _own_names(around, topics)
    for publishes, ways in ((True, (_TO_ROS, _BOTH)), (False, (_TO_GZ, _BOTH))):
        alike = [topic for topic in free if topic.end.publishes is publishes]
        yield from _misnamed(around.bridged, alike, ways, own)
    yield from _unnamed(around, topics)


def _own_names(
    around: Surroundings, topics: Sequence[GazeboTopic]
) -> dict[str, frozenset[str]]:
    """Return the model's possible Gazebo names, for types whose topics it names."""
    names = {around.robot.name, *(t for one in around.launches for t in one.strings)}
    open_ = {topic.kind for topic in unnamed(around)}
    named = {topic.kind for topic in topics}
    return dict.fromkeys(named - open_, frozenset(names))


def _is_own(entry: BridgeEntry, own: Mapping[str, frozenset[str]]) -> bool:
    """Return whether Gazebo would generate a name for this model."""
    parts = bare(entry.gz.value).split("/")
    at = parts.index("model") + 1 if "model" in parts else len(parts)
    return at < len(parts) and parts[at] in own.get(entry.kind, ())


def _unnamed(around: Surroundings, topics: Sequence[GazeboTopic]) -> Iterator[Problem]:
    """Report topics that a bridge names and the model does not."""
    known = {topic.name for topic in topics}
    kinds = {topic.kind for topic in topics}
    for entry in around.bridged:
        name = bare(entry.gz.value)
        alike = [topic for topic in unnamed(around) if topic.kind == entry.kind]
        # Joint states have a separate finding.
        if entry.scoped or name in known or len(alike) != 1 or entry.kind == "Model":
            continue
        (one,) = alike
        tag, more = one.end.parameter, one.end.written
        if entry.kind in kinds or not name.endswith(more):
            continue
        if around.said_elsewhere(name, as_topic=True, launched=True):
            continue
        yield Problem.at(
            one.end.place,
            "warning",
            "bridge-topic",
            f"{one.what} has no <{tag}>, so its topic in Gazebo is a long one "
            f"below the name of the model, but the bridge carries {entry.gz.value} "
            f"({where(entry.gz.place, one.end.place)}): nothing passes",
            f"add <{tag}>{name.removesuffix(more)}</{tag}> to it",
        )


def _misnamed(
    every: Sequence[BridgeEntry],
    topics: Sequence[GazeboTopic],
    ways: Sequence[str],
    own: Mapping[str, frozenset[str]],
) -> Iterator[Problem]:
    carried = {bare(entry.gz.value) for entry in every}
    for entry in every:
        alike = {t.name: t for t in topics if t.kind == entry.kind}
        name = bare(entry.gz.value)
        if name in alike or entry.direction.value not in ways:
            continue
        if entry.scoped and not _is_own(entry, own):
            continue
        left = {
            k: t for k, t in alike.items() if not t.end.is_seldom and k not in carried
        }
        alone = len(alike) == 1 and sum(e.kind == entry.kind for e in every) == 1
        near = nearest(name, left, 0.0 if alone else 0.6)
        if near is not None:
            topic, place = left[near], entry.gz.place
            is_bare = place.file.endswith(".py") and entry.gz.value[:1] != "/"
            yield Problem.at(
                place,
                "warning",
                "bridge-topic",
                f"the bridge carries {entry.gz.value}, but {topic.what} {topic.verb} "
                f"{topic.end.written} ({where(topic.end.place, place)}), which no "
                "bridge carries",
                write(
                    place,
                    entry.gz.value,
                    near if is_bare else f"/{near}",
                ),
            )


def scoped_frames(around: Surroundings) -> Iterator[Problem]:
    """Report sensors whose messages reach ROS with a frame that Gazebo generated."""
    every = around.bridged
    if any(e.kind == "Pose_V" and e.scoped for e in every):
        # A bridge may also carry the frames of Gazebo.
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
        named = _names_frame(sensor, around.robot.gazebo)
        if named or any(text.endswith(f"/{name}") for text in said):
            continue
        for topic in topics_of_sensor(sensor):
            brings = (e for e in every if e.reaches_ros and _fits(e, topic))
            entry = next(brings, None)
            read = entry is not None and bare(entry.ros.value) in filtered
            if entry is not None and (topic.kind in _PLACED or read):
                place = topic.end.place
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
"""Messages that are useless without a transform."""


def _names_frame(sensor: Element, parts: Sequence[Element]) -> bool:
    """Return whether a sensor names its frame, be it beside it or as Classic does.

    Other rules report those.
    """
    beside = (c for part in parts if sensor in part.children for c in part.children)
    classic = any(child.tag in SENSOR_FRAMES for child in sensor.children)
    named = ("frame_id" in each.tag for each in (*sensor.iter(), *beside))
    return classic or any(named)

"""The two types of a topic that a bridge carries."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sambot_viz.checks.around.gazebo.topics import GazeboTopic, model_topics
from sambot_viz.checks.around.parameters.copied_inputs import as_other_sensor
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import BridgeEntry, bare
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.topics.read import published_topics, used_topics
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import exchange, together, write
from sambot_viz.errors import Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

_PAIRS = vocabulary("ros_gz_bridge")
"""ROS type → the types of Gazebo to which ros_gz_bridge converts it."""

_GZ_TYPES = frozenset(kind for kinds in _PAIRS.values() for kind in kinds)
_OTHER_GZ_TYPES = frozenset(
    """
    AirSpeed Double_V DVLVelocityTracking EntityFactory EntityFactory_V Light_V
    LogPlaybackControl LogPlaybackStatistics Material Pose2D Vector2d Visual
    WorldControlState WrenchVisual
    """.split()
)
_GZ_PACKAGES = ("gz.msgs", "ignition.msgs")
_WHOLE_GZ_TYPES = frozenset(f"{p}.{kind}" for p in _GZ_PACKAGES for kind in _GZ_TYPES)
_LIKE_TYPE = 0.87
_CLOUDS = frozenset({"LaserScan", "PointCloud2"})


def counterpart(written: str) -> str | None:
    """Return the other type of a topic for one of the two; None for an unknown one."""
    if written in _PAIRS:
        return f"gz.msgs.{_PAIRS[written][0]}"
    kind = written.rpartition(".")[2]
    return next((name for name, kinds in _PAIRS.items() if kind in kinds), None)


def unknown_bridge_types(around: Surroundings) -> Iterator[Problem]:
    """Report misspelt types, which a bridge does not know."""
    for entry in around.bridged:
        exchanged = next(_exchanged(entry), None)
        if exchanged is not None:
            yield exchanged
            continue
        for fact, near in (
            (entry.ros_type, _near_ros_type(entry.ros_type.value)),
            (entry.gz_type, _near_gz_type(entry.gz_type.value)),
        ):
            if near is not None:
                yield Problem.at(
                    fact.place,
                    "warning",
                    "bridge-type-unknown",
                    f"the bridge does not know the type {fact.value}: nothing arrives "
                    f"on {entry.ros.value} ({where(entry.ros.place, fact.place)})",
                    write(fact.place, fact.value, near),
                )


def _exchanged(entry: BridgeEntry) -> Iterator[Problem]:
    """Report a type in the place of another value of the entry."""
    ros, gz = entry.ros_type, entry.gz_type
    for wrong, known in ((ros, frozenset(_PAIRS)), (gz, _WHOLE_GZ_TYPES)):
        for other in (ros, gz, entry.ros, entry.gz):
            if wrong.value not in known and other.value in known:
                yield Problem.at(
                    wrong.place,
                    "warning",
                    "bridge-type-unknown",
                    f"{wrong.value} is no type, but {other.value} is "
                    f"({where(other.place, wrong.place)}): they are exchanged, and "
                    f"nothing arrives on {entry.ros.value}",
                    exchange(
                        f"write {other.value}, and {wrong.value} there",
                        (wrong.place, wrong.value),
                        (other.place, other.value),
                    ),
                )


def _near_ros_type(written: str) -> str | None:
    """Return the known type that a text misspells; None for a known or other one."""
    known = {*_PAIRS}
    parts = [part for part in written.replace(".", "/").split("/") if part]
    if written in known or len(parts) < 2:
        return None
    packages = {name.partition("/")[0] for name in known}
    package = nearest(parts[0], packages, 0.8)
    names = [
        name.rpartition("/")[2] for name in known if name.startswith(f"{package}/")
    ]
    name = _near_name(parts[-1], names)
    return None if name is None else f"{package}/msg/{name}"


def _near_gz_type(written: str) -> str | None:
    package, _, name = written.rpartition(".")
    known = _GZ_TYPES | _OTHER_GZ_TYPES
    right = package if package in _GZ_PACKAGES else nearest(package, _GZ_PACKAGES, 0.7)
    near = _near_name(name, sorted(known)) if right else None
    better = f"{right}.{near}"
    return None if near is None or better == written else better


def _near_name(name: str, names: Sequence[str]) -> str | None:
    # Int32 and UInt32 are two types, not a misspelling.
    slips = names if name.isalpha() else ()
    same = (k for k in slips if is_one_slip(k.lower(), name.lower()))
    return (
        name if name in names else next(same, None) or nearest(name, names, _LIKE_TYPE)
    )


def bridge_types(around: Surroundings) -> Iterator[Problem]:
    """Report entries whose types do not fit each other, or the topic of the model."""
    topics = model_topics(around)
    carried = {bare(entry.gz.value) for entry in around.bridged}
    left = {t.kind for t in topics if not t.end.is_seldom and t.name not in carried}
    for entry in around.bridged:
        fitting = _PAIRS.get(entry.ros_type.value)
        if fitting is None or not _is_gz_type(entry.gz_type.value):
            continue
        own = [t for t in topics if t.name == bare(entry.gz.value)]
        if entry.kind not in fitting:
            yield _mismatch(entry, fitting, own, around)
        elif own and entry.kind not in {*left, *(t.kind for t in own)}:
            yield _misfit(entry, own[0])


def _is_gz_type(written: str) -> bool:
    """Return whether a text is a Gazebo type, even an unknown one, but not misspelt."""
    in_package = written.rpartition(".")[0] in _GZ_PACKAGES
    return in_package and _near_gz_type(written) is None


def topics_of_other_types(around: Surroundings) -> Iterator[Problem]:
    """Report published topics whose type the subscriber does not accept."""
    if _has_wrong_types(around):
        return
    published = list(published_topics(around))
    for read in used_topics(around):
        end, kind = read.end, read.end.message
        sources = [p for p in published if bare(p.topic.value) == read.name]
        # Another rule compares a costmap's sensors with their data_type.
        if not sources or end.parameter.endswith(".topic"):
            continue
        if any(p.kind in (kind, "") for p in sources):
            continue
        own = {u.name for u in used_topics(around) if u.reader == read.reader}
        fitting = [
            p
            for p in published
            # A node does not read its own topics, and the others once.
            if p.kind == kind and p.what != read.reader
            if bare(p.topic.value) not in own
        ]
        source = sources[0]
        yield Problem.at(
            end.place,
            "warning",
            "topic-type",
            f"{read.node.name} reads {end.written} as "
            f"{kind} for {end.parameter}, but {source.what} publishes it as "
            f"{source.kind} ({where(source.topic.place, end.place)}): nothing arrives",
            write(end.place, end.written, fitting[0].topic.value)
            if len(fitting) == 1
            else as_other_sensor(around, end.parameter, end.place, source.kind)
            or f"write a topic of the type {kind}",
        )


def _has_wrong_types(around: Surroundings) -> bool:
    """Return whether another rule already reports the types of a bridge."""
    return any(bridge_types(around)) or any(unknown_bridge_types(around))


def wrong_data_types(around: Surroundings) -> Iterator[Problem]:
    """Report sensors of a costmap whose topic has the other type."""
    if around.namespaced or _has_wrong_types(around):
        return
    published = list(published_topics(around))
    topics = {
        (p.node, p.name.removesuffix(".topic")): p
        for p in around.parameters
        if p.name.endswith(".topic")
    }
    for parameter in around.parameters:
        topic = topics.get((parameter.node, parameter.name.removesuffix(".data_type")))
        if topic is None or not parameter.name.endswith(".data_type"):
            continue
        name, said = bare(topic.fact.value), parameter.fact.value
        sources = {p.kind: p for p in published if bare(p.topic.value) == name}
        if said not in _CLOUDS or len(sources) != 1 or said in sources:
            continue
        ((kind, source),) = sources.items()
        if kind in _CLOUDS:
            yield Problem.at(
                parameter.value_place,
                "warning",
                "topic-type",
                f"{parameter.node.rpartition('/')[2]} reads {topic.fact.value} as "
                f"{said}, but {source.what} publishes it as {kind} "
                f"({where(source.topic.place, parameter.place)}): nothing arrives",
                write(parameter.value_place, said, kind),
            )


def _mismatch(
    entry: BridgeEntry,
    fitting: Sequence[str],
    own: Sequence[GazeboTopic],
    around: Surroundings,
) -> Problem:
    """Report two types that do not match; the model or a subscriber decides."""
    better, why = f"{_package(entry)}.{fitting[0]}", ""
    wrong, other = entry.gz_type, entry.ros_type
    ros_type = _ros_type(entry.kind, entry.ros_type.value)
    readers = (r.end for r in used_topics(around) if r.name == bare(entry.ros.value))
    read = next(readers, None)
    sender = next((t for t in own if t.kind == entry.kind), None)
    if sender is not None:
        why = f"; {sender.what} sends {entry.kind}"
    elif not own and read is not None and ros_type == read.kind:
        why = f"; {where(read.place, entry.ros_type.place)} reads {read.message}"
    if why:
        better, wrong, other = ros_type, entry.ros_type, entry.gz_type
    return Problem.at(
        wrong.place,
        "warning",
        "bridge-types",
        f"the bridge cannot turn {entry.gz_type.value} into {entry.ros_type.value} "
        f"({where(other.place, wrong.place)}): nothing arrives on "
        f"{entry.ros.value}{why}",
        write(wrong.place, wrong.value, better),
    )


def _misfit(entry: BridgeEntry, topic: GazeboTopic) -> Problem:
    """Report a type that differs from the type of the topic in Gazebo."""
    ros_type = _ros_type(topic.kind, entry.ros_type.value)
    place = entry.gz_type.place
    better = f"{_package(entry)}.{topic.kind}"
    return Problem.at(
        place,
        "warning",
        "bridge-types",
        f"the bridge expects {entry.gz_type.value} on {entry.gz.value}, but "
        f"{topic.what} uses it for {topic.kind} ({where(topic.end.place, place)}): "
        "nothing passes",
        together(
            f"write {better}, and {ros_type} in ROS",
            write(place, entry.gz_type.value, better),
            write(entry.ros_type.place, entry.ros_type.value, ros_type),
        ),
    )


def _package(entry: BridgeEntry) -> str:
    return entry.gz_type.value.rpartition(".")[0]


def _ros_type(kind: str, written: str) -> str:
    """Return the ROS type for a Gazebo type; of several, the nearest to the text."""
    fitting = [name for name, kinds in _PAIRS.items() if kind in kinds]
    return nearest(written, fitting, 0.0) or written

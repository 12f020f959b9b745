"""Two different sensors of a model that send on one topic."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.gazebo.topics import GazeboTopic, doubled_topics
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.running.known import SENSOR
from sambot_viz.checks.around.running.system import GivenParameter, RunningNode
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.errors import Problem


def shared_topics(around: Surroundings) -> Iterator[Problem]:
    """Report the second of two sensors of different types with one topic."""
    doubled = doubled_topics(around)
    first: dict[str, tuple[RunningNode, GivenParameter]] = {}
    for node in around.running.started if doubled else ():
        given = node.parameter("topic") if node.package == SENSOR else None
        name = bare(given.value or "") if given is not None else ""
        if given is None or name not in doubled:
            continue
        other = first.setdefault(name, (node, given))
        if other[0].executable != node.executable:
            yield _finding(around, other, (node, given))


def _finding(
    around: Surroundings,
    one: tuple[RunningNode, GivenParameter],
    two: tuple[RunningNode, GivenParameter],
) -> Problem:
    """Find which of the two a bridge expects on another topic."""
    if _expected(around, one[0]) is not None and _expected(around, two[0]) is None:
        one, two = two, one
    (other, there), (sensor, given) = one, two
    expected = _expected(around, sensor)
    better, why = sensor.name, ""
    if expected is not None:
        better, gz = expected
        why = f"; a bridge expects {gz.value} ({where(gz.place, given.place)})"
    return Problem.at(
        given.place,
        "warning",
        "sensor-topic-shared",
        f"the sensors {other.name} ({where(there.place, given.place)}) and "
        f"{sensor.name} send different messages on one topic, {given.value}{why}",
        f"write <topic>{better}</topic>",
    )


def _expected(around: Surroundings, sensor: RunningNode) -> tuple[str, Fact] | None:
    """Return the topic that a bridge expects of a sensor, by an entry for its type."""
    topics = [GazeboTopic(sensor, end) for end in sensor.endpoints]
    names = {topic.name for topic in topics}
    kinds = {entry.kind for entry in around.bridged if bare(entry.gz.value) in names}
    given = sensor.parameter("topic")
    base = bare(given.value or "") if given is not None else ""
    for topic in (topic for topic in topics if not topic.end.is_seldom):
        ending = topic.name.removeprefix(base)
        for entry in around.bridged:
            name = bare(entry.gz.value)
            if entry.kind != topic.kind or name in names or entry.kind in kinds:
                continue
            if name.endswith(ending) and name != ending:
                return name.removesuffix(ending), entry.gz
    return None

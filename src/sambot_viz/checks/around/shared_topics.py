"""Two different sensors of a model that send on one topic."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.around.bridges import entries
from sambot_viz.checks.around.files.gazebo import Fact, facts, sensors
from sambot_viz.checks.around.gazebo_topics import doubled_topics, topics_of_sensor
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import BridgeEntry, bare
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.errors import Problem
from sambot_viz.robot.xml.element import Element


def shared_topics(around: Surroundings) -> Iterator[Problem]:
    """Report the second of two sensors of different types with one topic."""
    doubled = doubled_topics(around)
    first: dict[str, tuple[Element, Fact]] = {}
    for _link, sensor in sensors(around.robot.gazebo) if doubled else ():
        for fact in facts(sensor, "topic")[:1]:
            if bare(fact.value) not in doubled:
                continue
            other = first.setdefault(bare(fact.value), (sensor, fact))
            if other[0].get("type") != sensor.get("type"):
                yield _finding(around, other, (sensor, fact))


def _finding(
    around: Surroundings, one: tuple[Element, Fact], two: tuple[Element, Fact]
) -> Problem:
    """Find which of the two a bridge expects on another topic."""
    every = entries(around)
    expected = {id(sensor): _expected(sensor, every) for sensor, _ in (one, two)}
    if expected[id(one[0])] is not None and expected[id(two[0])] is None:
        one, two = two, one
    (other, there), (sensor, fact) = one, two
    entry = expected[id(sensor)]
    better, why = sensor.get("name") or "", ""
    if entry is not None:
        better, gz = entry
        why = f"; a bridge expects {gz.value} ({where(gz.place, fact.place)})"
    return Problem.at(
        fact.place,
        "warning",
        "sensor-topic-shared",
        f"the sensors {other.get('name')} ({where(there.place, fact.place)}) and "
        f"{sensor.get('name')} send different messages on one topic, "
        f"{fact.value}{why}",
        f"write <topic>{better}</topic>",
    )


def _expected(sensor: Element, every: list[BridgeEntry]) -> tuple[str, Fact] | None:
    """The topic that a sensor would have by an entry of a bridge for its type."""
    topics = list(topics_of_sensor(sensor))
    names = {bare(topic.name.value) for topic in topics}
    kinds = {entry.kind for entry in every if bare(entry.gz.value) in names}
    base = bare(facts(sensor, "topic")[0].value)
    for topic in (topic for topic in topics if topic.wanted):
        ending = bare(topic.name.value).removeprefix(base)
        for entry in every:
            name = bare(entry.gz.value)
            if entry.kind != topic.kind or name in names or entry.kind in kinds:
                continue
            if name.endswith(ending) and name != ending:
                return name.removesuffix(ending), entry.gz
    return None

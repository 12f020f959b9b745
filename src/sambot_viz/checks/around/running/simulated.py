"""Represent sensors and plugins of a model as nodes, which Gazebo runs."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from sambot_viz.checks.around.files.gazebo import Plugin, plugins, sensors
from sambot_viz.checks.around.running.known import SENSOR, SYSTEM
from sambot_viz.checks.around.running.system import GivenParameter, RunningNode
from sambot_viz.errors import Place
from sambot_viz.robot.xml.element import Element

_FILE = re.compile(r"(?:lib)?(?:gz-sim\d*|ignition-gazebo\d*)-([a-z-]+)-system(\.so)?")
_OPEN = re.compile(r"\$[({]")
_CLASSIC = "gazebo_ros"
_SIMULATORS = {
    "gz sim": "ros_gz_sim",
    "ign gazebo": "ros_ign_gazebo",
    "gazebo": "gazebo_ros",
    "gzserver": "gazebo_ros",
}
"""A program of Gazebo → the package of the node that represents it."""


def simulated(parts: Sequence[Element]) -> Iterator[RunningNode]:
    """Yield the nodes that Gazebo runs for a model, even if nothing starts Gazebo.

    Args:
        parts: `Robot.gazebo`.
    """
    for _, sensor in sensors(parts):
        yield from sensor_node(sensor)
    for plugin in plugins(parts):
        found = _FILE.fullmatch(plugin.filename)
        if found is not None:
            yield _node(SYSTEM, found[1], plugin.filename, plugin.element)
        elif plugin.generation == "classic":
            yield _of_classic(plugin)


def simulator_of(words: Sequence[str]) -> tuple[str, tuple[str, ...]] | None:
    """Return the package of Gazebo and its arguments; None for another command."""
    for program, package in _SIMULATORS.items():
        count = len(program.split())
        if [*words[:count]] == program.split():
            return package, tuple(words[count:])
    return None


def sensor_node(sensor: Element) -> Iterator[RunningNode]:
    """Yield the node for a <sensor>; none for one of Gazebo Classic."""
    if any("libgazebo_" in (c.get("filename") or "") for c in sensor.children):
        return
    kind = (sensor.get("type") or "").removesuffix("_sensor")
    # A topic at a wrong place in it is a separate problem.
    topics = [each for each in sensor.iter() if each.tag == "topic"]
    yield _node(SENSOR, kind, sensor.get("name") or "", sensor, topics)


def _node(
    package: str,
    program: str,
    name: str,
    element: Element,
    more: Sequence[Element] = (),
) -> RunningNode:
    elements = (*element.children, *more)
    given = tuple(_given(c.tag, c.text, c.place) for c in elements)
    # Gazebo reads the first of two elements.
    return possible_node(package, program, name, "/", given[::-1], element.place)


def _of_classic(plugin: Plugin) -> RunningNode:
    """Return a plugin of Gazebo Classic, whose topics remappings name."""
    element, namespace = plugin.element, "/"
    given = [_given(c.tag, c.text, c.place) for c in element.children]
    ros = element.find("ros")
    for child in ros.children if ros is not None else ():
        old, becomes, new = child.text.strip().partition(":=")
        if child.tag == "remap":
            old, becomes, new = child.get("from") or "", ":=", child.get("to") or ""
        if child.tag == "namespace":
            namespace = f"/{child.text.strip().strip('/')}"
        elif becomes:
            given.append(_given(old.removeprefix("~/"), new, child.place))
    name = element.get("name") or ""
    return possible_node(
        _CLASSIC, plugin.filename, name, namespace, tuple(given), element.place
    )


def possible_node(
    package: str,
    program: str,
    name: str,
    namespace: str,
    given: tuple[GivenParameter, ...],
    place: Place,
) -> RunningNode:
    """Return a node that no launch file starts, with all of its parameters."""
    return RunningNode(
        package, program, name, namespace, "unknown", given, True, (), (), place
    )


def _given(name: str, text: str, place: Place) -> GivenParameter:
    known = bool(text.strip()) and _OPEN.search(text) is None
    return GivenParameter(name, (text.strip(),) if known else None, place)

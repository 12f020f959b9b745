"""Check the worlds that launch files start: their text and required systems."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import NamedTuple

from sambot_viz.checks.around.files.gazebo import sensors
from sambot_viz.checks.around.gazebo.spawning import spawned_with
from sambot_viz.checks.around.gazebo.systems import faulty_system, near_system
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.errors import Place, Problem
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element, parse_xml

_WORLD = re.compile(r"<world\s")
_SYSTEM = re.compile(
    r"<plugin[^>]*name\s*=\s*[\"'](?:lib)?(?:gz-sim|ignition-gazebo)\d*(-[\w-]+?)"
    r"(?:\.so)?[\"']"
)
_PHYSICS, _SCENE = "gz-sim-physics-system", "gz-sim-scene-broadcaster-system"
_RENDERED = ("gz-sim-sensors-system", "Sensors")
_NEEDED: dict[str, tuple[str, str]] = {
    "imu": ("gz-sim-imu-system", "Imu"),
    "navsat": ("gz-sim-navsat-system", "NavSat"),
    "magnetometer": ("gz-sim-magnetometer-system", "Magnetometer"),
    "altimeter": ("gz-sim-altimeter-system", "Altimeter"),
    **dict.fromkeys(
        ("camera", "depth_camera", "rgbd_camera", "gpu_lidar", "thermal_camera"),
        _RENDERED,
    ),
}
"""Type of a sensor → the system that it needs: its file and its name."""


class _Need(NamedTuple):
    """A system that the world must have.

    Attributes:
        file: of the plugin.
        name: of its class, without the namespace.
        by: the sensor or plugin that needs it.
        place: the place of that, or None.
        follows: the consequence without it.
    """

    file: str
    name: str
    by: str
    place: Place | None
    follows: str


def missing_systems(around: Surroundings) -> Iterator[Problem]:
    """Report a world with systems that lacks a required one."""
    worlds = _worlds(around)
    if len(worlds) != 1:
        return
    ((shown, text),) = worlds.items()
    in_world = {f"gz-sim{name}" for name in _SYSTEM.findall(text)}
    has = in_world | {
        plugin.filename.removeprefix("lib").removesuffix(".so")
        for plugin in around.plugins
    }
    if in_world.isdisjoint({_PHYSICS, _SCENE}):
        # Gazebo adds its own systems to a world without any.
        return
    first = _WORLD.search(text)
    line = text.count("\n", 0, first.start() if first else 0) + 1
    place = Place(shown, line)
    needs = {need.file: need for need in reversed([*_needs(around)])}
    for need in reversed(needs.values()):
        # Another rule reports a class with another file, or a misspelt file.
        is_named = re.search(rf"::{need.name}[\"']", text) is not None
        if need.file in has or is_named or near_names(need.file, has):
            continue
        inner = "<render_engine>ogre2</render_engine>" if need.name == "Sensors" else ""
        there = f" ({where(need.place, place)})" if need.place is not None else ""
        yield Problem.at(
            place,
            "warning",
            "world-system",
            f"the world has no {need.file}, which {need.by} needs{there}: "
            f"{need.follows}",
            f'add <plugin filename="{need.file}" name="gz::sim::systems::{need.name}">'
            f"{inner}</plugin> to the world",
        )


def near_names(wanted: str, has: Iterable[str]) -> bool:
    """Return whether another rule reports a misspelt name."""
    return any(near_system(name) == wanted for name in has)


def _needs(around: Surroundings) -> Iterator[_Need]:
    """Yield the systems that the world needs, the most important first."""
    name = around.robot.name
    yield _Need(_PHYSICS, "Physics", f"the robot {name}", None, "it does not move")
    for launch in around.launches:
        for fact in (*spawned_with(launch, "world"), *spawned_with(launch, "topic")):
            yield _Need(
                "gz-sim-user-commands-system",
                "UserCommands",
                "the spawner",
                fact.place,
                "the robot does not appear",
            )
    for _link, sensor in sensors(around.robot.gazebo):
        file, system = _NEEDED.get(sensor.get("type") or "", ("", ""))
        if file:
            by = f"the sensor {sensor.get('name')}"
            yield _Need(file, system, by, sensor.place, "it sends nothing")


def unreadable_worlds(around: Surroundings) -> Iterator[Problem]:
    """Report worlds that are not XML."""
    for shown, text in _worlds(around).items():
        world = _read(text, shown)
        if isinstance(world, XmlFault):
            yield Problem.at(
                Place(shown, world.line),
                "error",
                "world-xml",
                f"this world is not XML ({world.message}): Gazebo stops with it",
                "correct this line or the one above it: each <tag> needs its </tag>",
            )


def plugins_of_worlds(around: Surroundings) -> Iterator[Problem]:
    """Report plugins of a world that Gazebo does not load."""
    plugins = [e for e in elements_of_worlds(around) if e.tag == "plugin"]
    for plugin in plugins:
        others = (o for o in plugins if o is not plugin and _in_one_file(o, plugin))
        problem = faulty_system(plugin, {o.get("filename") or "" for o in others})
        if problem is not None:
            yield problem


def _in_one_file(one: Element, other: Element) -> bool:
    return one.place.file == other.place.file


def elements_of_worlds(around: Surroundings) -> Iterator[Element]:
    """Yield the elements of the worlds themselves, without those of models."""
    for shown, text in _worlds(around).items():
        world = _read(text, shown)
        waiting = [] if isinstance(world, XmlFault) else [world]
        while waiting:
            element = waiting.pop()
            yield element
            waiting += [e for e in reversed(element.children) if e.tag != "model"]


@lru_cache(maxsize=4)
def _read(text: str, shown: str) -> Element | XmlFault:
    """Return the root of a world, or the fault that makes it unreadable."""
    try:
        return parse_xml(text, shown)
    except XmlFault as fault:
        return fault


def _worlds(around: Surroundings) -> dict[str, str]:
    """Return the world files that launch files use, each with its text."""
    return {
        shown: text
        for launch in around.launches
        for fact in launch.paths
        if (shown := around.shown(fact.value) or "").endswith((".sdf", ".world"))
        and (text := around.text(fact.value)) is not None
        and _WORLD.search(text)
    }

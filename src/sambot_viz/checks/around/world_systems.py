"""Systems of Gazebo that the sensors of the model need from the world."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import sensors
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.errors import Place, Problem

_WORLD = re.compile(r"<world\s")
_SYSTEM = re.compile(
    r"<plugin[^>]*filename\s*=\s*[\"'](?:lib)?(gz-sim-[\w-]+?)(?:\.so)?[\"']"
)
_PHYSICS = "gz-sim-physics-system"
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


def missing_systems(around: Surroundings) -> Iterator[Problem]:
    """Report a world without the system of a sensor, beside other systems."""
    worlds = _worlds(around)
    if len(worlds) != 1:
        return
    ((shown, text),) = worlds.items()
    has = set(_SYSTEM.findall(text)) | {
        plugin.filename.removeprefix("lib").removesuffix(".so")
        for plugin in around.plugins
    }
    if _PHYSICS not in has:
        # Without a list of systems of its own, or with a part of one.
        return
    missing: set[str] = set()
    for _link, sensor in sensors(around.robot.gazebo):
        file, name = _NEEDED.get(sensor.get("type") or "", ("", ""))
        if not file or file in has or file in missing:
            continue
        missing.add(file)
        first = _WORLD.search(text)
        line = text.count("\n", 0, first.start() if first else 0) + 1
        place = Place(shown, line)
        inner = (
            "<render_engine>ogre2</render_engine>" if (file, name) == _RENDERED else ""
        )
        yield Problem.at(
            place,
            "warning",
            "world-system",
            f"the world has no {file}, which the sensor {sensor.get('name')} needs "
            f"({where(sensor.place, place)}): it sends nothing",
            f'add <plugin filename="{file}" name="gz::sim::systems::{name}">{inner}'
            "</plugin> to the world",
        )


def _worlds(around: Surroundings) -> dict[str, str]:
    """The world files of the packages that launch files use, each with its text."""
    return {
        shown: text
        for launch in around.launches
        for fact in launch.paths
        if (shown := around.shown(fact.value) or "").endswith((".sdf", ".world"))
        and (text := around.text(fact.value)) is not None
        and _WORLD.search(text)
    }

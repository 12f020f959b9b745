"""The robots of the collection, with the values of xacro's arguments that they need."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quick_yaml import quick_yaml

_ARGUMENTS = {
    "vehicle_model": "sample_vehicle",
    "sensor_model": "sample_sensor_kit",
    "DEBUG": "false",
    "namespace": "",
    "enable_mavlink_interface": "false",
    "enable_ground_truth": "false",
    "enable_logging": "false",
    "enable_cameras": "false",
    "enable_depth": "false",
}


@dataclass(frozen=True, slots=True)
class RealRobot:
    """A robot of other people.

    Attributes:
        path: of its model, from the folder of the robots.
        expected: how it has to end, in words.
        arguments: values for xacro's arguments.
    """

    path: str
    expected: str
    arguments: dict[str, str]


def real_robots(folder: Path) -> list[RealRobot]:
    """Return the robots that the index of a folder lists."""
    entries: list[dict[str, Any]] = quick_yaml(folder / "index.yaml")["robots"]
    return [_robot(entry["path"], entry["expected"]) for entry in entries]


def _robot(path: str, expected: str) -> RealRobot:
    wanted = expected.partition(" with args ")[2].split("|")
    arguments = {name: _ARGUMENTS[name] for name in wanted if name in _ARGUMENTS}
    return RealRobot(path, expected, arguments)

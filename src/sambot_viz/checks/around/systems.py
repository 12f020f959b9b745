"""Plugins that Gazebo cannot load, and numbers of drives that it cannot read."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import Fact, Plugin, facts, plugins
from sambot_viz.checks.around.place import where
from sambot_viz.errors import Problem
from sambot_viz.robot.model import Robot

_SYSTEMS = {
    "diff-drive": "DiffDrive",
    "joint-state-publisher": "JointStatePublisher",
    "joint-position-controller": "JointPositionController",
    "joint-trajectory-controller": "JointTrajectoryController",
    "ackermann-steering": "AckermannSteering",
    "mecanum-drive": "MecanumDrive",
    "odometry-publisher": "OdometryPublisher",
    "pose-publisher": "PosePublisher",
    "sensors": "Sensors",
    "imu": "Imu",
    "contact": "Contact",
}
"""Systems of Gazebo whose class has the name of their file."""

_FILE = re.compile(r"(?:lib)?(gz-sim\d*|ignition-gazebo\d*)-([a-z-]+)-system(?:\.so)?")
_SPACE = {"gz": "gz::sim::systems", "ignition": "ignition::gazebo::systems"}
_NUMBERS = (
    "wheel_separation",
    "wheel_radius",
    "wheel_diameter",
    "wheelSeparation",
    "wheelDiameter",
    "odom_publish_frequency",
    "update_rate",
)
_COMMA = re.compile(r"-?\d+,\d+")


def attributes(system: str) -> str:
    """Return the attributes of a plugin that loads a system, such as "diff-drive"."""
    name = f"{_SPACE['gz']}::{_SYSTEMS[system]}"
    return f'filename="gz-sim-{system}-system" name="{name}"'


def unknown_classes(robot: Robot) -> Iterator[Problem]:
    """Report plugins of Gazebo whose name is not that of the class in their file."""
    for plugin in plugins(robot.gazebo):
        file = _FILE.fullmatch(plugin.filename)
        system = _SYSTEMS.get(file[2]) if file else None
        name = (plugin.element.get("name") or "").strip()
        if file is None or system is None or name.rpartition("::")[2] == system:
            continue
        right = f"{_SPACE[file[1].partition('-')[0]]}::{system}"
        yield Problem.at(
            plugin.element.place,
            "warning",
            "gazebo-plugin",
            f"{plugin.filename} has no class {name or 'without a name'}: in Gazebo the "
            "name of a plugin is that of its class, and it does not load this one",
            f'write name="{right}"',
        )


def both_generations(robot: Robot) -> Iterator[Problem]:
    """Report a drive of Gazebo Classic among plugins of Gazebo, or the reverse."""
    found = [plugin for plugin in plugins(robot.gazebo) if plugin.generation]
    drives = [plugin for plugin in found if plugin.is_drive]
    others = [plugin for plugin in found if not plugin.is_drive]
    if len({plugin.generation for plugin in drives}) != 1:
        return
    drive = drives[0]
    if not others or drive.generation in {plugin.generation for plugin in others}:
        return
    yield Problem.at(
        drive.element.place,
        "warning",
        "gazebo-generation",
        f"{drive.filename} is for {_NAMES[drive.generation == 'gz']}, and the other "
        f"plugins, such as {others[0].filename} "
        f"({where(others[0].element.place, drive.element.place)}), are for "
        f"{_NAMES[drive.generation != 'gz']}: one simulator loads only its own, and "
        "the robot does not drive",
        f"write {_DRIVES[drive.generation != 'gz']}, and the elements that it reads",
    )


_NAMES = ("Gazebo Classic", "Gazebo")
_DRIVES = (
    'filename="libgazebo_ros_diff_drive.so"',
    attributes("diff-drive"),
)


def malformed_numbers(robot: Robot) -> Iterator[Problem]:
    """Report numbers of a drive with a comma, or with a unit."""
    for plugin in plugins(robot.gazebo):
        for fact in facts(plugin.element, *_NUMBERS) if plugin.is_drive else ():
            if fact.number is None:
                yield _malformed(plugin, fact)


def _malformed(plugin: Plugin, fact: Fact) -> Problem:
    comma = _COMMA.fullmatch(fact.value)
    return Problem.at(
        fact.place,
        "warning",
        "gazebo-plugin",
        f"{fact.value} is no number for {plugin.filename} "
        f"({where(plugin.element.place, fact.place)}): Gazebo uses another value",
        f"write {fact.value.replace(',', '.')}" if comma else "write a number alone",
    )

"""Names of Gazebo Classic, of Gazebo and of ROS 1 that do not work together."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import Generation, Plugin
from sambot_viz.checks.around.gazebo.starts import NAMES, may_start, starts
from sambot_viz.checks.around.gazebo.systems import among_others, attributes
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import rename_element, write
from sambot_viz.errors import Place, Problem

_PLUGINS: dict[str, tuple[str, str]] = {
    "diff": ("libgazebo_ros_diff_drive.so", "diff-drive"),
    "joint": ("libgazebo_ros_joint_state_publisher.so", "joint-state-publisher"),
    "imu": ("libgazebo_ros_imu_sensor.so", "imu"),
    "sensor": ("libgazebo_ros_ray_sensor.so", "sensors"),
}
_ELEMENTS = {
    "wheel_diameter": ("wheel_radius", "half of it"),
    "odometry_topic": ("odom_topic", "the same"),
    "odometry_frame": ("frame_id", "the same"),
    "robot_base_frame": ("child_frame_id", "the same"),
    "command_topic": ("topic", "the same"),
}
"""Elements of Classic's differential drive, and those that Gazebo's reads instead."""

_HARDWARE: dict[str, tuple[Generation, str]] = {
    "gazebo_ros2_control/GazeboSystem": ("classic", "gazebo_ros2_control"),
    "gz_ros2_control/GazeboSimSystem": ("gz", "gz_ros2_control"),
    "ign_ros2_control/IgnitionSystem": ("gz", "ign_ros2_control"),
}
"""Hardware of ros2_control → its Gazebo, and the name of its plugin."""

_XACRO_PY = re.compile(r"(^|[\s/])xacro\.py\b")
_BUILD_TYPE = re.compile(r"<build_type>\s*(ament_\w+)")


def plugins_of_the_other(around: Surroundings) -> Iterator[Problem]:
    """Report plugins for a Gazebo that no launch file starts, in one finding."""
    first = [start for launch in around.launches for start in starts(launch)]
    started = {kind for launch in around.launches for kind in may_start(launch)}
    made_for = {plugin.generation: plugin for plugin in reversed(around.plugins)}
    kinds = made_for.keys() - {None}
    if len(started) != 1 or not first or not kinds or kinds & started:
        return
    plugin = made_for[next(iter(kinds))]
    start = next((start for start in first if start.simulates), first[0])
    other = plugin.generation or "classic"
    yield Problem.at(
        plugin.element.place,
        "warning",
        "gazebo-generation",
        f"the plugin {plugin.filename} is for {NAMES[other]}, but "
        f"{where(start.place, plugin.element.place)} starts {NAMES[start.generation]} "
        f"({start.what}), which cannot load it",
        _replacement(plugin, start.generation),
    )


def hardware_of_the_other(around: Surroundings) -> Iterator[Problem]:
    """Report a <hardware> of ros2_control for another Gazebo than the plugin."""
    plugins = [p for p in around.plugins if "ros2_control" in p.filename]
    made_for = {plugin.generation: plugin for plugin in plugins}
    for part in around.robot.gazebo if len(made_for) == 1 else ():
        for element in part.iter() if part.tag == "ros2_control" else ():
            kind = element.text.strip()
            known = _HARDWARE.get(kind) if element.tag == "plugin" else None
            plugin = plugins[0]
            if known is None or plugin.generation in (known[0], None):
                continue
            fitting = (
                k for k, (_, name) in _HARDWARE.items() if name in plugin.filename
            )
            right = next(fitting, None)
            yield Problem.at(
                element.place,
                "warning",
                "gazebo-generation",
                f"the hardware {kind} is for {NAMES[known[0]]}, but the plugin "
                f"{plugin.filename} ({where(plugin.element.place, element.place)}) is "
                "for the other one: no controller gets the joints",
                write(element.place, kind, right)
                if right
                else "write that of the plugin",
            )


def _replacement(plugin: Plugin, wanted: Generation) -> str:
    """Name the equivalent plugin of the other Gazebo."""
    for mark, (classic, system) in _PLUGINS.items():
        if mark in plugin.filename:
            name = attributes(system) if wanted == "gz" else f'filename="{classic}"'
            return f"write {name}, and the elements that it reads"
    return f"use the plugin of {NAMES[wanted]}, or start the other one"


def elements_of_the_other(around: Surroundings) -> Iterator[Problem]:
    """Report elements of Classic's differential drive in that of Gazebo."""
    for plugin in around.plugins:
        if plugin.generation != "gz" or not plugin.is_drive:
            continue
        if among_others(plugin, around.plugins) is not None:
            continue
        present = {child.tag for child in plugin.element.children}
        for child in plugin.element.children:
            better, value = _ELEMENTS.get(child.tag, ("", ""))
            hint = f"write <{better}>, with {value} as its value"
            if better and better not in present:
                yield Problem.at(
                    child.place,
                    "warning",
                    "gazebo-element",
                    f"<{child.tag}> is of Gazebo Classic: {plugin.filename} "
                    f"({where(plugin.element.place, child.place)}) does not read it "
                    "and uses its own default",
                    rename_element(child.place, child.tag, better, hint)
                    if value == "the same"
                    else hint,
                )


def xacro_py(around: Surroundings) -> Iterator[Problem]:
    """Report xacro.py, which only ROS 1 has, in a package of ROS 2."""
    manifest = around.files.text("package.xml") or ""
    build = _BUILD_TYPE.search(manifest)
    if build is None:
        return
    line = manifest.count("\n", 0, build.start()) + 1
    other = Place(around.files.shown("package.xml"), line)
    for launch in around.launches:
        for node in ast.walk(launch.tree):
            text = node.value if isinstance(node, ast.Constant) else None
            if isinstance(text, str) and "\n" not in text and _XACRO_PY.search(text):
                place = launch.place(node) if isinstance(node, ast.expr) else other
                yield Problem.at(
                    place,
                    "warning",
                    "launch-xacro-py",
                    f"xacro.py is of ROS 1, but this package is for ROS 2 "
                    f"({build[1]} in {where(other, place)}): it does not exist there",
                    write(place, "xacro.py", "xacro"),
                )

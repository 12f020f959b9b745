"""What a launch file tells the program that puts the robot into Gazebo."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import pairwise

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.launch import LaunchFile
from sambot_viz.checks.around.files.launch_values import keyword, values_for
from sambot_viz.checks.launch_files import call_name

_SPAWNS = "gz_spawn_model.launch.py"
_PROGRAMS = {"create": "ros_gz_sim", "spawn_entity.py": "gazebo_ros"}
"""Program → its package."""


def spawned_with(launch: LaunchFile, option: str) -> Iterator[Fact]:
    """Give what is said for an option wherever a robot is put into a world.

    Args:
        launch: the launch file.
        option: "world" or "topic".
    """
    for call in launch.actions:
        source = launch.values.text(keyword(call, "launch_description_source", 0))
        if call_name(call.func) == "IncludeLaunchDescription":
            if source is not None and source.endswith(_SPAWNS):
                given = keyword(call, "launch_arguments")
                yield from _in_table(launch, given, option)
        else:
            yield from _of_program(launch, call, option)


def _of_program(launch: LaunchFile, call: ast.Call, option: str) -> Iterator[Fact]:
    """What a node is told, in arguments or parameters."""
    text, items = launch.values.text, launch.values.items
    program = text(keyword(call, "executable")) or ""
    if text(keyword(call, "package")) != _PROGRAMS.get(program, ""):
        return
    for name, value in pairwise(items(keyword(call, "arguments"))):
        said = text(value)
        if text(name) == f"-{option}" and said:
            yield Fact(said, launch.place(value))
    for item in items(keyword(call, "parameters")):
        yield from _in_table(launch, item, option)


def _in_table(
    launch: LaunchFile, given: ast.expr | None, option: str
) -> Iterator[Fact]:
    inner = given.func if isinstance(given, ast.Call) else None
    table = inner.value if isinstance(inner, ast.Attribute) else given
    if not isinstance(table, ast.Dict):
        return
    for value in values_for(table, option):
        text = launch.values.text(value)
        if text:
            yield Fact(text, launch.place(value))

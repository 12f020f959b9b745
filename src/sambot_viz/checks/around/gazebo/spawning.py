"""Read the options of the program that puts the robot into Gazebo."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call, PythonValue, Table

_SPAWNS = "gz_spawn_model.launch.py"
_PROGRAMS = {"create": "ros_gz_sim", "spawn_entity.py": "gazebo_ros"}
"""Program → its package."""


class SpawnOption(NamedTuple):
    """An option of the program that puts the robot into Gazebo.

    Attributes:
        fact: the value.
        node: the expression of the value.
    """

    fact: Fact
    node: ast.expr


def spawned_with(launch: LaunchFile, option: str) -> Iterator[Fact]:
    """Yield the values of an option of all programs that put a robot into a world.

    Args:
        launch: the launch file.
        option: "world" or "topic".
    """
    return (each.fact for each in spawn_options(launch, option))


def spawn_options(launch: LaunchFile, option: str) -> Iterator[SpawnOption]:
    """Yield an option of all programs that put a robot into a world.

    Args:
        launch: the launch file.
        option: "world" or "topic".
    """
    for call in launch.certain:
        if call.name == "IncludeLaunchDescription":
            source = launch.text(call, "launch_description_source", 0)
            if source is not None and source.endswith(_SPAWNS):
                yield from _in_table(launch, call.value("launch_arguments"), option)
        else:
            yield from _of_program(launch, call, option)


def _of_program(launch: LaunchFile, call: Call, option: str) -> Iterator[SpawnOption]:
    """Yield the value of an option, in arguments or parameters of a node."""
    said = launch.values.said
    program = launch.text(call, "executable") or ""
    if launch.text(call, "package") != _PROGRAMS.get(program, ""):
        return
    for (name, _), (value, node) in pairwise(call.listing("arguments").items):
        text = said(value)
        if said(name) == f"-{option}" and text:
            yield SpawnOption(Fact(text, launch.place(node)), node)
    for item, _ in call.listing("parameters").items:
        yield from _in_table(launch, item, option)


def _in_table(
    launch: LaunchFile, table: PythonValue, option: str
) -> Iterator[SpawnOption]:
    for pair in table.pairs if isinstance(table, Table) else ():
        text = launch.values.said(pair.value) if pair.key == option else None
        if text:
            yield SpawnOption(Fact(text, launch.place(pair.node)), pair.node)

"""Check the worlds into which launch files put a robot."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.gazebo.spawning import spawn_options
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.place import rewritten, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Place, Problem

_WORLD = re.compile(r"<world\s+name\s*=\s*[\"']([^\"']+)[\"']")
_WORLDS = (".sdf", ".world", ".wbt")


def world_names(around: Surroundings) -> Iterator[Problem]:
    """Report a robot for a world with another name than the world file has."""
    for launch in around.launches:
        worlds = dict(_worlds(launch, around))
        named = list(spawn_options(launch, "world")) if len(worlds) == 1 else []
        for fact, node in named:
            (name, place), *_ = worlds.items()
            if fact.value != name and " " in name:
                yield Problem.at(
                    place,
                    "warning",
                    "launch-world-name",
                    f"the name of the world, {name}, has a blank, which names in "
                    f"Gazebo must not have; {where(fact.place, place)} puts the robot "
                    f"into {fact.value}: it does not appear",
                    f'write name="{fact.value}"',
                )
            elif fact.value != name:
                yield _other_name(launch, fact, node, name, place)


def _other_name(
    launch: LaunchFile, fact: Fact, node: ast.expr, name: str, place: Place
) -> Problem:
    fix = write(fact.place, fact.value, name)
    cause = f"the robot is put into the world {fact.value}, but the world is called"
    if fact.value.startswith(SHARE):
        cause = (
            f"the spawner takes the name of the world, and {ast.unparse(node)} is the "
            "path of its file; the world is called"
        )
    if not isinstance(node, ast.Constant):
        fix = rewritten(node, launch.shown, f"'{name}'")
        # Others may give another value to a launch argument.
        fix = fix if fact.value.startswith(SHARE) else Fix(fix.hint)
    return Problem.at(
        fact.place,
        "warning",
        "launch-world-name",
        f"{cause} {name} ({where(place, fact.place)}): it does not appear",
        fix,
    )


def _worlds(launch: LaunchFile, around: Surroundings) -> Iterator[tuple[str, Place]]:
    for fact in launch.paths:
        shown = around.shown(fact.value) or ""
        text = around.text(fact.value) if shown.endswith(_WORLDS) else None
        for match in _WORLD.finditer(text or ""):
            line = (text or "").count("\n", 0, match.start()) + 1
            yield match[1], Place(shown, line)

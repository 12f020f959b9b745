"""Check the worlds into which launch files put a robot."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.around.gazebo.spawning import spawned_with
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem

_WORLD = re.compile(r"<world\s+name\s*=\s*[\"']([^\"']+)[\"']")
_WORLDS = (".sdf", ".world", ".wbt")


def world_names(around: Surroundings) -> Iterator[Problem]:
    """Report a robot for a world with another name than the world file has."""
    for launch in around.launches:
        worlds = dict(_worlds(launch, around))
        named = list(spawned_with(launch, "world")) if len(worlds) == 1 else []
        for fact in named:
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
                yield Problem.at(
                    fact.place,
                    "warning",
                    "launch-world-name",
                    f"the robot is put into the world {fact.value}, but the world is "
                    f"called {name} ({where(place, fact.place)}): it does not appear",
                    write(fact.place, fact.value, name),
                )


def _worlds(launch: LaunchFile, around: Surroundings) -> Iterator[tuple[str, Place]]:
    for fact in launch.paths:
        shown = around.shown(fact.value) or ""
        text = around.text(fact.value) if shown.endswith(_WORLDS) else None
        for match in _WORLD.finditer(text or ""):
            line = (text or "").count("\n", 0, match.start()) + 1
            yield match[1], Place(shown, line)

"""Launch files that start parts of Gazebo and of Gazebo Classic."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import Generation
from sambot_viz.checks.around.gazebo.starts import (
    NAMES,
    PACKAGES,
    Start,
    may_start,
    starts,
)
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.place import rewritten, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import together, write
from sambot_viz.errors import Fix, Problem

_SPAWNERS: dict[Generation, tuple[str, str]] = {
    "classic": ("gazebo_ros", "spawn_entity.py"),
    "gz": ("ros_gz_sim", "create"),
}
"""The package and the program that put a robot into each Gazebo."""
_WAYS: dict[Generation, str] = {
    "classic": "gazebo.launch.py and spawn_entity.py of gazebo_ros for Classic",
    "gz": "gz_sim.launch.py and create of ros_gz_sim for Gazebo",
}

_VARIABLES: tuple[dict[Generation, tuple[str, ...]], ...] = (
    {
        "classic": ("GAZEBO_MODEL_PATH", "GAZEBO_RESOURCE_PATH"),
        "gz": ("GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH"),
    },
    {
        "classic": ("GAZEBO_PLUGIN_PATH",),
        "gz": ("GZ_SIM_SYSTEM_PLUGIN_PATH", "IGN_GAZEBO_SYSTEM_PLUGIN_PATH"),
    },
)
"""Variables of the environment with the same purpose, the last ones of Fortress."""
_OF_FORTRESS = "ign"


def started_twice(around: Surroundings) -> Iterator[Problem]:
    """Report a launch file that starts parts of both."""
    for launch, wrong, other in _both(around):
        yield Problem.at(
            wrong.place,
            "warning",
            "gazebo-both",
            f"this starts a part of {NAMES[wrong.generation]} ({wrong.what}), and "
            f"{where(other.place, wrong.place)} one of {NAMES[other.generation]} "
            f"({other.what}): they do not find each other",
            _replaced(launch, wrong, other.generation)
            if _is_alone(around, wrong)
            else f"start {_WAYS['classic']}, or {_WAYS['gz']}",
        )


def misplaced_packages(around: Surroundings) -> frozenset[str]:
    """Return the packages that launch files start only beside the other Gazebo."""
    found = (wrong for _, wrong, _ in _both(around) if _is_alone(around, wrong))
    return frozenset(_SPAWNERS[start.generation][0] for start in found)


def _both(around: Surroundings) -> Iterator[tuple[LaunchFile, Start, Start]]:
    """Yield launch files with their first part that is out of place, and the other."""
    for launch in around.launches:
        first: dict[Generation, Start] = {}
        for start in starts(launch):
            first.setdefault(start.generation, start)
        if len(first) == 2:
            classic, gz = first["classic"], first["gz"]
            pair = (gz, classic) if _is_alone(around, gz) else (classic, gz)
            yield launch, *pair


def variables_of_the_other(around: Surroundings) -> Iterator[Problem]:
    """Report variables of the environment that only the other Gazebo reads."""
    for launch in around.launches:
        begun = {start.generation: start for start in reversed(starts(launch))}
        if len(begun) != 1 or len(may_start(launch)) != 1:
            continue
        (start,) = begun.values()
        kind = start.generation
        for node in _variables_set(launch):
            said = str(node.value)
            for names in _VARIABLES:
                known = {name for each in names.values() for name in each}
                if said in known and launch.strings.isdisjoint(names[kind]):
                    right = names[kind][-1 if _OF_FORTRESS in start.what else 0]
                    place = launch.place(node)
                    yield Problem.at(
                        place,
                        "warning",
                        "gazebo-both",
                        f"only the other Gazebo reads {said}, and this launch file "
                        f"starts {NAMES[kind]} ({start.what}, "
                        f"{where(start.place, place)}): it does not find what is there",
                        write(place, said, right),
                    )


def _variables_set(launch: LaunchFile) -> Iterator[ast.Constant]:
    """Yield the names of the variables of the environment that a launch file sets."""
    for call in launch.called("AppendEnvironmentVariable", "SetEnvironmentVariable"):
        given = call.given("name", 0)
        if isinstance(given, ast.Constant):
            yield given
    for node in ast.walk(launch.tree):
        match node:
            case ast.Subscript(
                value=ast.Attribute(attr="environ") | ast.Name(id="environ"),
                slice=ast.Constant() as name,
                ctx=ast.Store(),
            ):
                yield name
            case _:
                pass


def _is_alone(around: Surroundings, start: Start) -> bool:
    """Return whether a spawner is the only part for its Gazebo.

    The others, among them a simulator and plugins or dependencies, are for the other.
    """
    every = [each for launch in around.launches for each in starts(launch)]
    others = [each for each in every if each.generation != start.generation]
    root = around.manifest
    named = {child.text.strip() for child in root.children} if root else set[str]()
    depends = {PACKAGES[name] for name in named if name in PACKAGES}
    made_for = {p.generation for p in around.plugins} - {None} or depends
    return (
        start.what == "{1} of {0}".format(*_SPAWNERS[start.generation])
        and len(every) == len(others) + 1
        and any(each.simulates for each in others)
        and bool(made_for)
        and start.generation not in made_for
    )


def _replaced(launch: LaunchFile, start: Start, wanted: Generation) -> Fix:
    """Return the fix that starts the spawner of the other Gazebo."""
    package, program = _SPAWNERS[wanted]
    call, options = start.call, vocabulary("program_options")[f"{package}/{program}"]
    named = dict(word.split("=") for word in options if "=" in word)
    pairs = [
        (call.given("package"), package),
        (call.given("executable"), program),
    ]
    known, renamed = call.listing("arguments").complete, list[str]()
    for item, node in call.listing("arguments").items:
        word = launch.values.said(item) or ""
        if word in named and isinstance(node, ast.Constant):
            pairs.append((node, named[word]))
            renamed.append(f"'{named[word]}' for '{word}'")
        elif word[:1] == "-" and word[1:2].isalpha():
            known = known and word in options
    changes = [f"package='{package}'", f"executable='{program}'", *renamed]
    hint = f"write {', '.join(changes[:-1])} and {changes[-1]}"
    if not known:
        return Fix(f"{hint}, and the options of {program}")
    fixes = [
        rewritten(node, launch.shown, repr(text))
        for node, text in pairs
        if isinstance(node, ast.Constant)
    ]
    return together(hint, *fixes) if len(fixes) == len(pairs) else Fix(hint)

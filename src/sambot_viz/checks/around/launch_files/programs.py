"""Compare the programs that launch files start with the packages that have them."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

from sambot_viz.checks.around.launch_files.built_programs import missing_program
from sambot_viz.checks.around.launching.launch_file import NODES
from sambot_viz.checks.around.misspelt import is_misspelt
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.words import meant_word
from sambot_viz.checks.around.workspace import Package
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem, nearest

_ALIKE = 0.85
_IN_PATH = frozenset({"rviz2"})
"""Programs that launch finds without a package."""


class _Program(NamedTuple):
    """A program that a launch file starts.

    Attributes:
        package: its package.
        name: the program.
        place: the place of that name.
        package_place: the place of the package's name.
    """

    package: str
    name: str
    place: Place
    package_place: Place


def _programs(around: Surroundings) -> Iterator[_Program]:
    """Yield the programs of nodes with known names."""
    for launch in around.launches:
        for call in launch.in_use:
            given, package = call.given("executable"), call.given("package")
            name = launch.text(call, "executable") if call.name in NODES else None
            said = launch.text(call, "package") if package is not None else ""
            if given is not None and name is not None and said is not None:
                place = launch.place(given)
                there = call.place if package is None else launch.place(package)
                yield _Program(said, name, place, there)
    for root in (root for package in around.packages for root in package.frontends):
        for node in root.iter():
            name, package = node.get("exec"), node.get("pkg")
            if node.tag == "node" and name and package and "$" not in name + package:
                yield _Program(package, name, node.place, node.place)


def unknown_programs(around: Surroundings) -> Iterator[Problem]:
    """Report programs that a well-known package does not have."""
    every_program = list(_programs(around))
    started = {(each.package, each.name) for each in every_program}
    for package, program, place, package_place in every_program:
        here = next((p for p in around.packages if p.name == package), None)
        own = None if here is None else _own_programs(here)
        if here is not None and here.cmake is not None:
            yield from missing_program(here, program, place)
            continue
        every = vocabulary("launch_programs").get(package, ())
        known = every if own is None else tuple(own)
        if not known and here is None:
            yield from _of_no_package(around, package, program, package_place)
        if program in known:
            better = program.removesuffix(".py")
            if better != program and (package, better) in started and own is None:
                yield _of_old(place, package, program, better)
            continue
        near = meant_word(known, program, 0.6)
        elsewhere = owners().get(program, "") if known and own is None else ""
        if elsewhere and program not in dict(w.split("=") for w in known if "=" in w):
            yield _of_another(package_place, package, program, elsewhere)
            continue
        if near is None and own is None:
            continue
        listed_at = own.get(near or "") if own is not None else None
        there = f"; it has {near} ({where(listed_at, place)})" if listed_at else ""
        certain = own is None or is_misspelt(program, near or "")
        yield Problem.at(
            place,
            "error",
            "launch-program-unknown",
            f"the package {package} has no program {program}{there}: ros2 launch "
            "stops with it",
            write(place, program, near)
            if near and certain
            else _other_program(program, near),
        )


def _of_no_package(
    around: Surroundings, package: str, program: str, place: Place
) -> Iterator[Problem]:
    """Report a package that does not exist, where the program reveals the right one."""
    programs, root = vocabulary("launch_programs"), around.manifest
    depends = [e.text.strip() for e in root.children] if root is not None else []
    if package and (package in depends or around.files.knows(package)):
        return
    if package in vocabulary("packages"):
        # Some version of ROS has it, such as ros_ign_bridge.
        return
    near = nearest(package, programs, _ALIKE) if package else None
    owner, severity = owners().get(program, ""), "error"
    if near is not None and program in programs[near]:
        cause = f"there is no package {package}, but {program} is in {near}"
    elif not package and owner and program not in _IN_PATH:
        near, cause = owner, f"the program {program} has no package, but is in {owner}"
    elif package and owner and owner in (*depends, program):
        near, severity = owner, "warning"
        cause = f"{program} is in {owner}, and a package {package} is not known"
    else:
        return
    yield Problem.at(
        place,
        severity,
        "launch-package-unknown",
        f"{cause}: ros2 launch stops with it",
        write(place, package, near) if package else f"add package='{near}'",
    )


@cache
def owners() -> dict[str, str]:
    """Return program → the only well-known package that has it."""
    found: dict[str, str] = {}
    for package, programs in vocabulary("launch_programs").items():
        for program in programs:
            found[program] = "" if program in found else package
    return found


def _of_another(place: Place, said: str, program: str, package: str) -> Problem:
    return Problem.at(
        place,
        "error",
        "launch-program-unknown",
        f"the package {said} has no program {program}, which is in {package}: ros2 "
        "launch stops with it",
        write(place, said, package),
    )


def _of_old(place: Place, package: str, program: str, better: str) -> Problem:
    return Problem.at(
        place,
        "warning",
        "launch-program-unknown",
        f"no version of {package} has both {program} and {better}, which others here "
        "start: ros2 launch stops with one of them",
        write(place, program, better),
    )


def _other_program(program: str, near: str | None) -> str:
    other = f", or write {near}" if near else ""
    return f"add a line {program} = … to console_scripts in setup.py{other}"


def _own_programs(package: Package) -> dict[str, Place] | None:
    """Return the programs that setup.py installs; None when they are not certain."""
    setup = package.setup if package.cmake is None else None
    if setup is None or not setup.installs_only_known or setup.given("scripts"):
        return None
    if setup.scripts.known is None or len(setup.programs) != len(setup.scripts.items):
        return None
    if any((entry.target or "").startswith("lib/") for entry in setup.data_files):
        return None
    return {program.name: setup.place(program.node) for program in setup.programs}

"""Find which robot of the packages a file belongs to.

A model names the parameters of its controllers, and a launch file that opens a model
gives files to the nodes of this robot. Where neither is known, a file may belong to
any of the robots.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import PurePosixPath
from typing import NamedTuple

from sambot_viz.checks.around.files.gazebo import plugins
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.running.includes import installed_as
from sambot_viz.checks.around.workspace import Package
from sambot_viz.robot.model import Robot

MODELS = (".urdf", ".xacro", ".sdf")
_OPENED = (".urdf", ".xacro")
"""Models that launch files open for a robot; those of SDF may be other objects."""
_LAUNCHES = (".py", ".launch", ".xml", ".yaml", ".yml")
_YAML = (".yaml", ".yml")
_PARAMETERS = re.compile(r"<parameters>\s*([^<]+?)\s*</parameters>")
_INCLUDED = re.compile(r"include\b[^>]*?filename\s*=\s*[\"'][^\"']*?([^/\"')}]+)[\"']")
_OWN, _UNKNOWN = "own", "unknown"
"""The robot of the check, and one that only a run reveals."""
_Owners = dict[str, set[str]]
"""File, as the user would write it → the robots that use it."""


class Ownership(NamedTuple):
    """The files that one robot uses, and those that only other robots use.

    Attributes:
        own: files that only this robot uses, as the user would write them.
        foreign: parameter files and launch files of other robots.
    """

    own: frozenset[str] = frozenset()
    foreign: frozenset[str] = frozenset()


class _LaunchedFiles(NamedTuple):
    """What a launch file names, with all that it includes.

    Attributes:
        launches: these launch files.
        robots: the models that they open.
        files: the parameter files.
    """

    launches: frozenset[str]
    robots: frozenset[str]
    files: frozenset[str]


def ownership(robot: Robot, packages: Sequence[Package]) -> Ownership:
    """Return which files of the packages belong to a robot, and which to others."""
    own = _own_models(robot, packages)
    every = [(each, path) for each in packages for path in each.ending(*MODELS)]
    if all(model in own for model in every):
        return Ownership()
    owners: _Owners = {}
    beside = [*every, *_models_beside(packages)]
    shared = _shared(beside, own)
    for package, path in beside:
        shown = package.shown(path)
        robots = {_OWN if (package, path) in own else shown}
        for value in _PARAMETERS.findall(package.text(path) or ""):
            for file in _files_at(value, packages):
                owners.setdefault(file, set()).update(robots | shared.get(shown, set()))
    for fact in (f for p in plugins(robot.gazebo) for f in p.all("parameters")):
        for file in _files_at(fact.value, packages):
            robots = {_OWN, *shared.get(fact.place.file, ())}
            owners.setdefault(file, set()).update(robots)
    starts = list(_starts(packages, own))
    for start in starts:
        for file in (*start.files, *start.launches):
            owners.setdefault(file, set()).update(start.robots)
    # What starts without a known robot may be for any.
    free = {f for s in starts if not s.robots for f in (*s.files, *s.launches)}
    is_settled = any(_OWN in names for names in owners.values())
    return Ownership(
        frozenset(file for file, names in owners.items() if names == {_OWN}),
        frozenset(
            file
            for file, names in owners.items()
            if is_settled and names and names.isdisjoint((_OWN, _UNKNOWN))
        ).difference(free),
    )


def _models_beside(packages: Sequence[Package]) -> Iterator[tuple[Package, str]]:
    """Yield the models in other packages of the workspace, which may use the files."""
    workspace = packages[0].workspace
    for package in workspace.given if workspace is not None else ():
        if package not in packages:
            for path in package.ending(*MODELS):
                yield package, path


def _own_models(
    robot: Robot, packages: Sequence[Package]
) -> frozenset[tuple[Package, str]]:
    """Return the files of a robot that are in the packages."""
    files = {file.resolve() for file in robot.files}
    return frozenset(
        (package, path)
        for package in packages
        for path in package.ending(*MODELS)
        if (package.folder / path).resolve() in files
    )


def _shared(
    every: Iterable[tuple[Package, str]], own: frozenset[tuple[Package, str]]
) -> dict[str, set[str]]:
    """Return the files of this robot that other models include, with these models."""
    found: dict[str, set[str]] = {}
    for package, path in every:
        if (package, path) in own:
            continue
        names = set(_INCLUDED.findall(package.text(path) or ""))
        for home, part in own if names else ():
            if PurePosixPath(part).name in names:
                found.setdefault(home.shown(part), set()).add(package.shown(path))
    return found


def _files_at(value: str, packages: Sequence[Package]) -> Iterator[str]:
    for package in packages:
        if package.name in value or str(package.folder) in value:
            for file in package.yaml_files:
                if value.endswith(f"/{file.path}"):
                    yield file.shown


def _starts(
    packages: Sequence[Package], own: frozenset[tuple[Package, str]]
) -> Iterator[_LaunchedFiles]:
    """Yield what each launch file names that no other one includes."""
    named = {package.name: package for package in packages}
    every = [(each, path) for each in packages for path in each.launch_paths]
    reached = {launch: tuple(_reached(*launch, named)) for launch in every}
    included = {other for found in reached.values() for other in found[1:]}
    for launch in every:
        if launch in included:
            continue
        robots: set[str] = set()
        files: set[str] = set()
        for package, path in reached[launch]:
            models = [v for v in package.launch_paths[path] if v.endswith(_OPENED)]
            robots |= {_robot_at(value, named, own) for value in models}
            if _opens_others(package, path, models):
                robots.add(_UNKNOWN)
            for value in package.launch_paths[path]:
                at = _located(value, named) if value.endswith(_YAML) else None
                files |= {at[0].shown(at[1])} if at is not None else set()
        shown = frozenset(package.shown(path) for package, path in reached[launch])
        yield _LaunchedFiles(shown, frozenset(robots), frozenset(files - shown))


def _reached(
    package: Package, path: str, named: dict[str, Package]
) -> Iterator[tuple[Package, str]]:
    """Yield a launch file, and those that it includes."""
    waiting, met = [(package, path)], {(package, path)}
    while waiting:
        one = waiting.pop()
        yield one
        for value in one[0].launch_paths[one[1]]:
            at = _located(value, named) if value.endswith(_LAUNCHES) else None
            if at is not None and at not in met and at[1] in at[0].launch_paths:
                met.add(at)
                waiting.append(at)


def _located(value: str, named: dict[str, Package]) -> tuple[Package, str] | None:
    """Return the file of a package at a path such as package://p/x; None for others."""
    name, _, below = value.removeprefix(SHARE).partition("/")
    package = named.get(name)
    path = installed_as(package, below) if package is not None else None
    return None if package is None or path is None else (package, path)


def _robot_at(
    value: str, named: dict[str, Package], own: frozenset[tuple[Package, str]]
) -> str:
    return _OWN if _located(value, named) in own else value


def _opens_others(package: Package, path: str, models: Iterable[str]) -> bool:
    """Return whether a launch file may open a model whose path is unknown."""
    known = {PurePosixPath(value).name for value in models}
    launch = next((each for each in package.launches if each.path == path), None)
    texts = launch.strings if launch is not None else frozenset[str]()
    if launch is None:
        shown = package.shown(path)
        roots = (root for root in package.frontends if root.place.file == shown)
        values = (
            v for root in roots for e in root.iter() for v in e.attributes.values()
        )
        texts = frozenset(word.strip("\"')") for v in values for word in v.split())
    opened = (text for text in texts if text.endswith(_OPENED))
    return any(PurePosixPath(text).name not in known for text in opened)

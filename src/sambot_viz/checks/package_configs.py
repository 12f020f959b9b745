"""Check the .rviz files of packages, and one that the user gives with the model."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.bundled import config_in
from sambot_viz.errors import ConfigError, Problem
from sambot_viz.files import is_below

# Imports are late: many models have no package, and no config.
if TYPE_CHECKING:
    from sambot_viz.checks.around.surroundings import Surroundings
    from sambot_viz.checks.around.workspace import Package
    from sambot_viz.checks.targets import CheckedModel
    from sambot_viz.robot.model import Robot
    from sambot_viz.rviz import RvizConfig

_OF_FIRST = frozenset(
    """
    config-class setup-description-topic setup-description-volatile
    setup-no-robot-model
    """.split()
)
"""Codes for the first .rviz file of a package only, or from another rule."""


def problems_of_configs(
    target: CheckedModel, robot: Robot, given: Path | None = None
) -> list[Problem]:
    """Return the problems of the .rviz files of a model, if they are for it.

    Args:
        target: the model, with its packages.
        robot: the same, loaded.
        given: the config to show the model with, as the user wrote it.
    """
    packages = target.packages if target.is_main else ()
    if given is None and not packages:
        return []
    from sambot_viz.checks.around.surroundings import Surroundings

    around = Surroundings(robot, target.packages)
    found = [] if given is None else _checked(given, around)
    for package in packages:
        first, opened = config_in(package.folder), _opened(package)
        files = [*([] if first is None else [first]), *_others(package)]
        for path in files:
            if given is not None and path.resolve() == given.resolve():
                continue
            is_first = path == first
            is_opened = is_first or path in opened
            of_file = _of_package(package, path, around, is_opened=is_opened)
            found += [p for p in of_file if is_first or p.code not in _OF_FIRST]
    return found


def problems_without_robot(package: Package) -> Iterator[list[Problem]]:
    """Yield the problems of each .rviz file of a package that has no robot."""
    first = config_in(package.folder)
    for path in (first, *_others(package)):
        if path is not None:
            yield _of_package(package, path)


def _others(package: Package) -> list[Path]:
    """Return the .rviz files of a package except its first."""
    first = config_in(package.folder)
    files = [package.folder / path for path in package.ending(".rviz")]
    return [file for file in files if file != first]


def _opened(package: Package) -> list[Path]:
    """Return the other .rviz files of a package that its launch files open."""
    said = [text for launch in package.launches for text in launch.strings]
    for root in package.frontends:
        said += [v for e in root.iter() for v in e.attributes.values()]
    others = _others(package)
    return [each for each in others if any(text.endswith(each.name) for text in said)]


def _of_package(
    package: Package,
    path: Path,
    around: Surroundings | None = None,
    *,
    is_opened: bool = True,
) -> list[Problem]:
    """Return the problems of a .rviz file of a package."""
    from sambot_viz.checks.around.workspace import shown

    if not (package.trusted or is_below(path, [package.folder])):
        return []
    package.read.add(path)
    return _checked(Path(shown(path, package.relative)), around, is_opened=is_opened)


def _checked(
    path: Path, around: Surroundings | None, *, is_opened: bool = True
) -> list[Problem]:
    """Return the problems of a .rviz file, and those beside a robot.

    One that no launch file opens may be for another robot.
    """
    from sambot_viz.rviz import Declarations, RvizConfig

    try:
        config = RvizConfig.load(path, Declarations())
    except ConfigError as error:
        return list(error.problems)
    found = list(config.problems)
    if around is not None:
        found += _against(around, config, is_guess=not is_opened)
    return found


def _against(
    around: Surroundings, config: RvizConfig, *, is_guess: bool
) -> Iterator[Problem]:
    from sambot_viz.checks.around.frames.published import may_be_published
    from sambot_viz.checks.config_against_robot import (
        check_config,
        description_topics,
        lists_links,
        moveit_draws_robot,
        unknown_references,
    )

    frame = str(config.global_options.get("Fixed Frame"))
    checked = check_config(around.robot, config)
    excuses = {
        "setup-fixed-frame": lambda: (
            may_be_published(around, frame)
            or (is_guess and not lists_links(around.robot, config))
        ),
        "setup-no-robot-model": lambda: moveit_draws_robot(config),
        "setup-description-topic": lambda: all(
            any(end.publishes for _, end in around.running.endpoints(topic))
            for topic in description_topics(config)
        ),
    }
    if not is_guess or lists_links(around.robot, config):
        is_published = partial(may_be_published, around)
        checked += unknown_references(around.robot, config, is_published)
    for problem in checked:
        if problem.code not in excuses or not excuses[problem.code]():
            yield replace(problem, severity="info") if is_guess else problem

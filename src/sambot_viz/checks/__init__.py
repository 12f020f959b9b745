"""Rules that explain what is wrong with a model and how to fix it."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.checks.around import names_that_must_meet
from sambot_viz.checks.axles import wheels_across_their_axles, wheels_in_one_place
from sambot_viz.checks.falling import falls_over
from sambot_viz.checks.flat_wheels import flat_wheels
from sambot_viz.checks.launch_text import launch_text_as_yaml
from sambot_viz.checks.lengths import lengths_in_another_unit, robot_in_metres
from sambot_viz.checks.masses import masses_in_grams
from sambot_viz.checks.mesh_files import (
    MeshFiles,
    meshes_of_wrong_size,
    unusable_meshes,
)
from sambot_viz.checks.physics import (
    impossible_inertia,
    inertia_on_root,
    missing_inertia,
    wheels_off_the_ground,
    zero_mass,
)
from sambot_viz.checks.proportion import lengths_out_of_proportion
from sambot_viz.checks.rule import Rule, Subject
from sambot_viz.checks.slips import (
    invisible_materials,
    limits_in_degrees,
    names_that_differ_in_case,
    names_with_spaces,
    rpy_in_degrees,
    sizes_not_positive,
)
from sambot_viz.checks.unused_macros import unused_macros
from sambot_viz.errors import ConfigError, Problem, RobotError
from sambot_viz.robot.model import Robot

if TYPE_CHECKING:
    from sambot_viz.meshes.mesh import Mesh

__all__ = ["check", "check_around", "check_folder", "check_robot", "check_unloadable"]

RULES: tuple[Rule, ...] = (
    limits_in_degrees,
    rpy_in_degrees,
    sizes_not_positive,
    lengths_in_another_unit,
    unusable_meshes,
    meshes_of_wrong_size,
    wheels_off_the_ground,
    wheels_across_their_axles,
    flat_wheels,
    wheels_in_one_place,
    falls_over,
    names_that_differ_in_case,
    names_with_spaces,
    unused_macros,
    launch_text_as_yaml,
    inertia_on_root,
    missing_inertia,
    impossible_inertia,
    zero_mass,
    masses_in_grams,
    invisible_materials,
)
"""All rules, in the order in which they run."""

_OF_LENGTHS = frozenset(
    """
    shape-size size-not-positive wheel-not-on-ground falls-over footprint-size
    drive-wheel-separation drive-wheel-radius mesh-size
    """.split()
)
"""What is said of lengths, and of the robot that they make."""

_OF_ANGLES = frozenset("footprint-size wheel-across-axle falls-over".split())
"""What is said of a robot whose parts are turned wrongly."""

_ORDER = {"error": 0, "warning": 1, "info": 2}


def check(
    path: str | os.PathLike[str],
    *,
    xacro_args: Mapping[str, str] | None = None,
    package_path: Sequence[Path | str] = (),
    trusted: bool = True,
) -> list[Problem]:
    """Find everything that is wrong with a model, its mesh files included.

    Args:
        path: a URDF, SDF or xacro file.
        xacro_args: values for xacro's arguments.
        package_path: folders in which packages are looked for.
        trusted: False for a model of unknown origin, as for `load_robot`.

    Returns:
        Errors first, then warnings, then notes; each in document order. Empty when
        all is well. It never raises for a model that is broken or does not exist.
    """
    from sambot_viz.robot.model import load_robot

    try:
        robot = load_robot(
            path, xacro_args=xacro_args, package_path=package_path, trusted=trusted
        )
    except RobotError as error:
        return check_unloadable(error)
    return check_robot(robot, path)


def check_unloadable(error: RobotError) -> list[Problem]:
    """Return what is wrong with a model that did not load, in the order of `check`."""
    return _in_order(error.problems)


def check_robot(
    robot: Robot,
    path: str | os.PathLike[str] | None = None,
    *,
    mesh: Callable[[Path], Mesh | Problem | None] | None = None,
    around: bool = True,
) -> list[Problem]:
    """Find everything that is wrong with a robot that is already loaded.

    Args:
        robot: the robot, with the problems found while loading.
        path: the model as the user wrote it; default the robot's first file.
        mesh: gives the mesh in a file, why it cannot be drawn, or None to leave it
            out; default reads the file.
        around: with what `check_around` finds.
    """
    subject = _subject(robot, path, mesh)
    rules = (*RULES, names_that_must_meet) if around else RULES
    return _in_order([*robot.problems, *_found(subject, rules)])


def check_around(
    robot: Robot,
    path: str | os.PathLike[str] | None = None,
    *,
    read: set[Path] | None = None,
) -> list[Problem]:
    """Find names that differ between a model and the files of its package.

    Args:
        robot: the robot.
        path: as for `check_robot`.
        read: gets the files of the package that were looked for.
    """
    subject = _subject(robot, path, None)
    found = _in_order(_found(subject, [names_that_must_meet]))
    if read is not None:
        read |= subject.read
    return found


def _subject(
    robot: Robot,
    path: str | os.PathLike[str] | None,
    mesh: Callable[[Path], Mesh | Problem | None] | None,
) -> Subject:
    files = [str(file) for file in robot.files]
    if path is not None and Path(path).is_file():
        files[:1] = [os.fspath(path)]
    return Subject(robot, tuple(files), mesh or MeshFiles(robot.file_roots))


def _found(subject: Subject, rules: Sequence[Rule]) -> list[Problem]:
    """Run rules; what follows from a misspelt name or a unit is left out."""
    from sambot_viz.robot.corrected import corrected_robot

    found = _run(subject, rules)
    better = corrected_robot(subject.robot) if found else None
    if better is None:
        return found
    codes = {problem.code for problem in _run(replace(subject, robot=better), rules)}
    return [problem for problem in found if problem.code in codes]


def _run(subject: Subject, rules: Sequence[Rule]) -> list[Problem]:
    """Run rules; only the one about the unit of lengths is given another unit.

    Where one length is out of proportion, what rests on lengths is left out, and where
    a wheel lies flat, how far the robot reaches. Angles in degrees turn parts anyhow.
    """
    off = list(lengths_out_of_proportion(subject))
    robot = subject.robot if off else robot_in_metres(subject.robot)
    in_metres = subject if robot is subject.robot else replace(subject, robot=robot)
    found = [
        problem
        for rule in rules
        for problem in rule(subject if rule is lengths_in_another_unit else in_metres)
    ]
    if off:
        found = [problem for problem in found if problem.code not in _OF_LENGTHS]
        return found + off if lengths_in_another_unit in rules else found
    if _has_degrees(in_metres):
        return [problem for problem in found if problem.code not in _OF_ANGLES]
    reach = {problem for problem in found if problem.code == "footprint-size"}
    turned = (wheels_across_their_axles, flat_wheels)
    if reach and any(any(rule(in_metres)) for rule in turned):
        found = [problem for problem in found if problem not in reach]
    return found


def _has_degrees(subject: Subject) -> bool:
    told = any(problem.code == "rpy-in-degrees" for problem in subject.robot.problems)
    return told or any(rpy_in_degrees(subject))


def check_folder(
    folder: Path,
    model: Path,
    config: Path | None = None,
    *,
    xacro_args: Mapping[str, str] | None = None,
    package_path: Sequence[Path | str] = (),
    trusted: bool = True,
) -> list[Problem]:
    """Find everything that is wrong with a package: model, config, launch files.

    Args:
        folder: the package, with its package.xml.
        model: its model.
        config: its .rviz file, if it has one.
        xacro_args: as for `check`.
        package_path: as for `check`.
        trusted: as for `check`.

    Returns:
        The problems of the model as `check` finds them, then those of the config, then
        those of the launch files and setup.py.
    """
    from sambot_viz.checks.launch_files import check_package
    from sambot_viz.robot.model import load_robot

    robot: Robot | None = None
    try:
        robot = load_robot(
            model, xacro_args=xacro_args, package_path=package_path, trusted=trusted
        )
    except RobotError as error:
        problems = check_unloadable(error)
    else:
        problems = check_robot(robot, model)
    if config is not None:
        problems += _check_config(config, robot)
    return [*problems, *check_package(folder, robot)]


def _check_config(path: Path, robot: Robot | None) -> list[Problem]:
    from sambot_viz.checks.around.published_frames import may_be_published
    from sambot_viz.checks.config_against_robot import check_config
    from sambot_viz.rviz import Declarations, RvizConfig

    try:
        config = RvizConfig.load(path, Declarations())
    except ConfigError as error:
        return list(error.problems)
    found = list(config.problems)
    if robot is None:
        return found
    for problem in check_config(robot, config):
        frame = str(config.global_options.get("Fixed Frame"))
        of_frame = problem.code == "setup-fixed-frame"
        if not (of_frame and may_be_published(robot, frame, str(path))):
            found.append(problem)
    return found


def _in_order(problems: Sequence[Problem]) -> list[Problem]:
    """Each once: errors first, then in the order of the file.

    What is said of one element with the same advice is what a macro repeats.
    """
    once: dict[object, Problem] = {}
    for problem in problems:
        repeated = (problem.code, problem.place, problem.hint)
        once.setdefault(problem if problem.column is None else repeated, problem)
    return sorted(
        once.values(), key=lambda p: (_ORDER[p.severity], p.file or "", p.line or 0)
    )

"""The rules about a model, in order; what follows from another finding is left out."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.advice import with_edits
from sambot_viz.checks.around import names_that_must_meet
from sambot_viz.checks.axles import wheels_across_their_axles, wheels_in_one_place
from sambot_viz.checks.exchanged_lengths import exchanged_lengths
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
from sambot_viz.checks.sensor_words import sensor_words
from sambot_viz.checks.slips import (
    invisible_materials,
    limits_in_degrees,
    names_that_differ_in_case,
    names_with_spaces,
    rpy_in_degrees,
    sizes_not_positive,
)
from sambot_viz.checks.unused_macros import unused_macros
from sambot_viz.errors import Problem
from sambot_viz.robot.model import Robot

if TYPE_CHECKING:
    from sambot_viz.checks.around.workspace import Package
    from sambot_viz.meshes.mesh import Mesh

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
    exchanged_lengths,
    wheels_in_one_place,
    falls_over,
    names_that_differ_in_case,
    names_with_spaces,
    unused_macros,
    inertia_on_root,
    missing_inertia,
    impossible_inertia,
    zero_mass,
    masses_in_grams,
    invisible_materials,
    sensor_words,
)
"""The rules about the model itself, in the order in which they run."""

AROUND: tuple[Rule, ...] = (launch_text_as_yaml, names_that_must_meet)
"""The rules about a model and its packages."""

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


def subject_of(
    robot: Robot,
    path: str | os.PathLike[str] | None = None,
    mesh: Callable[[Path], Mesh | Problem | None] | None = None,
    packages: tuple[Package, ...] = (),
) -> Subject:
    """Return what rules are given; see `check_robot`."""
    files = [str(file) for file in robot.files]
    if path is not None and Path(path).is_file():
        files[:1] = [os.fspath(path)]
    return Subject(robot, tuple(files), mesh or MeshFiles(robot.file_roots), packages)


def find_problems(subject: Subject, rules: Sequence[Rule]) -> list[Problem]:
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


def in_order(problems: Sequence[Problem]) -> list[Problem]:
    """Return each problem once: errors first, then in the order of the file.

    What is said of one element with the same advice is what a macro repeats.
    """
    once: dict[object, Problem] = {}
    for problem in problems:
        repeated = (problem.code, problem.place, problem.hint)
        once.setdefault(problem if problem.column is None else repeated, problem)
    return sorted(
        with_edits(once.values()),
        key=lambda p: (_ORDER[p.severity], p.file or "", p.line or 0),
    )

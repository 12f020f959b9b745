"""Run the rules about a model in order, and drop consequences of other findings."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.advice import with_edits
from sambot_viz.checks.around import names_that_must_meet
from sambot_viz.checks.consequences import without_consequences
from sambot_viz.checks.exchanged_joint import exchanged_joint
from sambot_viz.checks.launch_text import launch_text_as_yaml
from sambot_viz.checks.model.axles import wheels_across_their_axles, wheels_in_one_place
from sambot_viz.checks.model.copied_meshes import copied_meshes
from sambot_viz.checks.model.exchanged_lengths import exchanged_lengths
from sambot_viz.checks.model.falling import falls_over
from sambot_viz.checks.model.flat_wheels import flat_wheels
from sambot_viz.checks.model.ground import wheels_off_the_ground
from sambot_viz.checks.model.lengths import lengths_in_another_unit
from sambot_viz.checks.model.lost_origins import lost_origins
from sambot_viz.checks.model.low_casters import low_casters
from sambot_viz.checks.model.masses import masses_in_grams
from sambot_viz.checks.model.mesh_files import (
    MeshFiles,
    meshes_of_wrong_size,
    unusable_meshes,
)
from sambot_viz.checks.model.optical_frames import optical_frames
from sambot_viz.checks.model.physics import (
    impossible_inertia,
    inertia_on_root,
    missing_inertia,
    zero_mass,
)
from sambot_viz.checks.model.prefixed_names import names_without_prefix
from sambot_viz.checks.model.proportion import lengths_out_of_proportion
from sambot_viz.checks.model.relative_meshes import relative_meshes
from sambot_viz.checks.model.sensor_words import (
    beside_sensors,
    gazebo_words,
    sensor_words,
)
from sambot_viz.checks.model.slips import (
    invisible_materials,
    limits_in_degrees,
    names_that_differ_in_case,
    names_with_spaces,
    rpy_in_degrees,
    sizes_not_positive,
)
from sambot_viz.checks.model.unused_macros import unused_macros
from sambot_viz.checks.model.wheel_twins import unlike_twins
from sambot_viz.checks.proven import proven
from sambot_viz.checks.rule import Rule, Subject
from sambot_viz.errors import SEVERITIES, Problem
from sambot_viz.robot.model import Robot
from sambot_viz.robot.xacro.at_calls import at_calls

if TYPE_CHECKING:
    from sambot_viz.checks.around.workspace import Package
    from sambot_viz.meshes.mesh import Mesh


def lengths_not_in_metres(subject: Subject) -> list[Problem]:
    """Report one length that is out of proportion, else all lengths in a wrong unit."""
    off = list(lengths_out_of_proportion(subject))
    return off or list(lengths_in_another_unit(subject))


RULES: tuple[Rule, ...] = (
    limits_in_degrees,
    rpy_in_degrees,
    sizes_not_positive,
    lost_origins,
    lengths_not_in_metres,
    unusable_meshes,
    meshes_of_wrong_size,
    copied_meshes,
    relative_meshes,
    unlike_twins,
    wheels_off_the_ground,
    low_casters,
    wheels_across_their_axles,
    flat_wheels,
    exchanged_lengths,
    wheels_in_one_place,
    falls_over,
    exchanged_joint,
    names_that_differ_in_case,
    names_with_spaces,
    names_without_prefix,
    unused_macros,
    inertia_on_root,
    missing_inertia,
    impossible_inertia,
    zero_mass,
    masses_in_grams,
    invisible_materials,
    optical_frames,
    sensor_words,
    gazebo_words,
    beside_sensors,
)
"""The rules about the model itself, in their order."""

AROUND: tuple[Rule, ...] = (launch_text_as_yaml, names_that_must_meet)
"""The rules about a model and its packages."""

_CAUSES: tuple[Rule, ...] = (
    limits_in_degrees,
    rpy_in_degrees,
    lost_origins,
    lengths_not_in_metres,
    wheels_across_their_axles,
    flat_wheels,
    exchanged_lengths,
    unlike_twins,
    wheels_off_the_ground,
)
"""The rules about a model whose findings cause others."""


def subject_of(
    robot: Robot,
    path: str | os.PathLike[str] | None = None,
    mesh: Callable[[Path], Mesh | Problem | None] | None = None,
    packages: tuple[Package, ...] = (),
) -> Subject:
    """Return the input of rules; see `check_robot`."""
    files = [str(file) for file in robot.files]
    if path is not None and Path(path).is_file():
        files[:1] = [os.fspath(path)]
    return Subject(robot, tuple(files), mesh or MeshFiles(robot.file_roots), packages)


def find_problems(subject: Subject, rules: Sequence[Rule]) -> list[Problem]:
    """Run rules, and drop consequences of other findings."""
    return without_followers(subject, rules, look(rules, subject))


def without_followers(
    subject: Subject, rules: Sequence[Rule], found: Sequence[Problem]
) -> list[Problem]:
    """Return what rules found without the consequences of other findings."""
    if not found:
        return []
    causes = [p for rule in _CAUSES if rule not in rules for p in rule(subject)]
    causes = with_edits(causes)
    own = set(found)
    kept = without_consequences(subject, [*causes, *found], partial(look, rules))
    return [problem for problem in kept if problem in own]


def look(rules: Sequence[Rule], subject: Subject) -> list[Problem]:
    """Run rules, and keep what follows from others."""
    every = with_edits(problem for rule in rules for problem in rule(subject))
    return at_calls(every, subject.files)


def with_proven_edits(subject: Subject, found: Sequence[Problem]) -> list[Problem]:
    """Return findings of rules about the model and of its text, with their good edits.

    See `proven`.
    """
    if not any(problem.edits for problem in found):
        return list(found)

    def look_again(other: Subject) -> list[Problem]:
        return [*other.robot.problems, *look(RULES, other)]

    return proven(subject, found, look_again)


def in_order(problems: Sequence[Problem]) -> list[Problem]:
    """Return each problem once: errors first, then in the order of the file.

    Findings at one element with the same advice come from repeated calls of a macro.
    """
    once: dict[object, Problem] = {}
    for problem in problems:
        repeated = (problem.code, problem.place, problem.hint)
        once.setdefault(problem if problem.column is None else repeated, problem)
    return sorted(
        once.values(),
        key=lambda p: (SEVERITIES.index(p.severity), p.file or "", p.line or 0),
    )

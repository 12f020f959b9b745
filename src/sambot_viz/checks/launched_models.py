"""Load a model with the xacro arguments of launch files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

from sambot_viz.advice import with_edits
from sambot_viz.checks.model_rules import AROUND, RULES, find_problems, subject_of
from sambot_viz.checks.targets import CheckedModel
from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import Robot

_OF_ARGUMENTS = ("xacro-argument", "xacro-include", "xacro-package", "xacro-yaml")
"""Beginnings of codes of problems that another value of an argument may cause."""


def launched(target: CheckedModel) -> tuple[dict[str, str], ...]:
    """Return arguments of launch files for a model: first of all, then of single ones.

    See `launched_arguments`.
    """
    if not target.packages or not target.model.name.endswith((".xacro", ".urdf")):
        return ({},)
    # Import late: many models have no package.
    from sambot_viz.checks.around.xacro_arguments import launched_arguments

    return launched_arguments(target.model, target.packages)


def load_launched(
    load: Callable[..., Robot],
    target: CheckedModel,
    launched: Mapping[str, str],
    given: Mapping[str, str],
) -> Robot:
    """Load a model with the known arguments of launch files.

    Where xacro refuses it, load it with their possible values.

    Args:
        load: `load_robot` for the model.
        target: the model, with its packages.
        launched: the arguments that all launch files give.
        given: the arguments that the user gives.

    Raises:
        RobotError: as `load_robot`.
    """
    if launched.keys() - given.keys():
        # A value inferred from a launch file may be wrong.
        with suppress(RobotError):
            return load(xacro_args={**launched, **given})
    try:
        return load(xacro_args=given)
    except RobotError as error:
        # Import late: most models need no arguments.
        from sambot_viz.checks.around.xacro_arguments import (
            given_arguments,
            xacro_arguments,
        )

        is_of_xacro = any(p.code.startswith("xacro-") for p in error.problems)
        possible = xacro_arguments if is_of_xacro else given_arguments
        first = error
        for found in possible(target.model, target.packages):
            try:
                return load(xacro_args={**found, **given})
            except RobotError as other:
                first = other if is_of_xacro and first is error else first
        raise first from None


def wrong_variants(
    load: Callable[..., Robot],
    target: CheckedModel,
    variants: Sequence[Mapping[str, str]],
    given: Mapping[str, str],
    known: Sequence[Problem],
) -> list[Problem]:
    """Return the problems that only arguments of single launch files cause.

    Args:
        load: `load_robot` for the model.
        target: the model.
        variants: the arguments of these launch files.
        given: the arguments that the user gives; with them no variant counts.
        known: the problems of the model itself.
    """
    found: list[Problem] = []
    places = {(problem.code, problem.place) for problem in known}
    for variant in variants if not given else ():
        try:
            robot = load(xacro_args=variant)
        except RobotError as error:
            own = [p for p in error.problems if not p.code.startswith(_OF_ARGUMENTS)]
        else:
            subject = subject_of(robot, target.model)
            own = [*robot.problems, *find_problems(subject, (*RULES, *AROUND))]
        words = [f"{name}:={value}" for name, value in variant.items()]
        how = " ".join(words) or "the defaults"
        for problem in with_edits(own):
            place = (problem.code, problem.place)
            if problem.severity != "info" and place not in places:
                places.add(place)
                message = f"with {how}, as a launch file has it: {problem.message}"
                found.append(replace(problem, message=message))
    return found

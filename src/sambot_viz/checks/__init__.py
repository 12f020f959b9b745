"""Rules that explain what is wrong with a model and how to mend it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from sambot_viz.checks.registry import RULES
from sambot_viz.checks.rule import Finding, Rule, Subject
from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import Robot

__all__ = [
    "RULES",
    "Finding",
    "Rule",
    "Subject",
    "check",
    "check_robot",
    "check_unloadable",
]

_ORDER = {"error": 0, "warning": 1, "info": 2}


def check(
    path: str | os.PathLike[str],
    *,
    xacro_args: Mapping[str, str] | None = None,
    package_path: Sequence[Path | str] = (),
    trusted: bool = True,
) -> list[Problem]:
    """Say everything that is wrong with a model.

    Args:
        path: a URDF or xacro file, or a package folder.
        xacro_args: values for xacro's arguments.
        package_path: folders in which packages are looked for.
        trusted: False for a model of unknown origin, as for `load_robot`.

    Returns:
        Errors first, then warnings, then notes; each in document order. Empty when
        all is well. It never raises for a bad model, nor for one that is not there.
    """
    from sambot_viz.robot import load_robot

    try:
        robot = load_robot(
            path, xacro_args=xacro_args, package_path=package_path, trusted=trusted
        )
    except RobotError as error:
        return check_unloadable(path, error)
    return check_robot(robot, path)


def check_unloadable(path: str | os.PathLike[str], error: RobotError) -> list[Problem]:
    """The same for a model that could not be loaded.

    Args:
        path: the model as the user wrote it.
        error: why it could not be loaded.
    """
    subject = Subject(os.fspath(path), None, ())
    return _in_order([*error.problems, *_look(subject)])


def check_robot(
    robot: Robot, path: str | os.PathLike[str] | None = None
) -> list[Problem]:
    """The same for a robot that is loaded already.

    Args:
        robot: the robot, with the problems met while loading.
        path: the model as the user wrote it; default the robot's first file.
    """
    files = [str(file) for file in robot.files]
    main = os.fspath(path) if path is not None and Path(path).is_file() else ""
    if main:
        files[:1] = [main]
    subject = Subject(files[0] if files else "", robot, tuple(files))
    return _in_order([*robot.problems, *_look(subject)])


def _look(subject: Subject) -> list[Problem]:
    return [problem for rule in RULES for problem in rule.problems(subject)]


def _in_order(problems: list[Problem]) -> list[Problem]:
    """Each once, errors first, then as they stand in the file."""
    once = dict.fromkeys(problems)
    return sorted(once, key=lambda p: (_ORDER[p.severity], p.file or "", p.line or 0))

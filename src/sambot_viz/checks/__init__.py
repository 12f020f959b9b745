"""Rules that explain what is wrong with a model and how to fix it."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.checks.mesh_files import MeshFiles
from sambot_viz.checks.registry import RULES
from sambot_viz.checks.rule import Subject
from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import Robot

if TYPE_CHECKING:
    from sambot_viz.meshes.mesh import Mesh

__all__ = ["check", "check_robot", "check_unloadable"]

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
        path: a URDF or xacro file.
        xacro_args: values for xacro's arguments.
        package_path: folders in which packages are looked for.
        trusted: False for a model of unknown origin, as for `load_robot`.

    Returns:
        Errors first, then warnings, then notes; each in document order. Empty when
        all is well. It never raises for a model that is broken or does not exist.
    """
    from sambot_viz.robot import load_robot

    try:
        robot = load_robot(
            path, xacro_args=xacro_args, package_path=package_path, trusted=trusted
        )
    except RobotError as error:
        return check_unloadable(error)
    return check_robot(robot, path)


def check_unloadable(error: RobotError) -> list[Problem]:
    """What is wrong with a model that could not be loaded, in the order of `check`."""
    return _in_order(error.problems)


def check_robot(
    robot: Robot,
    path: str | os.PathLike[str] | None = None,
    *,
    mesh: Callable[[Path], Mesh | Problem | None] | None = None,
) -> list[Problem]:
    """Find everything that is wrong with a robot that is already loaded.

    Args:
        robot: the robot, with the problems found while loading.
        path: the model as the user wrote it; default the robot's first file.
        mesh: gives the mesh in a file, why it cannot be drawn, or None to leave it
            out; default reads the file.
    """
    files = [str(file) for file in robot.files]
    if path is not None and Path(path).is_file():
        files[:1] = [os.fspath(path)]
    subject = Subject(robot, tuple(files), mesh or MeshFiles(robot.file_roots))
    found = [problem for rule in RULES for problem in rule(subject)]
    return _in_order([*robot.problems, *found])


def _in_order(problems: Sequence[Problem]) -> list[Problem]:
    """Each once: errors first, then in the order of the file."""
    once = dict.fromkeys(problems)
    return sorted(once, key=lambda p: (_ORDER[p.severity], p.file or "", p.line or 0))

"""Explain faults of a model, and how to fix them, by rules."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.advice import with_edits
from sambot_viz.checks.model_rules import (
    AROUND,
    RULES,
    find_problems,
    in_order,
    subject_of,
    with_proven_edits,
)
from sambot_viz.errors import Problem, UsageError
from sambot_viz.robot.model import Robot

if TYPE_CHECKING:
    from sambot_viz.meshes.mesh import Mesh

__all__ = ["check", "check_around", "check_robot"]


def check(
    path: str | os.PathLike[str],
    *,
    config: str | os.PathLike[str] | None = None,
    xacro_args: Mapping[str, str] | None = None,
    package_path: Sequence[Path | str] = (),
    workspace: Sequence[Path | str] = (),
    trusted: bool = True,
) -> list[Problem]:
    """Find everything that is wrong with a model and its package.

    Args:
        path: a URDF, SDF or xacro file, a package folder, or a folder of packages.
        config: the .rviz file to show the model with, checked against it.
        xacro_args: values for xacro's arguments.
        package_path: folders to search for packages.
        workspace: folders of packages that start the robot or have its parameters.
        trusted: False for a model of unknown origin, as for `load_robot`.

    Returns:
        Errors first, then warnings, then notes; each in document order. Empty for a
        sound model. Never raises for a broken or a missing model.
    """
    from sambot_viz.checks.checked import check_all

    try:
        found = check_all(
            Path(path),
            config=None if config is None else Path(config),
            xacro_args=xacro_args,
            package_path=package_path,
            workspace=workspace,
            trusted=trusted,
        )
    except UsageError as error:
        message, _, hint = str(error).rpartition("; ")
        return [Problem("error", "model-is-folder", message, hint, os.fspath(path))]
    return list(found.problems)


def check_robot(
    robot: Robot,
    path: str | os.PathLike[str] | None = None,
    *,
    mesh: Callable[[Path], Mesh | Problem | None] | None = None,
    around: bool = True,
) -> list[Problem]:
    """Find everything that is wrong with a loaded robot.

    Args:
        robot: the robot, with the problems found while loading.
        path: the model as the user wrote it; by default the robot's first file.
        mesh: returns the mesh in a file, the reason why RViz cannot draw it, or None to
            leave it out; by default reads the file.
        around: include the findings of `check_around`.
    """
    subject = subject_of(robot, path, mesh)
    found = [*robot.problems, *find_problems(subject, RULES)]
    found = with_proven_edits(subject, with_edits(found))
    return in_order([*found, *check_around(robot, path)] if around else found)


def check_around(
    robot: Robot,
    path: str | os.PathLike[str] | None = None,
    *,
    workspace: Sequence[Path | str] = (),
    read: set[Path] | None = None,
) -> list[Problem]:
    """Find faults in the package of a model, and names that differ there.

    Args:
        robot: the robot.
        path: as for `check_robot`.
        workspace: as for `check`.
        read: receives the files of the package that the check looked for.
    """
    from sambot_viz.checks.checked import problems_around

    subject = subject_of(robot, path)
    if not subject.files:
        return in_order(find_problems(subject, AROUND))
    return problems_around(robot, Path(subject.files[0]), workspace, read)

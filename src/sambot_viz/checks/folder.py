"""A whole package: its model, its RViz config, its launch files and setup.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from sambot_viz.checks import check_robot, check_unloadable
from sambot_viz.checks.config_against_robot import check_config
from sambot_viz.checks.launch_files import check_package
from sambot_viz.errors import ConfigError, Problem, RobotError
from sambot_viz.robot.model import Robot


def check_folder(
    folder: Path,
    model: Path,
    config: Path | None = None,
    *,
    xacro_args: Mapping[str, str] | None = None,
    package_path: Sequence[Path | str] = (),
    trusted: bool = True,
) -> list[Problem]:
    """Find everything that is wrong with a package.

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
    from sambot_viz.robot import load_robot

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
    from sambot_viz.rviz import Declarations, RvizConfig

    try:
        config = RvizConfig.load(path, Declarations())
    except ConfigError as error:
        return list(error.problems)
    found = list(config.problems)
    return found if robot is None else found + check_config(robot, config)

"""Compare the model with the files around it: their names must match.

The files belong to the model's package, and to the packages that start the model or
have its parameters. They configure robot_localization, Nav2 and the bridge to Gazebo;
launch files, CMakeLists.txt and setup.py are among them. The rules read them as text
and run nothing. A finding names two places that contradict each other. One name alone
proves nothing: it may be right for a robot or a node outside these packages.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from sambot_viz.checks.rule import Subject
from sambot_viz.errors import Problem

if TYPE_CHECKING:
    from sambot_viz.checks.around.rules import Check
    from sambot_viz.checks.around.surroundings import Surroundings
    from sambot_viz.checks.around.workspace import Package
    from sambot_viz.robot.model import Robot

__all__ = ["built_wrongly", "names_that_must_meet", "wrong_files"]

_INCOMPLETE = (
    "joint-to-itself",
    "joint-ring",
    "xacro-prefix-missing",
    "xacro-prefix-undeclared",
)


def names_that_must_meet(subject: Subject) -> Iterator[Problem]:
    """Report names and sizes that two files give differently."""
    robot = subject.robot
    if not subject.packages and not robot.gazebo:
        return
    # Import late: most models have nothing for these rules, and many have no package.
    from sambot_viz.checks.around.in_model import IN_MODEL, IN_MODEL_OF_ROS2

    if any(p.code in _INCOMPLETE for p in robot.problems):
        # A part of the robot is missing, with the links and joints that other files
        # name.
        return
    # A package for the other ROS does not run together with the model's.
    is_ros1 = bool(subject.packages) and subject.packages[0].is_ros1
    packages = tuple(p for p in subject.packages if p.is_ros1 == is_ros1)
    left_out = IN_MODEL_OF_ROS2 if is_ros1 else ()
    for rule in IN_MODEL:
        if rule not in left_out:
            yield from rule(robot)
    if packages and not _is_part(robot):
        from sambot_viz.checks.around.other_robots import of_this_robot
        from sambot_viz.checks.around.rules import OF_FILES, OF_ROBOT
        from sambot_viz.checks.around.surroundings import Surroundings

        around = Surroundings(robot, packages)
        found = (*_found(OF_FILES, around), *_found(OF_ROBOT, around.of_robot))
        yield from of_this_robot(around, found)


def wrong_files(package: Package) -> Iterator[Problem]:
    """Report faults in the launch files and parameters of a package without a model."""
    from sambot_viz.checks.around.rules import OF_FILES
    from sambot_viz.checks.around.surroundings import Surroundings

    yield from _found(OF_FILES, Surroundings(None, (package,)))


def built_wrongly(package: Package, robot: Robot | None) -> Iterator[Problem]:
    """Report faults in the build and the installation of a package.

    Args:
        package: the package.
        robot: the robot; its meshes may be in the package.
    """
    from sambot_viz.checks.around.rules import OF_BUILD
    from sambot_viz.checks.around.surroundings import Surroundings

    around = Surroundings(robot, (package,))
    yield from _found(OF_BUILD, around)
    if package.setup is not None and not package.is_ros1:
        # Import late: most packages have no setup.py.
        from sambot_viz.checks.around.package_files.in_setup import IN_SETUP
        from sambot_viz.checks.around.package_files.own_names import setup_name

        if any(setup_name(around)):
            # A file that is installed under another name follows from that.
            return
        for rule in IN_SETUP:
            yield from rule(package.setup, around)


def _found(checks: Iterable[Check], around: Surroundings) -> Iterator[Problem]:
    from sambot_viz.checks.around.rules import OF_ROS2

    left_out = OF_ROS2 if around.is_ros1 else ()
    for check in checks:
        if check not in left_out:
            yield from check(around)


def _is_part(robot: Robot) -> bool:
    """Return whether others include a file: they may have what it lacks."""
    return any(p.code == "robot-without-name" for p in robot.problems)

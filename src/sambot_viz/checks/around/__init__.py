"""Names that must meet: the model against the files around it.

The files are those of the model's package, and of the packages that start it or have
its parameters: of robot_localization and Nav2, the bridge to Gazebo, launch files,
CMakeLists.txt and setup.py. They are read as text; nothing is run. A finding is about
two places that contradict each other, and names both: a name alone may be right for a
robot or a node that is not looked at.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from sambot_viz.checks.rule import Subject
from sambot_viz.errors import Problem

if TYPE_CHECKING:
    from sambot_viz.checks.around.workspace import Package
    from sambot_viz.robot.model import Robot

__all__ = ["built_wrongly", "names_that_must_meet", "wrong_files"]

_INCOMPLETE = ("xacro-prefix-missing", "xacro-prefix-undeclared")


def names_that_must_meet(subject: Subject) -> Iterator[Problem]:
    """Report names and sizes that are written twice and differ."""
    robot = subject.robot
    if not subject.packages and not robot.gazebo:
        return
    # The import is late: most models have nothing for these rules.
    from sambot_viz.checks.around.rules import IN_MODEL, OF_FILES, OF_ROBOT
    from sambot_viz.checks.around.surroundings import Surroundings

    if any(p.code in _INCOMPLETE for p in robot.problems):
        # A part of the robot is missing, and with it what others name.
        return
    for rule in IN_MODEL:
        yield from rule(robot)
    if subject.packages and not _is_part(robot):
        around = Surroundings(robot, subject.packages)
        for check in (*OF_FILES, *OF_ROBOT):
            yield from check(around)


def wrong_files(package: Package) -> Iterator[Problem]:
    """Report what is wrong in the launch files and parameters of a package alone."""
    from sambot_viz.checks.around.rules import OF_FILES
    from sambot_viz.checks.around.surroundings import Surroundings

    around = Surroundings(None, (package,))
    for check in OF_FILES:
        yield from check(around)


def built_wrongly(package: Package, robot: Robot | None) -> Iterator[Problem]:
    """Report what is wrong with how a package is built and installed.

    Args:
        package: the package.
        robot: the robot whose meshes it may have.
    """
    from sambot_viz.checks.around.rules import OF_BUILD
    from sambot_viz.checks.around.surroundings import Surroundings

    around = Surroundings(robot, (package,))
    for check in OF_BUILD:
        yield from check(around)


def _is_part(robot: Robot) -> bool:
    """True for a file that others include: what it lacks may be in those."""
    return any(p.code == "robot-without-name" for p in robot.problems)

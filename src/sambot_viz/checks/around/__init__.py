"""Names that must meet: the model against the files around it.

The files are those of the model's package: parameters of robot_localization and Nav2,
the bridge to Gazebo, launch files, CMakeLists.txt and setup.py. They are read as text;
nothing is run. A finding is about two places that contradict each other, and names
both: a name alone may be right for a robot or a node that is not looked at.
"""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.around.files.text_files import package_of
from sambot_viz.checks.rule import Subject
from sambot_viz.errors import Problem

__all__ = ["names_that_must_meet"]


_INCOMPLETE = ("xacro-prefix-missing", "xacro-prefix-undeclared")


def names_that_must_meet(subject: Subject) -> Iterator[Problem]:
    """Report names and sizes that are written twice and differ."""
    files = package_of(subject)
    if files is None and not subject.robot.gazebo:
        return
    # The import is late: most models have nothing for these rules.
    from sambot_viz.checks.around.other_robots import of_this_robot
    from sambot_viz.checks.around.rules import IN_MODEL, IN_PACKAGE, OF_ROS2
    from sambot_viz.checks.around.surroundings import Surroundings

    if any(p.code in _INCOMPLETE for p in subject.robot.problems):
        # A part of the robot is missing, and with it what others name.
        return
    around = None if files is None else Surroundings(subject.robot, files)
    left_out = OF_ROS2 if around is not None and around.is_ros1 else ()
    for rule in IN_MODEL:
        if rule not in left_out:
            yield from rule(subject.robot)
    if around is not None and not _is_part(subject):
        checks = (check for check in IN_PACKAGE if check not in left_out)
        found = (problem for check in checks for problem in check(around))
        yield from of_this_robot(around, found)


def _is_part(subject: Subject) -> bool:
    """True for a file that others include: what it lacks may be in those."""
    return any(p.code == "robot-without-name" for p in subject.robot.problems)

"""Read the parameters that a launch file gives to a node, directly and by files."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import NamedTuple

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import YamlFile
from sambot_viz.checks.around.launching.actions import (
    FromFile,
    Given,
    LaunchArgument,
    RobotText,
)
from sambot_viz.checks.around.launching.texts import LaunchTexts
from sambot_viz.checks.around.running.includes import installed_as
from sambot_viz.checks.around.running.parameter_files import located, parameters_for
from sambot_viz.checks.around.running.system import GivenFile, GivenParameter
from sambot_viz.checks.around.workspace import Package


class NodeParameters(NamedTuple):
    """The parameters that a node gets.

    Attributes:
        values: the parameters; of files, only those that it reads.
        files: the files that exist here.
        complete: the node gets no others.
    """

    values: tuple[GivenParameter, ...]
    files: tuple[GivenFile, ...]
    complete: bool


def given_to(
    given: Iterable[Given],
    texts: LaunchTexts,
    package: Package,
    find: Callable[[str], Package | None],
    name: str,
    namespace: str | None,
) -> NodeParameters:
    """Return the parameters that a node gets.

    Args:
        given: as the launch file has it.
        texts: evaluates its texts.
        package: the package of the launch file.
        find: returns an available package by its name.
        name: of the node.
        namespace: None for an unknown one.
    """
    values: list[GivenParameter] = []
    files: list[GivenFile] = []
    complete = True
    for each in given:
        if isinstance(each, FromFile):
            path = located(package, texts.text(each.path) or "")
            file = _file(path, find)
            complete = complete and file is not None and not each.rewritten
            if file is not None:
                space = None if each.rewritten else namespace
                read = list(parameters_for(file, name, space))
                values += (replace(one, given_at=each.place) for one in read)
                files.append(GivenFile(file.shown, each.place, bool(read)))
            continue
        key = texts.text(each.name)
        if key is None:
            complete = False
            continue
        settled = [texts.settled(value) for value in each.values or ()]
        robot = settled[0] if settled else None
        known = (value for value in settled if isinstance(value, str))
        written = tuple(located(package, value) for value in known)
        whole = each.values is not None and len(written) == len(settled)
        source = robot.source if isinstance(robot, RobotText) else None
        values.append(
            GivenParameter(
                key,
                written if whole else None,
                each.place,
                robot=source if isinstance(source, str) else "",
                is_robot=isinstance(robot, RobotText),
                is_argument=isinstance((each.values or ("",))[0], LaunchArgument),
            )
        )
    return NodeParameters(tuple(values), tuple(files), complete)


def _file(path: str, find: Callable[[str], Package | None]) -> YamlFile | None:
    name, _, below = path.removeprefix(SHARE).partition("/")
    package = find(name) if path.startswith(SHARE) else None
    own = installed_as(package, below) if package is not None else None
    files = package.yaml_files if package is not None else ()
    return next((file for file in files if file.path == own), None)

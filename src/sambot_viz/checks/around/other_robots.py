"""Recognise parameter files that belong to another robot of a package."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import PurePosixPath

from sambot_viz.checks.around.files.parameters import YamlFile
from sambot_viz.checks.around.ownership import MODELS
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.workspace import Package
from sambot_viz.checks.clues import severity
from sambot_viz.errors import Problem

_BASES = ("robot_base_frame", "base_link_frame", "base_frame_id", "base_frame")
_WHEELS = ("left_wheel_names", "right_wheel_names")
_OF_ROBOT = {
    "footprint-size": ("footprint", "robot_radius"),
    "drive-wheel-separation": ("wheel_separation",),
    "drive-wheel-radius": ("wheel_radius",),
    "drive-sides": _WHEELS,
    "gazebo-joint": _WHEELS,
    "frame-unknown": _BASES,
    "frame-two-parents": _BASES,
    "control-interface": ("joints",),
}
"""Code → the parameters whose values only one robot has."""
_SIZES = frozenset({"footprint-size", "drive-wheel-separation", "drive-wheel-radius"})
"""Codes of findings about numbers that two robots may share by chance."""
_Model = tuple[Package, str]
_IS_ROBOT = re.compile(r"<(robot|model)\b[^>]*\bname\s*=")
_GENERAL = frozenset(
    """
    base bringup classic config configs control controller controllers default
    description gazebo gz hardware ign launch main model models nav2 navigation old
    params real robot robots ros ros2 sdf sim simulation src test urdf v1 v2 xacro yaml
    yml
    """.split()
)
"""Words in file names that do not name a robot."""
_WORDS = re.compile(r"[/._-]")


def of_this_robot(
    around: Surroundings, problems: Iterable[Problem]
) -> Iterator[Problem]:
    """Leave out findings in parameter files that may be for another robot.

    A file belongs to another robot when its name or a folder in its path is the name of
    another model of the package. It may do so when the parameters of another file fit
    this robot. In all other cases, different sizes are only one clue, unless a model or
    a launch file says whose the file is.
    """
    found = list(problems)
    others = _other_robots(around) if any(p.code in _OF_ROBOT for p in found) else ()
    if not others:
        yield from found
        return
    own = _words(p.shown(path) for p, path in _own_models(around))
    others_words = _words(p.shown(path) for p, path in others)
    foreign = others_words - own
    wrong = {(problem.code, problem.file) for problem in found}
    ours = [f for f in around.yaml_files if foreign.isdisjoint(_words([f.shown]))]
    read = {file.shown for file in around.yaml_files}
    for problem in found:
        # A name that one edit corrects is of this robot.
        is_slip = problem.code == "control-interface" and problem.edits
        is_ours = any(problem.file == file.shown for file in ours)
        is_certain = is_slip or (is_ours and problem.file in around.ownership.own)
        names = None if is_certain else _OF_ROBOT.get(problem.code)
        if names and problem.file in read:
            fitting = (f for f in ours if (problem.code, f.shown) not in wrong)
            if not is_ours or any(_has(file, names) for file in fitting):
                continue
            named = own - others_words
            if problem.code in _SIZES and named.isdisjoint(_words([problem.file])):
                problem = replace(problem, severity=severity({"size"}))
        yield problem


def _has(file: YamlFile, names: tuple[str, ...]) -> bool:
    return any(parameter.name in names for parameter in file.parameters)


def _models(around: Surroundings) -> Iterator[_Model]:
    for package in around.packages:
        for path in package.ending(*MODELS):
            yield package, path


def _own_models(around: Surroundings) -> list[_Model]:
    names = {file.name for file in around.robot.files}
    stem = around.robot.files[0].name.partition(".")[0] if around.robot.files else ""
    return [
        (package, path)
        for package, path in _models(around)
        if _name(path) in names or _name(path).startswith(f"{stem}.")
    ]


def _other_robots(around: Surroundings) -> list[_Model]:
    """Return the models of the packages except this one and its parts."""
    own = set(_own_models(around))
    texts = {
        (package, path): package.text(path) or ""
        for package, path in _models(around)
        if (package, path) not in own
    }
    return [
        model
        for model, text in texts.items()
        if _IS_ROBOT.search(text) and text.count("<joint") and "<world" not in text
    ]


def _name(path: str) -> str:
    return PurePosixPath(path).name


def _words(paths: Iterable[str]) -> set[str]:
    """Return the words in paths that may name a robot."""
    words = {word for path in paths for word in _WORDS.split(path.lower())}
    return words - _GENERAL - {""}

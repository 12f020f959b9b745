"""Report what targets in CMakeLists.txt need before find_package( … ) finds it."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.around.files.cmake import CMakeCommand, CMakeFile
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write_between
from sambot_viz.errors import Fix, Place, Problem

_UNKNOWN = frozenset(
    "include macro function foreach add_subdirectory ament_auto_package "
    "ament_auto_find_build_dependencies".split()
)
_WORDS = frozenset({"PUBLIC", "PRIVATE", "INTERFACE", "SYSTEM"})
_ALONE = frozenset(
    "ament_cmake ament_cmake_python ament_cmake_ros ament_lint_auto rclcpp rclpy "
    "rosidl_default_generators".split()
)
"""Packages that bring only their own messages."""
_OF_RCLCPP = frozenset(
    "builtin_interfaces rcl_interfaces rosgraph_msgs statistics_msgs".split()
)


def unfound_packages(around: Surroundings) -> Iterator[Problem]:
    """Report a package of ament_target_dependencies without an earlier find_package.

    A package also finds its own dependencies, so that only few cases are certain.
    """
    cmake = around.cmake
    if cmake is None or not cmake.is_package or not _UNKNOWN.isdisjoint(cmake.names):
        return
    reported: set[str] = set()
    for command in cmake.commands:
        if command.name != "ament_target_dependencies" or not command.certain:
            continue
        before = _found_before(command, cmake)
        for name, line in command.words[1:]:
            if name in _WORDS | before | reported or not _is_certain(name, before):
                continue
            reported.add(name)
            yield Problem.at(
                cmake.place(line),
                "error",
                "cmake-command-missing",
                f"ament_target_dependencies( … ) is given {name}, which no "
                "find_package( … ) before it has found: colcon build stops",
                _found(name, command, cmake),
            )


def _found_before(command: CMakeCommand, cmake: CMakeFile) -> set[str]:
    return {
        each.words[0].text
        for each in cmake.commands
        if each.name == "find_package" and each.words and each.line < command.line
    }


def _is_certain(name: str, before: set[str]) -> bool:
    """Return whether none of the found packages can bring another one."""
    if name not in vocabulary("packages") or name in _OF_RCLCPP:
        return False
    others = before - _ALONE
    if name == "rclcpp":
        return all(other.endswith("_msgs") for other in others)
    return name.endswith("_msgs") and not others


def _found(name: str, command: CMakeCommand, cmake: CMakeFile) -> Fix:
    """Return the fix that adds a find_package after the last one before a command."""
    line = f"find_package({name} REQUIRED)"
    finds = [
        each
        for each in cmake.commands
        if each.name == "find_package" and each.certain and each.line < command.line
    ]
    hint = f"add {line}"
    if not finds:
        return Fix(f"{hint} after project( … )")
    last = finds[-1].words[-1].line if finds[-1].words else finds[-1].line
    at = Place(cmake.place(last).file, last + 1, 1)
    return write_between(at, at, f"{line}\n", f"{hint} after line {last}")

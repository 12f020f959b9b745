"""Report files and targets in CMakeLists.txt that do not exist."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator

from sambot_viz.checks.around.files.cmake import CMakeCommand, CMakeWord
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

_MAKES = frozenset(
    """
    add_custom_command configure_file execute_process file include
    add_subdirectory macro function
    """.split()
)
"""Commands that may make files."""
_BUILDS = frozenset({"add_executable", "add_library", "ament_auto_add_executable"})
_USES = frozenset(
    """
    ament_target_dependencies target_compile_definitions target_compile_features
    target_compile_options target_include_directories target_link_libraries
    """.split()
)
"""Commands whose first word is a target that another command makes."""
_SOURCES = (".c", ".cc", ".cpp", ".cxx")


def missing_named_files(around: Surroundings) -> Iterator[Problem]:
    """Report files to install or to compile that do not exist."""
    cmake = around.cmake
    if cmake is None or not cmake.is_package or cmake.fault is not None:
        return
    if not _MAKES.isdisjoint(cmake.names):
        return
    for command in cmake.commands if around.files.paths else ():
        for word in _files(command):
            name = word.text
            if not _is_plain(name) or (around.files.folder / name).exists():
                continue
            near, place = _near(name, around), cmake.place(word.line)
            is_source = name.endswith(_SOURCES)
            if near is None and (is_source or "." not in posixpath.basename(name)):
                # What is not kept beside the file comes from another build.
                continue
            what = "compiled" if command.name in _BUILDS else "installed"
            yield Problem.at(
                place,
                "error",
                "cmake-file-missing",
                f"the file {name} is to be {what}, but the package does not have it"
                f"{f'; it has {near}' if near else ''}: colcon build stops",
                write(place, name, near)
                if near is not None
                else f"delete {name} here, or add that file",
            )


def _files(command: CMakeCommand) -> Iterator[CMakeWord]:
    """Yield the files that a command names, relative to the package."""
    if not command.certain or any(w.text == "OPTIONAL" for w in command.words):
        return
    yield from command.installed("FILES")
    yield from command.installed("PROGRAMS")
    if command.name in _BUILDS:
        yield from (w for w in command.words[1:] if w.text.endswith(_SOURCES))


def _is_plain(name: str) -> bool:
    parts = name.split("/")
    return "$" not in name and "" not in parts and {".", ".."}.isdisjoint(parts)


def _near(name: str, around: Surroundings) -> str | None:
    """Return the file with this name elsewhere, or the most similar name."""
    folder, base = posixpath.split(name)
    same = [p for p in around.files.paths if posixpath.basename(p) == base]
    beside = {
        posixpath.basename(path): path
        for path in around.files.paths
        if posixpath.dirname(path) == folder
    }
    near = nearest(base, beside)
    if len(same) == 1:
        return same[0]
    return beside[near] if near is not None and not same else None


def unknown_targets(around: Surroundings) -> Iterator[Problem]:
    """Report misspelt targets, which no command of CMakeLists.txt makes."""
    cmake = around.cmake
    if cmake is None or not cmake.is_package or cmake.fault is not None:
        return
    if not _MAKES.isdisjoint(cmake.names):
        return
    made = {
        command.words[0].text
        for command in cmake.commands
        if command.words and command.name not in {*_USES, "install", "set"}
    }
    targets = [
        command.words[0].text
        for command in cmake.commands
        if command.words and command.name in _BUILDS
    ]
    for command in cmake.commands:
        used = command.installed("TARGETS")
        for word in command.words[:1] if command.name in _USES else used:
            slips = (name for name in targets if is_one_slip(word.text, name))
            near = next(slips, None)
            if word.text in made or near is None or "$" in word.text:
                continue
            place = cmake.place(word.line)
            yield Problem.at(
                place,
                "error",
                "cmake-file-missing",
                f"{command.name}( … ) names the target {word.text}, which no command "
                f"makes; there is {near}: colcon build stops",
                write(place, word.text, near),
            )

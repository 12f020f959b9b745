"""Find the programs that CMakeLists.txt installs, and those that are missing there."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from sambot_viz.checks.around.files.cmake import CMakeCommand, CMakeFile, CMakeWord
from sambot_viz.checks.around.misspelt import is_misspelt
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.workspace import Package
from sambot_viz.checks.rule import listed
from sambot_viz.edits import write, write_between
from sambot_viz.errors import Fix, Place, Problem, nearest

_UNCERTAIN = frozenset(
    """
    add_subdirectory file foreach function include macro
    rclcpp_components_register_node
    """.split()
)
"""Commands that may install programs of any name."""
_PYTHON, _SCRIPTS = "ament_python_install_package", "setup.cfg"
"""The command that installs the programs in such a file, and the file."""
_KINDS = frozenset({"TARGETS", "PROGRAMS", "FILES", "DIRECTORY"})
_BUILDS = frozenset({"add_executable", "ament_auto_add_executable"})
_NAMES = ("${PROJECT_NAME}", "${CMAKE_PROJECT_NAME}")
_RIGHT = "lib/${PROJECT_NAME}"
_STOPS = "ros2 launch stops with it"
_ALIKE = 0.7


class InstalledProgram(NamedTuple):
    """A program that CMakeLists.txt installs.

    Attributes:
        kind: TARGETS, PROGRAMS, FILES or DIRECTORY.
        source: the target, the file or the folder.
        target: the DESTINATION.
    """

    kind: CMakeWord
    source: CMakeWord
    target: CMakeWord


class BuiltPrograms(NamedTuple):
    """The programs of a package with a CMakeLists.txt.

    Attributes:
        installed: path below the prefix → the program.
        built: the targets of add_executable.
    """

    installed: Mapping[str, InstalledProgram]
    built: frozenset[str]


def built_programs(package: Package) -> BuiltPrograms | None:
    """Return the programs that a package installs; None when they are not certain."""
    cmake = package.cmake
    if cmake is None or not cmake.is_package or not _UNCERTAIN.isdisjoint(cmake.names):
        return None
    if _PYTHON in cmake.names and package.ending(_SCRIPTS):
        return None
    installed: dict[str, InstalledProgram] = {}
    built: set[str] = set()
    for command in cmake.commands:
        if command.name in _BUILDS and command.words:
            built.add(_resolved(command.words[0].text, cmake))
        elif command.name == "install":
            found = _installed_by(command, cmake, package)
            if found is None:
                return None
            installed |= found
    if "ament_auto_package" in cmake.names:
        word = CMakeWord(_RIGHT, 0)
        itself = InstalledProgram(word, word, word)
        installed |= {f"lib/{package.name}/{name}": itself for name in built}
    if any("$" in name for name in (*built, *installed) if "{PROJECT_NAM" not in name):
        return None
    return BuiltPrograms(installed, frozenset(built))


def _resolved(text: str, cmake: CMakeFile) -> str:
    """Write the name of the project for its variables."""
    name = cmake.project.text if cmake.project is not None else _NAMES[0]
    for variable in _NAMES:
        text = text.replace(variable, name)
    return text.removeprefix("${CMAKE_INSTALL_PREFIX}/").rstrip("/")


def _installed_by(
    command: CMakeCommand, cmake: CMakeFile, package: Package
) -> dict[str, InstalledProgram] | None:
    """Return what an install( … ) installs; None when it is not certain."""
    kind = command.words[0].text if command.words else ""
    target = _destination(command)
    if kind not in _KINDS or target is None:
        return None
    folder = _resolved(target.text, cmake)
    if folder.startswith("share/") and kind != "PROGRAMS":
        # Most packages have their other files there.
        return {}
    found: dict[str, InstalledProgram] = {}
    for word in command.installed(kind):
        one = InstalledProgram(command.words[0], word, target)
        if kind == "TARGETS":
            found[f"{folder}/{_resolved(word.text, cmake)}"] = one
            continue
        if kind != "DIRECTORY":
            found[f"{folder}/{posixpath.basename(word.text)}"] = one
            continue
        inner = word.text.rstrip("/")
        below = folder if word.text.endswith("/") else f"{folder}/{inner}"
        for path in package.paths:
            if path.startswith(f"{inner}/"):
                found[f"{below}/{path.removeprefix(f'{inner}/')}"] = one
    return found


def _destination(command: CMakeCommand) -> CMakeWord | None:
    """Return the DESTINATION for programs, which may come after RUNTIME."""
    words = [word.text for word in command.words]
    if "RENAME" in words:
        return None
    libraries = {"ARCHIVE", "LIBRARY"} & set(words)
    start = words.index("RUNTIME") if "RUNTIME" in words else 0
    if libraries and not start:
        return None
    for at in range(start, len(words) - 1):
        if words[at] == "DESTINATION":
            return command.words[at + 1]
    return None


def missing_program(package: Package, program: str, place: Place) -> Iterator[Problem]:
    """Report a program of a package with a CMakeLists.txt that is not installed.

    Args:
        package: the package.
        program: the program that a launch file starts.
        place: the line there.
    """
    found, cmake = built_programs(package), package.cmake
    if found is None or cmake is None:
        return
    head = f"lib/{package.name}/"
    if (right := found.installed.get(f"{head}{program}")) is not None:
        if right.kind.text == "FILES":
            yield _not_executable(program, right, cmake, place)
        return
    for path, one in found.installed.items():
        if posixpath.basename(path) == program:
            yield _elsewhere(path, one, cmake, head.rstrip("/"), place)
            return
    names = [p.removeprefix(head) for p in found.installed if p.startswith(head)]
    near = _near(program, names)
    source = None if near else _source(package, program, found)
    if near is None and source is None and not names:
        return
    fix = write(place, program, near) if near is not None else None
    if fix is None and source is not None:
        fix = _added(cmake, source)
    yield Problem.at(
        place,
        "error",
        "launch-program-unknown",
        f"CMakeLists.txt installs no program {program} of {package.name}"
        f"{f', but {listed(names)}' if names else ''}: {_STOPS}",
        fix or Fix(f"write {' or '.join(names)}"),
    )


def _elsewhere(
    path: str, one: InstalledProgram, cmake: CMakeFile, right: str, user: Place
) -> Problem:
    """Report a program in another folder than its package's in lib."""
    program = posixpath.basename(path)
    at = cmake.place(one.target.line)
    if path.startswith(f"{right}/"):
        at = cmake.place(one.source.line)
        fix = write(at, one.source.text, f"{one.source.text}/")
    else:
        fix = write(at, one.target.text, _RIGHT)
    return Problem.at(
        at,
        "error",
        "install-destination",
        f"{program} is installed into {posixpath.dirname(path)}, but "
        f"{where(user, at)} starts it, and ros2 launch looks in {right}: {_STOPS}",
        fix,
    )


def _not_executable(
    program: str, one: InstalledProgram, cmake: CMakeFile, user: Place
) -> Problem:
    at = cmake.place(one.kind.line)
    return Problem.at(
        at,
        "warning",
        "install-destination",
        f"install(FILES … ) takes the permission to run from {program}, which "
        f"{where(user, at)} starts: ros2 launch finds it only after colcon build "
        "--symlink-install",
        write(at, "FILES", "PROGRAMS"),
    )


def _near(program: str, names: list[str]) -> str | None:
    """Return the installed program that a name means."""
    bare = program.removesuffix(".py")
    same = next((n for n in names if n.removesuffix(".py") == bare), None)
    near = same or nearest(program, names, _ALIKE)
    return near if near is not None and is_misspelt(bare, near.split(".")[0]) else None


def _source(package: Package, program: str, found: BuiltPrograms) -> str | None:
    """Return the words of install( … ) for a program that the package has."""
    if program in found.built:
        return f"TARGETS {program}"
    named = (p for p in package.paths if posixpath.basename(p) == program)
    path = next(named, None)
    return f"PROGRAMS {path}" if path is not None else None


def _added(cmake: CMakeFile, source: str) -> Fix:
    """Return the fix that installs a program, before ament_package()."""
    line = f"install({source} DESTINATION {_RIGHT})"
    end = next((c for c in cmake.commands if c.name == "ament_package"), None)
    hint = f"add {line} to CMakeLists.txt"
    if end is None:
        return Fix(hint)
    at = Place(cmake.shown, end.line, 1)
    return write_between(at, at, f"{line}\n", hint)

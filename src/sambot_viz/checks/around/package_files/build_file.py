"""CMakeLists.txt: brackets, the name of the project, and folders that do not exist."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from sambot_viz.checks.around.files.cmake import INSTALLED, CMakeFile, CMakeWord
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.package_files.manifest import named_as_its_folder
from sambot_viz.checks.around.place import line_fix, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import listed
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import together, write, write_between
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

_FOUND = re.compile(r"\$\(find ([^)\s]+)\)|package://([^/\s\"']+)/")
_MODELS = (".xacro", ".urdf", ".sdf")
_NOT_MEANT = frozenset({"build", "install", "log", ".git"})
_UNKNOWN = frozenset({"include", "macro", "function", "add_subdirectory"})
_WITHOUT_AMENT = frozenset(
    """
    ament_lint_auto
    assimp benchmark blas boost bullet catkin ceres cgal curl curses doxygen eigen
    eigen3 fcl fmt freetype git glew glfw3 glm glog glut gtest jsoncpp lapack
    libusb libxml2 nlohmann_json octomap ompl opencv opengl openmp openssl orocos_kdl
    pcl pkgconfig protobuf python python3 pythoninterp pythonlibs qt5 qt6 sdl sdl2
    spdlog sqlite3 threads tinyxml tinyxml2 urdfdom urdfdom_headers vtk x11 xacro
    yaml-cpp zlib
    """.split()
)
"""Names that CMake finds outside ROS; ROS packages bring the commands of ament."""
_LISTS = frozenset({"COMPONENTS", "OPTIONAL_COMPONENTS", "NAMES", "HINTS", "PATHS"})
"""Words of find_package that have names after them."""
_END = "ament_package"
_PLACES = frozenset({"DESTINATION", "TYPE"})
_BEFORE = frozenset({"ament_package_xml", "rosidl_generate_interfaces"})
_MAKES = frozenset({"file", "execute_process", "add_custom_command", "include"})


def unreadable_cmake(around: Surroundings) -> Iterator[Problem]:
    """Report unclosed brackets, and words that CMake does not know."""
    cmake = around.cmake
    if cmake is not None and cmake.fault is not None:
        place = cmake.place(cmake.fault.line)
        yield Problem.at(
            place,
            "error",
            "cmake-unclosed" if cmake.misspelt is None else "cmake-command-missing",
            f"CMake cannot read this file: {cmake.fault.cause}; colcon build stops",
            line_fix(cmake.fault, place, around.files.text("CMakeLists.txt") or ""),
        )


def misspelt_keywords(around: Surroundings) -> Iterator[Problem]:
    """Report misspelt keywords of commands."""
    cmake, table = around.cmake, vocabulary("cmake_keywords")
    if cmake is None or cmake.fault is not None:
        return
    for command in cmake.commands:
        known = table.get(command.name, ())
        for word in command.words[command.name == "find_package" :] if known else ():
            if word.text in _LISTS:
                break
            slips = [each for each in known if is_one_slip(word.text.upper(), each)]
            if word.text not in known and len(slips) == 1:
                place = cmake.place(word.line)
                yield Problem.at(
                    place,
                    "error",
                    "cmake-command-missing",
                    f"{command.name} knows no word {word.text}, but {slips[0]}: colcon "
                    "build stops",
                    write(place, word.text, slips[0]),
                )


def missing_commands(around: Surroundings) -> Iterator[Problem]:
    """Report a CMakeLists.txt without one of the two commands of a package."""
    cmake = around.cmake
    if cmake is None or cmake.fault is not None or not _UNKNOWN.isdisjoint(cmake.names):
        return
    found = {
        command.words[0].text
        for command in cmake.commands
        if command.name == "find_package" and command.words
    }
    finds = any(name.lower() not in _WITHOUT_AMENT for name in found)
    if not cmake.is_package and "ament_cmake" in found and cmake.certain("install"):
        last = cmake.commands[-1]
        place = cmake.place(last.line)
        yield _missing_command(
            place,
            f"{_END}() is missing, so colcon build does not register the package: "
            "ros2 launch does not find it",
            _at_the_end(place.file, around),
        )
    if cmake.is_package and not finds:
        ends = ("ament_package", "ament_auto_package")
        end = next(c for c in cmake.commands if c.name in ends)
        yield _missing_command(
            cmake.place(end.line),
            f"CMake does not know {end.name}() without find_package(ament_cmake "
            "REQUIRED): colcon build stops",
            _after_project(cmake),
        )
    if cmake.is_package and "project" not in cmake.names:
        yield _without_project(cmake, around)


def commands_after_the_end(around: Surroundings) -> Iterator[Problem]:
    """Report commands after ament_package() that must come before it."""
    cmake = around.cmake
    commands = cmake.commands if cmake is not None and cmake.fault is None else ()
    end = next((c for c in commands if c.name == "ament_package"), None)
    for command in commands:
        late = command.name.startswith("ament_export_") or command.name in _BEFORE
        if cmake is None or end is None or command.line <= end.line or not late:
            continue
        line = cmake.place(end.line)
        text = around.files.text("CMakeLists.txt") or ""
        last = Place(line.file, text.count("\n") + 2)
        hint = "write ament_package() at the end of the file"
        again = "ament_package()\n" if text.endswith("\n") else "\nament_package()\n"
        alone = text.splitlines()[end.line - 1].strip() == "ament_package()"
        following = Place(line.file, end.line + 1)
        yield Problem.at(
            line,
            "error",
            "cmake-command-missing",
            f"ament_package() comes before {command.name}() (line {command.line}): "
            "colcon build stops",
            together(
                hint,
                write_between(Place(line.file, end.line, 1), following, "", hint),
                write_between(last, last, again, hint),
            )
            if alone
            else hint,
        )
        return


def _without_project(cmake: CMakeFile, around: Surroundings) -> Problem:
    """Report a CMakeLists.txt that gives the package no name."""
    first = cmake.commands[0]
    line = cmake.place(first.line)
    is_version = first.name == "cmake_minimum_required"
    at = Place(line.file, first.line + is_version, 1)
    written = f"project({around.files.name})"
    where_ = f"after line {first.line}" if is_version else "as the first line"
    return _missing_command(
        line,
        "there is no project( … ) with the name of the package, which ament_package() "
        "needs: colcon build stops",
        write_between(at, at, f"{written}\n", f"add {written} {where_}"),
    )


def _after_project(cmake: CMakeFile) -> Fix:
    line = "find_package(ament_cmake REQUIRED)"
    hint = f"add {line} after project( … )"
    if cmake.project is None:
        return Fix(hint)
    following = Place(cmake.place(1).file, cmake.project.line + 1, 1)
    return write_between(following, following, f"{line}\n", hint)


def _at_the_end(file: str, around: Surroundings) -> Fix:
    text = around.files.text("CMakeLists.txt") or ""
    lines = text.splitlines()
    end = Place(file, max(len(lines), 1), len(lines[-1]) + 1 if lines else 1)
    hint = f"add {_END}() at the end of the file"
    return write_between(end, end, f"\n{_END}()", hint)


def _missing_command(place: Place, message: str, hint: str | Fix) -> Problem:
    return Problem.at(place, "error", "cmake-command-missing", message, hint)


def folders_as_files(around: Surroundings) -> Iterator[Problem]:
    """Report install(FILES … ) with folders."""
    cmake = around.cmake
    for command in cmake.commands if cmake is not None else ():
        words = command.files if command.certain else ()
        folders = [w for w in words if _is_folder(w.text, around)]
        said = next((w.line for w in command.words if w.text == "FILES"), command.line)
        if cmake is not None and folders:
            yield Problem.at(
                cmake.place(folders[0].line),
                "error",
                "install-folder-as-file",
                f"install(FILES … ) is given {_kinds(folders)}: colcon build stops",
                write(
                    cmake.place(said),
                    "FILES",
                    "DIRECTORY",
                    hint="write DIRECTORY for FILES",
                ),
            )


def malformed_installs(around: Surroundings) -> Iterator[Problem]:
    """Report install( … ) without files, or without a destination."""
    cmake = around.cmake
    if cmake is None or cmake.fault is not None:
        return
    for command in cmake.commands:
        words = command.words
        if command.name != "install" or not words:
            continue
        said = {word.text for word in words}
        first, last = words[0], words[-1]
        if said & INSTALLED == set() and _is_folder(first.text, around):
            what, place, word = "what is installed", cmake.place(first.line), first.text
            fix = write(
                place, word, f"DIRECTORY {word}", hint="write DIRECTORY before it"
            )
        elif first.text in ("DIRECTORY", "FILES") and not said & _PLACES:
            what, place, word = (
                "where it is installed",
                cmake.place(last.line),
                last.text,
            )
            target = "DESTINATION share/${PROJECT_NAME}"
            fix = write(place, word, f"{word} {target}", hint=f"add {target} behind it")
        else:
            continue
        yield Problem.at(
            place,
            "error",
            "install-destination",
            f"install( … ) has {word} and does not say {what}: colcon build stops",
            fix,
        )


def _kinds(folders: Sequence[CMakeWord]) -> str:
    names = listed(word.text for word in folders)
    return f"the folders {names}" if len(folders) > 1 else f"the folder {names}"


def _is_folder(name: str, around: Surroundings) -> bool:
    return "$" not in name and (around.files.folder / name).is_dir()


def missing_folders(around: Surroundings) -> Iterator[Problem]:
    """Report folders in install(DIRECTORY … ) that the package does not have."""
    cmake = around.cmake
    if cmake is None or not cmake.is_package:
        return
    made = not _MAKES.isdisjoint(cmake.names)
    for command in cmake.commands:
        optional = any(word.text == "OPTIONAL" for word in command.words)
        for word in command.directories if command.certain and not optional else ():
            near = near_folder(word.text, around)
            if near is not None or (not made and _is_missing(word.text, around)):
                yield _missing(cmake, word, near)


def _missing(cmake: CMakeFile, word: CMakeWord, near: str | None) -> Problem:
    name = word.text.rstrip("/")
    has = f"; it has {near}" if near else ""
    return Problem.at(
        cmake.place(word.line),
        "error",
        "install-folder-missing",
        f"the folder {name} is to be installed, but the package does not have it{has}: "
        "colcon build stops",
        write(cmake.place(word.line), name, near)
        if near
        else f"delete {name} here, or make that folder",
    )


def near_folder(folder: str, around: Surroundings) -> str | None:
    """Return the existing folder whose name a missing one misspells."""
    if not _is_missing(folder, around):
        return None
    above, _, name = folder.rstrip("/").rpartition("/")
    head = f"{above}/" if above else ""
    commands = around.cmake.commands if around.cmake else ()
    named = {w.text.rstrip("/") for c in commands for w in c.directories}
    free = {n.lower(): n for n in _folders_in(around, above) if head + n not in named}
    near = nearest(name.lower(), free)
    return None if near is None else head + free[near]


def _folders_in(around: Surroundings, folder: str) -> list[str]:
    try:
        inner = sorted((around.files.folder / folder).iterdir())
    except OSError:
        return []
    return [p.name for p in inner if p.is_dir() and p.name not in _NOT_MEANT]


def _is_missing(folder: str, around: Surroundings) -> bool:
    parts = folder.split("/")
    if "$" in folder or "" in parts[:-1] or not {".", ".."}.isdisjoint(parts):
        return False
    return not (around.files.folder / folder).exists()


def project_name(around: Surroundings) -> Iterator[Problem]:
    """Compare the project in CMakeLists.txt with the name in package.xml."""
    cmake = around.cmake
    project = cmake.project if cmake is not None and cmake.is_package else None
    name = around.files.name
    if cmake is None or project is None or project.text == name:
        return
    if named_as_its_folder(around):
        return
    manifest = around.files.text("package.xml") or ""
    line = manifest.count("\n", 0, max(manifest.find("<name>"), 0)) + 1
    here = cmake.place(project.line)
    other = Place(around.files.shown("package.xml"), line)
    used = _used_names(around)
    in_folder = around.files.folder.name == project.text
    if (project.text in used or in_folder) and name not in used:
        place, second = other, here
        says = f"package.xml calls the package {name}, but "
        is_used = project.text in used
        says += "files of it are used from " if is_used else "its folder is called "
        says += f"{project.text}, as CMakeLists.txt calls it"
        hint = write(
            place, name or "", project.text, hint=f"write <name>{project.text}</name>"
        )
    else:
        place, second = here, other
        says = f"CMakeLists.txt calls the package {project.text}, "
        says += f"package.xml calls it {name}"
        hint = write(place, project.text, name or "", hint=f"write project({name})")
    yield Problem.at(
        place,
        "error",
        "cmake-project-name",
        f"{says} ({where(second, place)}): what is installed is not found",
        hint,
    )


def _used_names(around: Surroundings) -> set[str]:
    """Return the packages whose files the models and launch files use."""
    texts = (around.files.text(path) for path in around.files.ending(*_MODELS))
    found = {a or b for text in texts for a, b in _FOUND.findall(text or "")}
    for launch in around.launches:
        paths = (fact.value.removeprefix(SHARE) for fact in launch.paths)
        found |= {path.partition("/")[0] for path in paths}
    return found

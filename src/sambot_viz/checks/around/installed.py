"""Folders that are used, but that CMakeLists.txt or setup.py does not install right."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass, field

from sambot_viz.checks.around.build_file import folders_as_files, near_folder
from sambot_viz.checks.around.files.cmake import CMakeCommand, CMakeFile, CMakeWord
from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name, parse_python
from sambot_viz.checks.rule import listed
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem
from sambot_viz.robot.parts import MeshFile

_UNCERTAIN = frozenset(
    {"foreach", "macro", "function", "include", "add_subdirectory", "file"}
)
_SHARES = ("share", "${CMAKE_INSTALL_DATADIR}")
_OF_PACKAGE = "share/${PROJECT_NAME}"
_SEARCHES = frozenset({"walk", "rglob", "iterdir", "listdir", "scandir"})


@dataclass(frozen=True, slots=True)
class Installed:
    """The folders that a build file installs.

    Attributes:
        place: where a missing one is to be added.
        folders: those that get into the share folder of the package.
        elsewhere: those that get to another place, and its DESTINATION.
    """

    place: Place
    folders: set[str]
    elsewhere: dict[str, CMakeWord] = field(default_factory=dict[str, CMakeWord])


def not_installed(around: Surroundings) -> Iterator[Problem]:
    """Report each folder that is used and exists, but is not installed."""
    if any(folders_as_files(around)):
        return
    used = dict(_used_folders(around))
    installed = _installed(around) if used else None
    if installed is None:
        return
    missing = {f: user for f, user in used.items() if f not in installed.folders}
    for target in dict.fromkeys(installed.elsewhere.values()):
        wrong = {
            f: u for f, u in missing.items() if installed.elsewhere.get(f) == target
        }
        if wrong:
            yield _at_wrong_place(around, target, wrong, installed.place.file)
    cmake = installed.place.file.endswith(".txt")
    for folder, user in missing.items():
        if folder in installed.elsewhere:
            continue
        yield Problem.at(
            installed.place,
            "error",
            "folder-not-installed",
            f"the folder {folder} is not installed, but {where(user, installed.place)} "
            "is used from the installed package: it is not found"
            if user.line == 1
            else f"the folder {folder} is not installed, but "
            f"{where(user, installed.place)} looks for a file of it in the installed "
            "package: it is not found",
            f"add install(DIRECTORY {folder} DESTINATION {_OF_PACKAGE})"
            if cmake
            else f"add (os.path.join('share', package_name, '{folder}'), "
            f"glob('{folder}/*')) to data_files",
        )


def _at_wrong_place(
    around: Surroundings, target: CMakeWord, folders: dict[str, Place], file: str
) -> Problem:
    place = Place(file, target.line)
    better = _corrected(target.text, around)
    user = next(iter(folders.values()))
    are, them = ("s", "them") if len(folders) > 1 else ("", "it")
    needs = "is used from" if user.line == 1 else f"looks for {them} in"
    return Problem.at(
        place,
        "error",
        "install-destination",
        f"the folder{are} {listed(folders)} {'are' if are else 'is'} installed into "
        f"{target.text}, but {where(user, place)} {needs} "
        f"share/{around.files.name}: nothing is found",
        write(place, target.text, better) if better else f"write {better}",
    )


_NOT_INSTALLED = frozenset({"doc", "docs", "example", "examples", "test", "tests"})
"""Launch files in these are started by their path."""


def _used_folders(around: Surroundings) -> Iterator[tuple[str, Place]]:
    """The folders of the package that are used; the first user comes last."""
    for launch in reversed(around.launches):
        folder, slash, _ = launch.path.partition("/")
        if slash and folder not in _NOT_INSTALLED:
            yield folder, Place(launch.shown, 1)
    facts = [fact for launch in around.launches for fact in launch.paths]
    for link in around.robot.links.values():
        for shape in (*link.visuals, *link.collisions):
            mesh, place = shape.geometry, shape.geometry_place or shape.place
            if isinstance(mesh, MeshFile) and place is not None:
                facts.append(Fact(mesh.filename, place))
    folders = {path.partition("/")[0] for path in around.files.paths if "/" in path}
    for fact in reversed(facts):
        below = around.own(fact.value) if fact.value.startswith(SHARE) else None
        folder, slash, _ = (below or "").partition("/")
        if slash and folder in folders:
            yield folder, fact.place


def _installed(around: Surroundings) -> Installed | None:
    """What is installed; None when that is not certain."""
    if around.files.text("CMakeLists.txt") is not None:
        return None if around.cmake is None else _by_cmake(around.cmake, around)
    setup = around.files.text("setup.py")
    return None if setup is None else _by_setup(setup, around.files.shown("setup.py"))


def _by_cmake(cmake: CMakeFile, around: Surroundings) -> Installed | None:
    if not cmake.is_package or not _UNCERTAIN.isdisjoint(cmake.names):
        return None
    end = next(c for c in cmake.commands if c.name.startswith("ament_"))
    end = next((c for c in cmake.commands if c.name == "ament_package"), end)
    installed = Installed(cmake.place(end.line), set())
    for command in cmake.commands:
        if command.name == "ament_auto_package":
            installed.folders.update(w.text.rstrip("/") for w in command.words)
        elif command.name == "install" and not _add(command, installed, around):
            return None
    return installed


def _add(command: CMakeCommand, installed: Installed, around: Surroundings) -> bool:
    """Add what one install( … ) does; False when that is not certain."""
    target = command.destination
    if target is None:
        return True
    right = _corrected(target.text, around)
    if right is None:
        return False
    is_right = right == target.text
    folders = _folders(command, right, around)
    if folders is None:
        return not is_right
    if is_right:
        installed.folders.update(folders)
    elif command.directories and command.certain:
        for folder in folders:
            installed.elsewhere.setdefault(folder, target)
    return True


def _corrected(target: str, around: Surroundings) -> str | None:
    """The DESTINATION that is meant by another one, or the same when it is right.

    None when it is not certain where this one leads.
    """
    cmake = around.cmake
    if cmake is None:
        return None
    first, *parts = [part for part in target.split("/") if part] or [""]
    names = {around.files.name, "${PROJECT_NAME}", "${CMAKE_PROJECT_NAME}"}
    if cmake.project is not None:
        names.add(cmake.project.text)
    if first in _SHARES and parts and parts[0] in names:
        return target
    parts = parts if first in _SHARES else [first, *parts]
    at = next((n for n, p in enumerate(parts) if p in names or cmake.is_name(p)), None)
    if at != 0 and "$" in "".join(parts[:1]):
        return None
    return "/".join([_OF_PACKAGE, *([] if at is None else parts[at + 1 :])])


def _folders(
    command: CMakeCommand, target: str, around: Surroundings
) -> set[str] | None:
    """The folders that an install( … ) puts into share; None when not certain."""
    inner = [part for part in target.split("/")[2:] if part]
    if inner:
        return None if "$" in inner[0] else {inner[0]}
    folders: set[str] = set()
    for text, _ in command.directories:
        if "$" in text:
            return None
        if text.endswith(("/", ".")):
            folders |= _inside(text, around)
        else:
            folders.add(near_folder(text, around) or text.rpartition("/")[2])
    return folders


def _inside(folder: str, around: Surroundings) -> set[str]:
    """The folders in a folder, whose content is installed without itself."""
    head = "" if folder in (".", "./") else folder
    paths = (p.removeprefix(head) for p in around.files.paths if p.startswith(head))
    return {path.partition("/")[0] for path in paths if "/" in path}


def _by_setup(text: str, shown: str) -> Installed | None:
    tree = parse_python(text)
    if tree is None:
        return None
    place: Place | None = None
    parts: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            return None
        if isinstance(node, ast.Call) and call_name(node.func) in _SEARCHES:
            return None
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            if "**" in node.value:
                return None
            parts.update(node.value.split("/"))
        if isinstance(node, ast.keyword) and node.arg == "data_files":
            place = Place(shown, node.value.lineno)
    return None if place is None else Installed(place, parts)

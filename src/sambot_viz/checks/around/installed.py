"""Folders that launch files use and that CMakeLists.txt or setup.py do not install."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from typing import NamedTuple

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name, parse_python
from sambot_viz.errors import Place, Problem
from sambot_viz.robot.parts import MeshFile

_COMMENT = re.compile(r"#[^\n]*")
_INSTALL = re.compile(r"\binstall\s*\(([^()]*)\)", re.IGNORECASE)
_PROJECT = re.compile(r"\bproject\s*\(\s*\"?([A-Za-z0-9_.-]+)\b", re.IGNORECASE)
_AUTO = re.compile(r"\bament_auto_package\s*\(([^()]*)\)")
_UNCERTAIN = re.compile(
    r"\b(foreach|macro|function|include|add_subdirectory|file)\s*\(", re.IGNORECASE
)
_HERE = re.compile(r"\$\{(CMAKE_CURRENT_SOURCE_DIR|PROJECT_SOURCE_DIR)\}/?")
_SHARE_FOLDER = re.compile(
    r"(share|\$\{CMAKE_INSTALL_DATADIR\})/+(?P<name>[^/]+)/*(?P<rest>.*)"
)
_WORDS = frozenset(
    "DIRECTORY FILES PROGRAMS DESTINATION PATTERN REGEX USE_SOURCE_PERMISSIONS "
    "FILES_MATCHING PERMISSIONS OPTIONAL".split()
)
_SEARCHES = frozenset({"walk", "rglob", "iterdir", "listdir", "scandir"})


class Installed(NamedTuple):
    """The folders that a build file installs, and the line that does it."""

    folders: frozenset[str]
    place: Place


def not_installed(around: Surroundings) -> Iterator[Problem]:
    """Report each folder that is used and exists, but is not installed."""
    used = dict(_used_folders(around))
    installed = _installed(around) if used else None
    if installed is None:
        return
    for folder, user in used.items():
        if folder in installed.folders:
            continue
        cmake = installed.place.file.endswith(".txt")
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
            f"add install(DIRECTORY {folder} DESTINATION share/${{PROJECT_NAME}})"
            if cmake
            else f"add (os.path.join('share', package_name, '{folder}'), "
            f"glob('{folder}/*')) to data_files",
        )


def _used_folders(around: Surroundings) -> Iterator[tuple[str, Place]]:
    """The folders of the package that are used; the first user comes last."""
    for launch in reversed(around.launches):
        folder, slash, _ = launch.path.partition("/")
        if slash:
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
    cmake = around.files.text("CMakeLists.txt")
    if cmake is not None:
        return _by_cmake(cmake, around)
    setup = around.files.text("setup.py")
    return None if setup is None else _by_setup(setup, around.files.shown("setup.py"))


def _by_cmake(text: str, around: Surroundings) -> Installed | None:
    text = _COMMENT.sub("", text)
    if "ament_package" not in text and "ament_auto_package" not in text:
        return None
    if _UNCERTAIN.search(text):
        return None
    folders: set[str] = set()
    end = text.find("ament_package")
    line = text.count("\n", 0, max(end, 0)) + 1
    for auto in _AUTO.finditer(text):
        folders.update(word.rstrip("/") for word in auto[1].split())
    for found in _INSTALL.finditer(text):
        names = _shared(found[1].split(), around)
        if names is None:
            return None
        folders |= names
    return Installed(
        frozenset(folders), Place(around.files.shown("CMakeLists.txt"), line)
    )


def _shared(words: list[str], around: Surroundings) -> set[str] | None:
    """The folders that one install( … ) puts into share; None when not certain."""
    words = [_HERE.sub("", word.strip('"')) or "." for word in words]
    if not words or "DESTINATION" not in words[:-1]:
        return set()
    target = words[words.index("DESTINATION") + 1].replace(
        "${PROJECT_NAME}", around.files.name
    )
    match = _SHARE_FOLDER.fullmatch(target)
    if match is None:
        return None if target.startswith("${") else set()
    if "${" in match["name"] + match["rest"]:
        return None
    if match["rest"]:
        return {match["rest"].partition("/")[0]}
    if words[0] != "DIRECTORY":
        return set()
    folders: set[str] = set()
    for word in words[1 : words.index("DESTINATION")]:
        if "${" in word:
            return None
        if word in _WORDS:
            continue
        folders |= (
            _inside(word, around)
            if word.endswith(("/", "."))
            else {word.rpartition("/")[2]}
        )
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
    return None if place is None else Installed(frozenset(parts), place)


def project_name(around: Surroundings) -> Iterator[Problem]:
    """Compare the project in CMakeLists.txt with the name in package.xml."""
    text = _COMMENT.sub("", around.files.text("CMakeLists.txt") or "")
    project = _PROJECT.search(text)
    name = around.files.name
    if project is None or project[1] == name or "ament_package" not in text:
        return
    place = Place(
        around.files.shown("CMakeLists.txt"), text.count("\n", 0, project.start()) + 1
    )
    manifest = around.files.text("package.xml") or ""
    line = manifest.count("\n", 0, max(manifest.find("<name>"), 0)) + 1
    other = Place(around.files.shown("package.xml"), line)
    yield Problem.at(
        place,
        "error",
        "cmake-project-name",
        f"CMakeLists.txt calls the package {project[1]}, package.xml calls it {name} "
        f"({where(other, place)}): what is installed is not found",
        f"write project({name})",
    )

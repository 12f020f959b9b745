"""Report files in use that CMakeLists.txt or setup.py does not install right."""

from __future__ import annotations

import ast
import posixpath
from collections.abc import Iterator
from functools import partial
from pathlib import PurePath
from typing import TYPE_CHECKING

from sambot_viz.checks.around.files.cmake import CMakeCommand, CMakeFile, CMakeWord
from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.installs import Installed, Piece
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.package_files.build_file import (
    folders_as_files,
    malformed_installs,
    near_folder,
)
from sambot_viz.checks.around.package_files.own_names import setup_name
from sambot_viz.checks.around.place import rewritten, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import listed
from sambot_viz.edits import write, write_between
from sambot_viz.errors import Fix, Place, Problem
from sambot_viz.robot.parts import MeshFile
from sambot_viz.robot.slips.vocabulary import is_one_slip

if TYPE_CHECKING:
    from sambot_viz.checks.around.setup_file import DataFiles, SetupFile

_UNCERTAIN = frozenset(
    {"foreach", "macro", "function", "include", "add_subdirectory", "file"}
)
_SHARES = ("share", "${CMAKE_INSTALL_DATADIR}")
_OF_PACKAGE = "share/${PROJECT_NAME}"
_NOT_INSTALLED = frozenset({"doc", "docs", "example", "examples", "test", "tests"})
"""Folders whose launch files users start by path."""


def not_installed(around: Surroundings) -> Iterator[Problem]:
    """Report each existing file in use that the build does not install in its place."""
    if any(folders_as_files(around)) or any(malformed_installs(around)):
        return
    if around.cmake is not None and around.cmake.fault is not None:
        return
    if around.setup is not None and any(setup_name(around)):
        return
    used: dict[str, Place] = {}
    for path, user in sorted(_used(around), key=lambda u: (u[1].file, u[1].line)):
        used.setdefault(path, user)
    installed = installed_by_build(around) if used else None
    if installed is None:
        return
    missing = {
        path: user
        for path, user in used.items()
        if not installed.has(path) and not _is_launch(path, user, installed)
    }
    wrong: dict[Piece, dict[str, Place]] = {}
    for path in list(missing):
        pieces = [piece for _, piece in installed.targets(path) if piece.certain]
        if pieces:
            first = next((p for p in wrong if p[2:] == pieces[0][2:]), pieces[0])
            wrong.setdefault(first, {})[path] = missing.pop(path)
    for piece, paths in wrong.items():
        yield _at_wrong_place(around, piece, paths, installed)
    yield from _nowhere(around, missing, installed)


def _is_launch(path: str, user: Place, installed: Installed) -> bool:
    """Return whether ros2 launch finds a launch file anywhere in the share folder."""
    head = f"{installed.share}/"
    itself = user.line == 1 and path.endswith("launch.py")
    return itself and any(t.startswith(head) for t, _ in installed.targets(path))


def _named(user: Place, here: Place | None) -> str:
    """Name the user of a file for a sentence; a launch file uses itself as a whole."""
    return PurePath(user.file).name if user.line == 1 else where(user, here)


def _used(around: Surroundings) -> Iterator[tuple[str, Place]]:
    """Yield the used files of the package, each with a user."""
    for launch in around.launches:
        folder, slash, _ = launch.path.partition("/")
        module = f"{posixpath.dirname(launch.path)}/__init__.py" in around.files.paths
        if slash and folder not in _NOT_INSTALLED and not module:
            yield launch.path, Place(launch.shown, 1)
    facts = [fact for launch in around.launches for fact in launch.paths]
    for link in around.links.values():
        for shape in (*link.visuals, *link.collisions):
            mesh, place = shape.geometry, shape.geometry_place or shape.place
            if isinstance(mesh, MeshFile) and place is not None:
                facts.append(Fact(mesh.filename, place))
    for fact in facts:
        below = around.own(fact.value) if fact.value.startswith(SHARE) else None
        if below and "/" in below and (around.files.folder / below).exists():
            yield below, fact.place


def _nowhere(
    around: Surroundings, missing: dict[str, Place], installed: Installed
) -> Iterator[Problem]:
    """Report files that nothing installs: one row for each folder to add."""
    setup = around.setup if around.cmake is None else None
    groups: dict[str, dict[str, Place]] = {}
    for path, user in missing.items():
        top, above = path.partition("/")[0], posixpath.dirname(path)
        partly = setup is None and installed.has(top)
        groups.setdefault(above if setup or partly else top, {})[path] = user
    for folder, paths in groups.items():
        entry = _without_files(setup, f"{installed.share}/{folder}") if setup else None
        if setup is not None and entry is not None:
            yield _empty(setup, entry, folder, paths, around)
            continue
        partly = installed.has(folder)
        user = next(iter(paths.values()))
        names = listed(paths) if partly else f"the folder {folder}"
        are = "are" if partly and len(paths) > 1 else "is"
        by = _named(user, installed.place)
        needs = (
            f"{by} is used from the installed package"
            if user.line == 1
            else f"{by} looks for {'it' if partly else 'a file of it'} in the "
            "installed package"
        )
        yield Problem.at(
            installed.place,
            "error",
            "folder-not-installed",
            f"{names} {are} not installed, but {needs}: it is not found",
            _added(
                setup, _addition(setup, folder, paths, around, partly=partly), around
            ),
        )


def _added(setup: SetupFile | None, line: str, around: Surroundings) -> Fix:
    """Return the fix that adds a line to data_files, or before ament_package()."""
    ends = ("ament_package", "ament_auto_package")
    cmake, given = around.cmake, setup.given("data_files") if setup else None
    if setup is None and cmake is not None:
        end = next((c for c in cmake.commands if c.name in ends), None)
        at = cmake.place(end.line if end else 1)
        at = Place(at.file, at.line, 1)
        hint = f"add {line}"
        return Fix(hint) if end is None else write_between(at, at, f"{line}\n", hint)
    if setup is None or not isinstance(given, ast.List):
        return Fix(f"add {line}")
    place, bare = setup.place(given), line.removesuffix(" to data_files")
    at = Place(place.file, place.line, (place.column or 1) + 1)
    return write_between(at, at, f"\n        {bare},", f"add {line}")


def _addition(
    setup: SetupFile | None,
    folder: str,
    paths: dict[str, Place],
    around: Surroundings,
    *,
    partly: bool,
) -> str:
    """Return the lines that install a folder, or more of its files."""
    if setup is not None:
        target = setup.share(around.files.name, folder)
        return f"({target}, {_files(setup, folder, paths, around)}) to data_files"
    if partly:
        return f"install(FILES {' '.join(paths)} DESTINATION {_OF_PACKAGE}/{folder})"
    return f"install(DIRECTORY {folder} DESTINATION {_OF_PACKAGE})"


def _files(
    setup: SetupFile, folder: str, paths: dict[str, Place], around: Surroundings
) -> str:
    """Write the files of a folder for data_files, which does not accept folders."""
    flat = not any(p.is_dir() for p in (around.files.folder / folder).iterdir())
    return (setup.globbed(f"{folder}/*") if flat else None) or str(list(paths))


def _without_files(setup: SetupFile, target: str) -> DataFiles | None:
    """Return the entry of data_files for a folder whose globs find nothing."""
    for entry in setup.data_files:
        if entry.target == target and not entry.files.items and any(entry.globs):
            return entry
    return None


def _empty(
    setup: SetupFile,
    entry: DataFiles,
    folder: str,
    paths: dict[str, Place],
    around: Surroundings,
) -> Problem:
    glob = next(entry.globs)
    pattern = setup.values.text(glob.args[0] if glob.args else None) or ""
    ending = posixpath.splitext(next(iter(paths)))[1]
    fitting = f"{folder}/*{ending}"
    place = setup.place(glob)
    user = next(iter(paths.values()))
    used = (
        f"{_named(user, place)} is used from the installed package"
        if user.line == 1
        else f"{_named(user, place)} looks for {listed(paths, 2)}"
    )
    return Problem.at(
        place,
        "error",
        "install-glob-empty",
        f"{pattern} fits no file, so nothing is installed into share/"
        f"{around.files.name}/{folder}, but {used}: it is not found",
        write(
            place,
            pattern,
            fitting,
            hint=f"write {setup.globbed(fitting) or fitting}",
        ),
    )


def _at_wrong_place(
    around: Surroundings, piece: Piece, paths: dict[str, Place], installed: Installed
) -> Problem:
    """Name the installed place of files, and the place where ROS looks for them."""
    place, (path, user) = piece.place, next(iter(paths.items()))
    folders = list(dict.fromkeys(p.partition("/")[0] for p in paths))
    are, them = ("s", "them") if len(folders) > 1 else ("", "it")
    by = _named(user, place)
    needs = f"{by} is used from" if user.line == 1 else f"{by} looks for {them} in"
    share = f"share/{around.files.name}"
    above = posixpath.dirname(path)
    if not f"{piece.target}/".startswith(f"{installed.share}/"):
        what = f"the folder{are} {listed(folders)} {'are' if are else 'is'} installed "
        what += f"into {piece.said}, but {needs} {share}: nothing is found"
    elif piece.source.endswith("/"):
        words = [f"{folder}/" for folder in folders]
        ends, of = ("end", "folders") if are else ("ends", "folder")
        what = f"{listed(words)} {ends} with a slash, so that CMake installs what is "
        what += f"in {them} without the {of}, but {by} looks for {path} in {share}: it "
        what += "is not found"
        return Problem.at(
            place,
            "error",
            "install-destination",
            what,
            f"write {' '.join(folders)} without the slash" + "es" * bool(are),
        )
    else:
        what = f"{listed(paths, 3)} {'are' if len(paths) > 1 else 'is'} installed into "
        what += f"{posixpath.dirname(piece.target)}, but {by} looks for {path} in "
        what += f"{share}/{above}: it is not found"
    setup = around.setup if around.cmake is None else None
    if setup is not None:
        right = setup.share(around.files.name, above)
    else:
        right = _corrected(piece.said, around) or _OF_PACKAGE
        if right == piece.said:
            right = f"{_OF_PACKAGE}/{above}"
    fix = write(place, piece.said, right)
    if setup is not None:
        pairs = (entry.node for entry in setup.data_files)
        for pair in (pair for pair in pairs if setup.place(pair) == place):
            if isinstance(pair, ast.Tuple):
                folder = posixpath.basename(posixpath.dirname(piece.target))
                fix = _misspelt_folder(setup, pair, folder, above) or rewritten(
                    pair.elts[0], setup.shown, right
                )
    return Problem.at(place, "error", "install-destination", what, fix)


def _misspelt_folder(
    setup: SetupFile, pair: ast.Tuple, folder: str, right: str
) -> Fix | None:
    """Return the fix for a folder with one wrong letter in a target."""
    if folder == right or not is_one_slip(folder.lower(), right.lower()):
        return None
    for node in ast.walk(pair.elts[0]):
        if isinstance(node, ast.Constant) and str(node.value).endswith(folder):
            return write(setup.place(node), folder, right)
    return None


def misspelt_targets(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report a target that misspells the folder of its files.

    A target that a launch file names is right, or another rule reports it.
    """
    share = f"share/{around.files.name}"
    paths = [fact.value for launch in around.launches for fact in launch.paths]
    named = {(around.own(path) or "").partition("/")[0] for path in paths}
    for entry in setup.data_files if around.cmake is None else ():
        above, _, folder = (entry.target or "").rpartition("/")
        sources = {posixpath.dirname(path or "") for _, path in entry.files.items}
        source = sources.pop() if len(sources) == 1 else ""
        meant = folder.lower().rstrip("s") == source.lower().rstrip("s")
        if above != share or meant or not named.isdisjoint({source, folder}):
            continue
        fix = (
            _misspelt_folder(setup, entry.node, folder, source)
            if isinstance(entry.node, ast.Tuple) and source
            else None
        )
        if fix is not None:
            yield Problem.at(
                setup.place(entry.node),
                "warning",
                "install-destination",
                f"the files of {source} are installed into {entry.target}: none is "
                f"found in {share}/{source}",
                fix,
            )


def installed_by_build(around: Surroundings) -> Installed | None:
    """Return the installed files and folders; None when they are not certain."""
    share = f"share/{around.files.name}"
    made = partial(Installed, folder=around.files.folder, share=share)
    cmake, setup = around.cmake, around.setup
    if around.files.text("CMakeLists.txt") is not None:
        pieces = None if cmake is None else _by_cmake(cmake, around)
        if cmake is None or pieces is None:
            return None
        ends = [c for c in cmake.commands if c.name.startswith("ament_")]
        end = next((c for c in ends if c.name == "ament_package"), ends[0])
        return made(cmake.place(end.line), pieces=tuple(pieces))
    if setup is None or not setup.installs_only_known:
        return None
    place = setup.place(setup.given("data_files"))
    return made(place, pieces=tuple(_by_setup(setup)))


def _by_setup(setup: SetupFile) -> Iterator[Piece]:
    for entry in setup.data_files:
        target = entry.target or ""
        for _, path in entry.files.items:
            if path is not None:
                name = posixpath.basename(path)
                yield Piece(path, f"{target}/{name}", target, setup.place(entry.node))


def _by_cmake(cmake: CMakeFile, around: Surroundings) -> list[Piece] | None:
    if not cmake.is_package or not _UNCERTAIN.isdisjoint(cmake.names):
        return None
    share = f"share/{around.files.name}"
    found: list[Piece] = []
    for command in cmake.commands:
        if command.name == "ament_auto_package":
            for word in command.words:
                folder = f"{word.text.rstrip('/')}/"
                place = cmake.place(word.line)
                found.append(Piece(folder, f"{share}/{folder}", _OF_PACKAGE, place))
        elif command.name == "install" and command.destination is not None:
            pieces = _of_command(command, command.destination, cmake, around)
            if pieces is None:
                return None
            found += pieces
    return found


def _of_command(
    command: CMakeCommand, target: CMakeWord, cmake: CMakeFile, around: Surroundings
) -> list[Piece] | None:
    """Return the files and folders of one install( … ); None when uncertain."""
    right = _corrected(target.text, around)
    if right is None:
        return None
    in_share = right == target.text
    share = ["share", around.files.name, *right.split("/")[2:]]
    folder = "/".join(p for p in share if p) if in_share else target.text.rstrip("/")
    found: list[Piece] = []
    for text, line in (*command.directories, *command.files):
        if "$" in text or (in_share and "$" in folder):
            return None if in_share else []
        place = cmake.place(target.line)
        if text in [word.text for word in command.files]:
            name = posixpath.basename(text)
            piece = Piece(text, f"{folder}/{name}", target.text, place)
        elif text in (".", "./"):
            piece = Piece("", f"{folder}/", target.text, place)
        elif text.endswith("/"):
            here = cmake.place(line if in_share else target.line)
            piece = Piece(text, f"{folder}/", target.text, here)
        else:
            source = near_folder(text, around) or text
            name = posixpath.basename(source)
            piece = Piece(f"{source}/", f"{folder}/{name}/", target.text, place)
        found.append(piece._replace(certain=command.certain))
    return found


def _corrected(target: str, around: Surroundings) -> str | None:
    """Return the right DESTINATION for a misspelt one, or the same for a right one.

    None when its value is not certain.
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

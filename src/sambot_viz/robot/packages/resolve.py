"""Resolve the file names in models to files on this machine.

The package's name counts first; the end of the path is only the last resort, because
two packages may have files of the same name. The xacro child reads this module too, so
it uses only the standard library.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Container, Iterator
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import Literal
from urllib.parse import unquote

from sambot_viz import limits
from sambot_viz.robot.packages.name_form import NameForm, name_form
from sambot_viz.robot.packages.package_index import (
    PackageIndex,
    package_around,
    package_name,
)

Doubt = Literal[
    "letter-case",
    "other-machine",
    "other-layout",
    "path-only",
    "three-slashes",
    "model-scheme",
    "name-form",
]
"""The reason why ROS would not find a file that this module has found."""

_HERE = ("localhost/", "127.0.0.1/")
"""Hosts that file:// may name before a path, in RViz's reading."""
_INSTALLED = re.compile(
    r"^\s*install\s*\(\s*DIRECTORY\s+([^()#]*?)\s+DESTINATION\s+"
    r"\"?share/\$\{PROJECT_NAME\}/?\"?\s*\)",
    re.MULTILINE,
)
"""Folders that packages install with all their content."""
_OF_WINDOWS = re.compile(r"[A-Za-z]:[\\/]|\\\\")


@dataclass(frozen=True, slots=True)
class Resolution:
    """The place of a file, or the searched places.

    Attributes:
        path: the file, or None.
        searched: attempts in order, as text for a message.
        doubt: set when ROS would not find a file by this name.
        missing_package: the missing package, when that is the reason.
        known_packages: packages found during the search.
        form: set when ROS does not read names of this form.
    """

    path: Path | None
    searched: tuple[str, ...] = ()
    doubt: Doubt | None = None
    missing_package: str | None = None
    known_packages: tuple[str, ...] = ()
    form: NameForm | None = None


class FileResolver:
    """Resolves the file names of one model: meshes, textures, includes."""

    def __init__(self, index: PackageIndex, folder: Path | None) -> None:
        """Prepare.

        Args:
            index: finds packages.
            folder: the model's folder; relative names start there.
        """
        self._index = index
        self._folder = folder
        self._answers: dict[str, Resolution] = {}

    def resolve(self, name: str) -> Resolution:
        """Find the file that a model calls `name`, and cache the answer.

        Args:
            name: "package://pkg/…", "model://…", "file://…", a relative or an
                absolute path. Web addresses are never fetched.
        """
        if name not in self._answers:
            try:
                self._answers[name] = self._resolve_form(name)
            except (OSError, ValueError) as error:
                # A name that is too long, or one that no file system can hold.
                reason = getattr(error, "strerror", None) or str(error)
                self._answers[name] = Resolution(None, (reason,))
        return self._answers[name]

    def _resolve_form(self, name: str) -> Resolution:
        """Find a file by its name, else by the intended name for its form."""
        found = self._resolve(name)
        form = name_form(name) if found.path is None else None
        if form is None:
            return found
        again = self._resolve(form.right)
        doubt: Doubt | None = "name-form" if again.path else None
        return replace(again, doubt=doubt, form=form)

    def _resolve(self, name: str) -> Resolution:
        scheme, separator, rest = name.partition("://")
        if not separator and name.startswith("file:"):
            return self._file(name.removeprefix("file:"))
        if not separator:
            windows = _OF_WINDOWS.match(name) is not None
            return self._plain(name.replace("\\", "/") if windows else name)
        if scheme in ("package", "model"):
            return self._in_package(rest, scheme)
        if scheme == "file":
            return self._file(rest)
        return Resolution(None, (f"{scheme} addresses are not fetched",))

    def _file(self, rest: str) -> Resolution:
        """Return a file of "file://rest": a path, with or without this host's name."""
        for computer in _HERE:
            if rest.startswith(computer):
                return self._plain(rest[len(computer) - 1 :])
        if sys.platform == "win32" and _OF_WINDOWS.match(rest[1:]):
            # file:///C:/robot/part.stl
            rest = rest[1:]
        if rest.startswith("/") or _OF_WINDOWS.match(rest):
            return self._plain(rest)
        return Resolution(None)

    def _in_package(self, rest: str, scheme: str) -> Resolution:
        if rest.startswith("/"):
            return self._without_package(rest.lstrip("/"))
        package, _, tail = rest.partition("/")
        tail = tail.lstrip("/")
        lookup = self._index.find(package)
        if lookup.path is None:
            found = self._by_tail(tail) if scheme == "package" else None
            if found is not None:
                doubt: Doubt = "path-only"
                return Resolution(found, lookup.searched, doubt, package, lookup.known)
            return Resolution(None, lookup.searched, None, package, lookup.known)
        found = self._below(lookup.path, tail)
        if found.path is not None and found.doubt is None:
            if scheme == "model":
                return replace(found, doubt="model-scheme")
            if _is_inner(lookup.path):
                return replace(found, doubt="path-only", missing_package=package)
        return found

    def _without_package(self, tail: str) -> Resolution:
        """Resolve "package:///tail": the package is the first folder, or missing."""
        package, _, rest = tail.partition("/")
        root = self._index.find(package).path if rest else None
        found = None if root is None else self._below(root, rest).path
        found = found or self._by_tail(tail)
        return Resolution(found, ("the folders above the model",), "three-slashes")

    def _below(self, root: Path, tail: str) -> Resolution:
        """Find a file below a package folder, by its path, its case or its layout."""
        path = root / tail
        for candidate in (path, root / unquote(tail)):
            if candidate.is_file():
                return Resolution(candidate)
        cased = other_letter_case(path)
        if cased is not None:
            return Resolution(cased, (str(path),), "letter-case")
        moved = inside_package(root, PurePosixPath(tail), ())
        if moved is not None:
            same = is_installed_as_is(root, moved)
            doubt: Doubt = "path-only" if same else "other-layout"
            return Resolution(moved, (str(path),), doubt)
        return Resolution(None, (str(path),))

    def _plain(self, name: str) -> Resolution:
        base = self._folder or Path.cwd()
        path = base / name
        for candidate in (path, base / unquote(name)):
            if candidate.is_file():
                return Resolution(candidate)
        cased = other_letter_case(path)
        if cased is not None:
            return Resolution(cased, (str(path),), "letter-case")
        if path.is_absolute() and (name.startswith("/") or name[1:2] == ":"):
            return self._other_machine(path)
        found = self._by_tail(name)
        doubt: Doubt | None = "path-only" if found else None
        return Resolution(found, (str(path),), doubt)

    def _other_machine(self, path: Path) -> Resolution:
        """Find the part of another machine's absolute path after a known package."""
        parts = path.parts
        for position in range(len(parts) - 2, 0, -1):
            lookup = self._index.find(parts[position])
            if lookup.path is None:
                continue
            found = self._below(lookup.path, "/".join(parts[position + 1 :])).path
            if found is not None:
                return Resolution(found, (str(path),), "other-machine")
        return Resolution(None, (str(path),))

    def _by_tail(self, tail: str) -> Path | None:
        """Return the same path below one of the folders above the model."""
        if ".." in PurePosixPath(tail).parts:
            return None
        for folder in self._index.ancestors():
            if (folder / tail).is_file():
                return folder / tail
        return None


def _is_inner(folder: Path) -> bool:
    """Return whether a folder is not a package, but lies in one."""
    return package_name(folder) is None and package_around(folder) is not None


def other_letter_case(path: Path) -> Path | None:
    """Find the one file whose path differs only in capital letters, or None."""
    missing: list[str] = []
    folder = path
    while not folder.is_dir():
        if folder.parent == folder:
            return None
        missing.append(folder.name)
        folder = folder.parent
    for name in reversed(missing):
        same = [entry for entry in _names(folder) if entry.lower() == name.lower()]
        if len(same) != 1:
            return None
        folder = folder / same[0]
    return folder if folder.is_file() else None


def _names(folder: Path) -> list[str]:
    try:
        return os.listdir(folder)
    except OSError:
        return []


def inside_package(
    root: Path, relative: PurePosixPath | Path, refused: Container[str]
) -> Path | None:
    """Find a file whose path ends like `relative` somewhere below a package.

    A source tree need not be laid out like the installed package: what is installed
    as ros2_control/x.xacro may be description/ros2_control/x.xacro in the source tree.

    Args:
        root: the package folder.
        relative: the path that is missing there.
        refused: real paths that may not be the answer: files being included, which
            would include themselves without end.
    """
    if ".." in relative.parts or not relative.parts:
        return None
    matches = [
        folder / relative
        for folder, _ in walk_below(root)
        if (folder / relative).is_file()
        and os.path.realpath(folder / relative) not in refused
    ]
    return min(matches, key=lambda p: (len(p.parts), str(p)), default=None)


def is_installed_as_is(root: Path, file: Path) -> bool:
    """Return whether a package installs a file at its place in the source tree."""
    try:
        text = (root / "CMakeLists.txt").read_text("utf-8", "replace")
    except OSError:
        return False
    top = file.relative_to(root).parts[0]
    installed = (match[1].split() for match in _INSTALLED.finditer(text))
    return any(top in names for names in installed)


def walk_below(root: Path) -> Iterator[tuple[Path, list[str]]]:
    """Yield the folders of a package with their files, up to the limit."""
    count = 0
    for folder, children, files in os.walk(root):
        children[:] = sorted(c for c in children if not c.startswith("."))
        yield Path(folder), files
        count += 1
        if count >= limits.NEAR_FOLDERS.value:
            return

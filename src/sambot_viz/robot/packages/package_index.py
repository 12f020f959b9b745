"""Find ROS packages without ROS.

The xacro child reads this module too and must start fast, so it uses only the standard
library.
"""

from __future__ import annotations

import os
import re
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from sambot_viz import limits
from sambot_viz.files import read_limited
from sambot_viz.unsaved import unsaved_text

MANIFESTS = ("package.xml", "manifest.xml", "model.config")
IGNORE_MARKS = frozenset({"COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE"})
_SKIPPED = frozenset({"build", "log", "node_modules", "__pycache__", "site-packages"})
_NAME = re.compile(r"<name>\s*([^<\s]+)\s*</name>")
_PLAUSIBLE = re.compile(r"\w[\w.-]*")
"""A possible name of a package. A model may ask for any text, such as "/"."""
_MAX_UP = 6
_MOST_NAMED = 6
_NOT_ALL = "not all below"


class Lookup(NamedTuple):
    """The answer to "where is this package?".

    Attributes:
        name: name of the package.
        path: its folder, or None.
        searched: searched places, as text for a message.
        known: names of other packages found during the search.
        installed: whether it is an installed package, not one of the workspace.
    """

    name: str
    path: Path | None
    searched: tuple[str, ...] = ()
    known: tuple[str, ...] = ()
    installed: bool = False


def places_of(searched: Sequence[str]) -> str:
    """Return the places of a look-up for a message, and the ones not searched."""
    rest = [place for place in searched[_MOST_NAMED:] if place.startswith(_NOT_ALL)]
    return ", ".join([*searched[:_MOST_NAMED], *rest]) or "nowhere"


def package_name(folder: Path) -> str | None:
    """Return the name that a package folder gives itself, None for other folders.

    It is the ``<name>`` in package.xml, not the folder's name; packages with the older
    manifest.xml or with Gazebo's model.config are named by their folder.
    """
    text = unsaved_text(folder / "package.xml")
    if text is None:
        try:
            data = read_limited(folder / "package.xml", limits.PACKAGE_TEXT.value)
        except (OSError, ValueError):
            old = any((folder / name).is_file() for name in MANIFESTS[1:])
            return folder.name if old else None
        text = data.decode("utf-8", "replace")
    without_comments = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    match = _NAME.search(without_comments)
    return match[1] if match else folder.name


def package_of(file: Path) -> Path:
    """Return the folder of a file's package, or the file's folder without one."""
    beside = file.absolute().parent
    above = (beside, *beside.parents)
    return next((each for each in above if package_name(each) is not None), beside)


def package_around(file: Path) -> Path | None:
    """Return the folder of a file's package; None without one."""
    folders = PackageIndex(file.absolute().parent).ancestors()
    return next((folder for folder in folders if package_name(folder)), None)


class PackageIndex:
    """Finds the folders of packages; searches only as far as each question needs.

    The order: ``name=folder`` given by the user, the user's folders, the packages
    around the model, its workspace, ROS_PACKAGE_PATH, AMENT_PREFIX_PATH and
    COLCON_PREFIX_PATH, and last a folder that only has the package's name.
    """

    def __init__(
        self,
        start: Path | None,
        package_path: Sequence[Path | str] = (),
        environment: Mapping[str, str] | None = None,
    ) -> None:
        """Prepare; nothing is read yet.

        Args:
            start: folder of the model, or None for a model given as text.
            package_path: the user's package folders, folders of packages, or
                ``name=folder``.
            environment: environment with ROS's path variables; default os.environ.
        """
        self._start = start.absolute() if start is not None else None
        self._environment = os.environ if environment is None else environment
        self._given: dict[str, Path] = {}
        self._folders: list[Path] = []
        for entry in package_path:
            name, equals, folder = str(entry).partition("=")
            if equals and _PLAUSIBLE.fullmatch(name):
                self._given[name] = Path(folder).expanduser().absolute()
            else:
                self._folders.append(Path(entry).expanduser().absolute())
        self._answers: dict[str, Lookup] = {}
        self._scans: dict[Path, _Scan] = {}

    def find(self, name: str) -> Lookup:
        """Look a package up, and cache the answer.

        A text that cannot be a package name, such as "/" or "../x", finds nothing and
        touches no file: as a part of a path it would lead anywhere.
        """
        if not _PLAUSIBLE.fullmatch(name):
            return Lookup(name, None)
        if name not in self._answers:
            self._answers[name] = self._search(name)
        return self._answers[name]

    def ancestors(self) -> Iterator[Path]:
        """Yield the model's folder and those above it, never a home or a root."""
        if self._start is None:
            return
        yield self._start
        for folder in list(self._start.parents)[:_MAX_UP]:
            if _too_broad(folder):
                return
            yield folder

    def own_roots(self) -> list[Path]:
        """Return the folders of the model: its own, its package's, and the user's."""
        roots = [*self._folders, *self._given.values()]
        if self._start is not None:
            roots.append(self._start)
            package = next((f for f in self.ancestors() if package_name(f)), None)
            if package is not None:
                roots.append(package)
        return roots

    def below(self) -> dict[str, Path]:
        """Return the packages at and below the user's folders, by name."""
        found = dict(self._given)
        for folder in self._folders:
            scan = self._scan(folder, limits.SEARCHED_FOLDERS.value)
            found = {**scan.packages, **found}
        return found

    def _search(self, name: str) -> Lookup:
        if name in self._given:
            path = self._given[name]
            return Lookup(name, path if path.is_dir() else None, (str(path),))
        searched: list[str] = []
        known: dict[str, None] = dict.fromkeys(self._given)
        by_folder: Path | None = None
        for label, scan in self._sources():
            searched += [label, scan.left_out] if scan.left_out else [label]
            known.update(dict.fromkeys(scan.packages))
            if name in scan.packages:
                return Lookup(name, scan.packages[name], tuple(searched))
            by_folder = by_folder or scan.folders.get(name)
        for label, path in self._installed(name):
            searched.append(label)
            if path is not None:
                return Lookup(name, path, tuple(searched), installed=True)
        by_folder = by_folder or self._beside(name)
        return Lookup(name, by_folder, tuple(searched), tuple(known))

    def _sources(self) -> Iterator[tuple[str, _Scan]]:
        for folder in self._folders:
            yield str(folder), self._scan(folder, limits.SEARCHED_FOLDERS.value)
        budget = limits.SEARCHED_FOLDERS.value
        for folder in self._neighbourhood():
            scan = self._scan(folder, budget)
            budget -= scan.size
            yield str(folder), scan
            if scan.has_more:
                break
        for entry in self._path_variable("ROS_PACKAGE_PATH"):
            yield (
                f"{entry} (ROS_PACKAGE_PATH)",
                self._scan(entry, limits.SEARCHED_FOLDERS.value),
            )

    def _neighbourhood(self) -> Iterator[Path]:
        """The folders to search, from the model's own up to its workspace.

        Without a sign of a workspace the search ends three folders above the model's
        package (the folder of checkouts, when packages come in groups), or in the
        model's folder when it belongs to no package: folders further up have nothing
        to do with the model.
        """
        folders = list(self.ancestors())
        packages = [n for n, folder in enumerate(folders) if package_name(folder)]
        inside = packages[-1] if packages else 0
        marked = [
            n
            for n, folder in enumerate(folders)
            if n >= inside and _workspace_root(folder)
        ]
        if marked:
            end = marked[0]
        else:
            end = inside + 3 if packages else 0
        yield from folders[: end + 1]

    def _beside(self, name: str) -> Path | None:
        """Return a folder of that name above the model, or beside such a folder."""
        for folder in self.ancestors():
            if folder.name == name:
                return folder
            if (folder.parent / name).is_dir() and not _too_broad(folder.parent):
                return folder.parent / name
        return None

    def _installed(self, name: str) -> Iterator[tuple[str, Path | None]]:
        for variable in ("AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH"):
            for prefix in self._path_variable(variable):
                places = (prefix / "share" / name, prefix / name / "share" / name)
                found = next((place for place in places if place.is_dir()), None)
                yield f"{prefix} ({variable})", found

    def _path_variable(self, variable: str) -> list[Path]:
        text = self._environment.get(variable, "")
        return [Path(entry) for entry in text.split(os.pathsep) if entry]

    def _scan(self, folder: Path, budget: int) -> _Scan:
        if folder not in self._scans:
            self._scans[folder] = _Scan(folder, budget, self._scans)
        return self._scans[folder]


class _Scan:
    """The packages at and below one folder, nearest first.

    Attributes:
        packages: folders of the packages, by name.
        folders: each folder, by name.
        size: number of searched folders.
        has_more: whether more folders exist than the limit allows.
        left_out: description of the places not searched; empty without any.
    """

    def __init__(self, top: Path, budget: int, done: Mapping[Path, _Scan]) -> None:
        self.packages: dict[str, Path] = {}
        self.folders: dict[str, Path] = {}
        self.size = 0
        self.left_out = ""
        queue: deque[tuple[Path, int]] = deque([(top, 0)])
        while queue and self.size < budget:
            folder, depth = queue.popleft()
            if folder in done:
                self._take_over(done[folder])
                continue
            self.size += 1
            children = self._enter(folder)
            if depth < limits.SEARCHED_DEPTH.value:
                queue.extend((child, depth + 1) for child in children)
            elif children:
                most = limits.SEARCHED_DEPTH.value
                self.left_out = f"{_NOT_ALL} {top}: {most:,} folders deep at most"
        self.has_more = bool(queue)
        if queue:
            most = limits.SEARCHED_FOLDERS.value
            self.left_out = f"{_NOT_ALL} {top}: {most:,} folders at most"

    def _take_over(self, other: _Scan) -> None:
        self.left_out = self.left_out or other.left_out
        for name, path in other.packages.items():
            self.packages.setdefault(name, path)
        for name, path in other.folders.items():
            self.folders.setdefault(name, path)

    def _enter(self, folder: Path) -> list[Path]:
        try:
            with os.scandir(folder) as entries:
                found = sorted(entries, key=lambda entry: entry.name)
                names = {entry.name for entry in found}
                children = [Path(e.path) for e in found if _worth_entering(e)]
        except OSError:
            return []
        if names & IGNORE_MARKS or "pyvenv.cfg" in names:
            return []
        self.folders.setdefault(folder.name, folder)
        if not names.isdisjoint(MANIFESTS):
            name = package_name(folder)
            if name is not None:
                self.packages.setdefault(name, folder)
        return children


def _worth_entering(entry: os.DirEntry[str]) -> bool:
    if entry.name.startswith(".") or entry.name in _SKIPPED:
        return False
    return entry.is_dir(follow_symlinks=False) or (
        entry.is_symlink() and os.path.isfile(os.path.join(entry.path, "package.xml"))
    )


def _too_broad(folder: Path) -> bool:
    """Return whether a search below this folder would cover the whole machine."""
    return len(folder.parts) <= 2 or folder in (Path.home(), Path.home().parent)


def _workspace_root(folder: Path) -> bool:
    """Return whether the search ends here: a workspace, or a checkout outside one."""
    if (folder / "src").is_dir() and (
        (folder / "install").is_dir() or (folder / "build").is_dir()
    ):
        return True
    if folder.name == "src":
        return True
    in_workspace = any(parent.name == "src" for parent in folder.parents)
    return (folder / ".git").exists() and not in_workspace

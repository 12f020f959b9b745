"""The text files of a model's package: found once, read within limits."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from sambot_viz import limits
from sambot_viz.checks.rule import Subject
from sambot_viz.files import is_below, read_limited
from sambot_viz.robot.packages.package_index import PackageIndex, package_name

_SKIPPED = frozenset(
    {"build", "install", "log", "meshes", "node_modules", "test", "tests"}
)


@dataclass(frozen=True)
class PackageFiles:
    """The package that a model belongs to.

    Attributes:
        folder: the package, absolute.
        name: its name in package.xml.
        relative: paths are named as the user named the model: relative to the
            working folder, or absolute.
        trusted: False reads no file that a link leads out of the package.
        read: gets each file that is looked for.
    """

    folder: Path
    name: str
    relative: bool
    trusted: bool
    read: set[Path]

    @cached_property
    def paths(self) -> tuple[str, ...]:
        """All files, relative to the package with slashes; other packages left out."""
        return tuple(sorted(self._walk()))

    def _walk(self) -> Iterator[str]:
        folders, files = 0, 0
        for folder, inner, names in os.walk(self.folder):
            below = os.path.relpath(folder, self.folder).replace(os.sep, "/")
            folders += 1
            nested = below != "." and "package.xml" in names
            if (
                folders > limits.PACKAGE_FOLDERS.value
                or nested
                or below.count("/") >= limits.PACKAGE_DEPTH.value
            ):
                inner.clear()
            if nested:
                continue
            inner[:] = sorted(
                n for n in inner if n not in _SKIPPED and not n.startswith(".")
            )
            for name in names:
                files += 1
                if files <= limits.PACKAGE_FILES.value:
                    yield name if below == "." else f"{below}/{name}"

    def ending(self, *endings: str) -> list[str]:
        """Return the files with one of these endings, at most fifty."""
        return [path for path in self.paths if path.endswith(endings)][:50]

    @cached_property
    def _texts(self) -> dict[str, str | None]:
        return {}

    def text(self, path: str) -> str | None:
        """Return the text of a file, None when it cannot be read or is very large."""
        if path not in self._texts:
            self._texts[path] = self._read(path)
        return self._texts[path]

    def _read(self, path: str) -> str | None:
        file = self.folder / path
        self.read.add(file)
        if not self.trusted and not is_below(file, [self.folder.resolve()]):
            return None
        try:
            return read_limited(file, limits.PACKAGE_TEXT.value).decode("utf-8")
        except (OSError, ValueError):
            return None

    def shown(self, path: str) -> str:
        """Return a path as the user would write it."""
        file = str(self.folder / path)
        return os.path.relpath(file) if self.relative else file


def package_of(subject: Subject) -> PackageFiles | None:
    """Find the package of a robot that is checked; None when it is in none."""
    if not subject.files:
        return None
    model = Path(subject.files[0])
    folders = PackageIndex(model.absolute().parent).ancestors()
    for folder in folders:
        name = package_name(folder)
        if name is not None:
            trusted = subject.robot.file_roots is None
            subject.read.add(folder / "package.xml")
            return PackageFiles(
                folder, name, not model.is_absolute(), trusted, subject.read
            )
    return None

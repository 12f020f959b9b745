"""Inside the child: packages and files for xacro, without ROS."""

from __future__ import annotations

import glob
import os
import re
import sys
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

from sambot_viz.robot.packages.package_index import Lookup, PackageIndex
from sambot_viz.robot.packages.resolve import (
    inside_package,
    is_installed_as_is,
    other_letter_case,
)
from sambot_viz.robot.xacro.child.sandbox import Guard


class PackageNotFoundError(KeyError):
    """The error of ament_index_python, with the result of the look-up."""

    def __init__(self, lookup: Lookup) -> None:
        super().__init__(f"package '{lookup.name}' not found")
        self.missing_package = (lookup.name, lookup.searched, lookup.known)


class XacroFiles:
    """Replaces ament_index_python, and finds files that xacro does not find.

    Args:
        index: finds packages.
        guard: checks the paths of an untrusted model.
        warn: receives doubtful cases.
        named: receives the absolute name of every file that the model names.
    """

    def __init__(
        self,
        index: PackageIndex,
        guard: Guard | None,
        warn: Callable[[str], object],
        named: list[str],
    ) -> None:
        self._index = index
        self._guard = guard
        self._warn = warn
        self._named = named
        self._roots: list[Path] = []
        if guard is not None:
            # Without packages found by name: the names come from the model.
            guard.roots = index.own_roots()

    def install(self, xacro: Any) -> None:
        """Patch the imported xacro package."""
        original: Callable[[str], str] = xacro.abs_filename_spec

        def find(spec: str) -> str:
            path = self._find(spec, original, xacro)
            if not glob.has_magic(path):
                self._named.append(os.path.abspath(path))
            return path

        xacro.abs_filename_spec = find
        packages: Any = types.ModuleType("ament_index_python.packages")
        packages.get_package_share_directory = self._share_directory
        packages.PackageNotFoundError = PackageNotFoundError
        sys.modules["ament_index_python"] = types.ModuleType("ament_index_python")
        sys.modules["ament_index_python.packages"] = packages

    def _share_directory(self, name: str) -> str:
        lookup = self._index.find(name)
        if lookup.path is None:
            raise PackageNotFoundError(lookup)
        if lookup.path not in self._roots:
            self._roots.append(lookup.path)
        return str(lookup.path)

    def _find(self, spec: str, original: Callable[[str], str], xacro: Any) -> str:
        if self._guard is not None:
            self._guard.check_spec(spec)
        match = re.match(r"package://([^/]+)/(.*)", spec)
        if match:
            spec = os.path.join(self._share_directory(match[1]), match[2])
        path = original(spec)
        if self._guard is not None:
            self._guard.check_path(path)
        if glob.has_magic(path) or os.path.exists(path):
            return path
        path = self._elsewhere(Path(path), xacro.filestack) or path
        if self._guard is not None:
            # The replacement may be a link out of the folder.
            self._guard.check_path(path)
        return path

    def _elsewhere(self, path: Path, stack: list[str | None]) -> str | None:
        """Return the file in a source tree with another layout than the package.

        A file in the middle of its own inclusion is never returned, because it would
        include itself endlessly.
        """
        cased = other_letter_case(path)
        if cased is not None:
            self._warn(f"{path.name} was found as {cased.name}: letter case differs")
            return str(cased)
        open_files = {os.path.realpath(file) for file in stack if file}
        for root in self._roots:
            if path.is_relative_to(root):
                found = inside_package(root, path.relative_to(root), open_files)
                as_is = found is not None and is_installed_as_is(root, found)
                return None if found is None or as_is else str(found)
        return None

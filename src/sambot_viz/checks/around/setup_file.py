"""Read the package name, files and programs in a setup.py without running it."""

from __future__ import annotations

import ast
import glob
import os
import posixpath
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from sambot_viz import limits
from sambot_viz.cached import cached_property
from sambot_viz.checks.around.launching.python_calls import CALLS
from sambot_viz.checks.around.launching.python_parts import (
    Call,
    Listing,
    PythonValue,
    Table,
)
from sambot_viz.checks.around.launching.python_values import PythonValues, Texts
from sambot_viz.checks.around.launching.texts import LaunchTexts
from sambot_viz.checks.launch_files import (
    Import,
    call_name,
    imports_in,
    parse_python,
)
from sambot_viz.errors import Place

_ENTRY = re.compile(r"\s*([\w.-]+)\s*=\s*([\w.]+)\s*:\s*([\w.]+)\s*")
_WRITING = frozenset(
    "open call check_call check_output copy copy2 copytree generate_distutils_setup "
    "makedirs mkdir Popen run symlink system touch write write_text".split()
)
INDEX = "share/ament_index/resource_index/packages"
"""The installed folder of a package's mark."""
_GLOBS = ("glob", "iglob")


class DataFiles(NamedTuple):
    """An entry of data_files.

    Attributes:
        node: its expression.
        target: the installed folder below the prefix; None when uncertain.
        files: the files, relative to the package.
        paths: the expression of the files.
    """

    node: ast.expr
    target: str | None
    files: Texts
    paths: ast.expr | None

    @property
    def globs(self) -> Iterator[ast.Call]:
        """The calls of glob that find its files."""
        for node in ast.walk(self.paths) if self.paths is not None else ():
            if isinstance(node, ast.Call) and call_name(node.func) in _GLOBS:
                yield node


class EntryPoint(NamedTuple):
    """A program of console_scripts.

    Attributes:
        name: the program.
        module: its module, with dots.
        function: the function of the module.
        node: its expression.
    """

    name: str
    module: str
    function: str
    node: ast.expr


@dataclass(frozen=True)
class SetupFile:
    """A setup.py.

    Attributes:
        tree: the file, read as Python.
        shown: the path as the user would write it.
        folder: the package.
        trusted: False keeps the rules from looking at the disk.
    """

    tree: ast.Module
    shown: str
    folder: Path
    trusted: bool

    def place(self, node: ast.expr | None) -> Place:
        """Return the place of an expression; None means the call of setup( … )."""
        at = node or self.call
        if at is None:
            return Place(self.shown, 1)
        return Place(self.shown, at.lineno, at.col_offset + 1)

    @cached_property
    def values(self) -> PythonValues:
        """The texts and lists of the file."""
        globs = dict.fromkeys(_GLOBS, partial(_glob, self.folder))
        calls = {**CALLS, **(globs if self.trusted else {})}
        return PythonValues(self.tree, self.shown, calls)

    @cached_property
    def imports(self) -> tuple[Import, ...]:
        """The names that it imports."""
        return tuple(imports_in(self.tree))

    @cached_property
    def call(self) -> ast.Call | None:
        """The only call of setup; None when there are none or several."""
        calls = [
            node
            for node in ast.walk(self.tree)
            if isinstance(node, ast.Call) and call_name(node.func) == "setup"
        ]
        return calls[0] if len(calls) == 1 else None

    @cached_property
    def certain(self) -> bool:
        """True when all arguments of setup are known, and the file makes no files."""
        called = (
            call_name(n.func) for n in ast.walk(self.tree) if isinstance(n, ast.Call)
        )
        if self.call is None or not _WRITING.isdisjoint(called):
            return False
        return not self.call.args and all(k.arg for k in self.call.keywords)

    def given(self, name: str) -> ast.expr | None:
        """Return an argument of setup, or None."""
        keywords = self.call.keywords if self.call is not None else ()
        return next((k.value for k in keywords if k.arg == name), None)

    def share(self, package: str, below: str) -> str:
        """Write a folder of the share folder of a package as this file would."""
        tail = f"/{below}" if below else ""
        for step in self.tree.body:
            match step:
                case ast.Assign(targets=[ast.Name(id="package_name")], value=value):
                    if self.values.text(value) == package:
                        more = f" + '{tail}'" if tail else ""
                        return f"'share/' + package_name{more}"
                case _:
                    pass
        return f"'share/{package}{tail}'"

    def globbed(self, pattern: str) -> str | None:
        """Write a glob as this file can; None when it does not import it."""
        for each in self.imports:
            if each.module == "glob" and each.member in (None, "glob"):
                called = each.name if each.member else f"{each.name}.glob"
                return f"{called}('{pattern}')"
        return None

    @cached_property
    def data_files(self) -> tuple[DataFiles, ...]:
        """The entries of data_files that are pairs."""
        return tuple(self._data_files())

    def _data_files(self) -> Iterator[DataFiles]:
        for value, node in self.values.items(self.given("data_files")).items:
            if isinstance(value, Listing) and value.complete and len(value.items) == 2:
                (first, _), (files, paths) = value.items
                target = self.values.said(first)
                target = None if target is None else target.rstrip("/")
                yield DataFiles(node, target, self.values.listed(files), paths)

    @cached_property
    def not_files(self) -> tuple[tuple[DataFiles, ast.expr, str], ...]:
        """The paths in data_files that are not files: entry, expression and path."""
        listed = (
            (entry, node, path)
            for entry in (self.data_files if self.certain and self.trusted else ())
            for node, path in entry.files.items
        )
        return tuple(
            (entry, node, path)
            for entry, node, path in listed
            if path is not None
            and not posixpath.isabs(path)
            and ".." not in path.split("/")
            and not (self.folder / path).is_file()
        )

    @cached_property
    def installs_only_known(self) -> bool:
        """True when everything that data_files installs is known."""
        all_ = self.values.items(self.given("data_files"))
        pairs = self.data_files
        return (
            self.certain
            and not self.not_files
            and all_.complete
            and len(pairs) == len(all_.items)
            and all(p.target and p.files.known is not None for p in pairs)
        )

    @cached_property
    def scripts(self) -> Texts:
        """The items of console_scripts."""
        given = self.given("entry_points")
        table = self.values.of(given)
        for pair in table.pairs if isinstance(table, Table) else ():
            if pair.key == "console_scripts":
                return self.values.listed(_flat(pair.value))
        return Texts((), complete=given is None)

    @cached_property
    def programs(self) -> tuple[EntryPoint, ...]:
        """The known programs of console_scripts."""
        matches = (
            (node, _ENTRY.fullmatch(text))
            for node, text in self.scripts.items
            if text is not None
        )
        return tuple(EntryPoint(m[1], m[2], m[3], n) for n, m in matches if m)


def _flat(value: PythonValue) -> PythonValue:
    """Return a list with the items of lists in it, as setuptools reads programs."""
    if not isinstance(value, Listing):
        return value
    items: list[tuple[PythonValue, ast.expr]] = []
    complete = value.complete
    for item, node in value.items:
        inner = _flat(item)
        if isinstance(inner, Listing):
            items += inner.items
            complete &= inner.complete
        else:
            items.append((inner, node))
    return Listing(tuple(items), complete)


def read_setup(
    text: str, shown: str, folder: Path, *, trusted: bool
) -> SetupFile | None:
    """Read a setup.py; None when it is not Python."""
    tree = parse_python(text)
    return None if tree is None else SetupFile(tree, shown, folder, trusted)


def _glob(folder: Path, call: Call) -> PythonValue:
    """Return the files that a glob finds; None when uncertain."""
    pattern = LaunchTexts().text(call.text("pathname", 0, None))
    if pattern is None or os.path.isabs(pattern) or ".." in pattern.split("/"):
        return None
    deep = call.given("recursive") is not None
    found = glob.iglob(pattern, root_dir=folder, recursive=deep)
    most = limits.LAUNCH_VALUE.value
    try:
        paths = sorted(islice(found, most + 1))
    except OSError:
        return None
    slashed = (posixpath.normpath(path.replace(os.sep, "/")) for path in paths)
    listing = Listing(tuple((path, call.node) for path in slashed))
    return listing if len(paths) <= most else None

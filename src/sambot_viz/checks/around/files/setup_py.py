"""What a setup.py calls the package, installs and starts, found without running it."""

from __future__ import annotations

import ast
import posixpath
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from sambot_viz.checks.around.files.python_values import Items, PythonValues
from sambot_viz.checks.launch_files import call_name, parse_python
from sambot_viz.errors import Place

_ENTRY = re.compile(r"\s*([\w.-]+)\s*=\s*([\w.]+)\s*:\s*([\w.]+)\s*")
_WRITING = frozenset(
    "open call check_call check_output copy copy2 copytree generate_distutils_setup "
    "makedirs mkdir Popen run symlink system touch write write_text".split()
)


@dataclass(frozen=True, slots=True)
class DataFiles:
    """An entry of data_files.

    Attributes:
        node: its expression.
        target: where the files go, below the prefix; None when it is not certain.
        files: the files, relative to the package.
        paths: the expression of the files.
    """

    node: ast.expr
    target: str | None
    files: Items
    paths: ast.expr | None

    @property
    def globs(self) -> Iterator[ast.Call]:
        """The calls of glob that give its files."""
        for node in ast.walk(self.paths) if self.paths is not None else ():
            if isinstance(node, ast.Call) and call_name(node.func) in ("glob", "iglob"):
                yield node


@dataclass(frozen=True, slots=True)
class EntryPoint:
    """A program of console_scripts.

    Attributes:
        name: the program.
        module: its module, with dots.
        function: what is called in it.
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
        trusted: False does not look at the disk.
    """

    tree: ast.Module
    shown: str
    folder: Path
    trusted: bool

    def place(self, node: ast.expr | None) -> Place:
        """Return the place of an expression; None means that of setup( … )."""
        at = node or self.call
        if at is None:
            return Place(self.shown, 1)
        return Place(self.shown, at.lineno, at.col_offset + 1)

    @cached_property
    def values(self) -> PythonValues:
        """The texts and lists of the file."""
        return PythonValues(self.tree, self.folder if self.trusted else None)

    @cached_property
    def call(self) -> ast.Call | None:
        """The only call of setup; None when there is none, or more."""
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
        if self.values.variable("package_name") == package:
            return (
                f"'share/' + package_name + '{tail}'"
                if tail
                else ("'share/' + package_name")
            )
        return f"'share/{package}{tail}'"

    def globbed(self, pattern: str) -> str | None:
        """Write a glob as this file can; None when it does not import it."""
        for node in ast.walk(self.tree):
            if isinstance(node, ast.ImportFrom) and node.module == "glob":
                return f"glob('{pattern}')"
            if isinstance(node, ast.Import) and any(
                a.name == "glob" for a in node.names
            ):
                return f"glob.glob('{pattern}')"
        return None

    @cached_property
    def data_files(self) -> tuple[DataFiles, ...]:
        """The entries of data_files that are pairs."""
        return tuple(self._data_files())

    def _data_files(self) -> Iterator[DataFiles]:
        for node, value in self.values.items(self.given("data_files")).items:
            if isinstance(value, Items) and value.complete and len(value.items) == 2:
                (_, target), (paths, files) = value.items
                yield DataFiles(
                    node,
                    target.rstrip("/") if isinstance(target, str) else None,
                    files if isinstance(files, Items) else Items((), complete=False),
                    paths,
                )

    @cached_property
    def not_files(self) -> tuple[tuple[DataFiles, ast.expr, str], ...]:
        """What data_files lists and is no file: entry, expression and path."""
        listed = (
            (entry, node, path)
            for entry in (self.data_files if self.certain and self.trusted else ())
            for node, path in entry.files.items
        )
        return tuple(
            (entry, node, path)
            for entry, node, path in listed
            if isinstance(path, str)
            and not posixpath.isabs(path)
            and ".." not in path.split("/")
            and not (self.folder / path).is_file()
        )

    @cached_property
    def installs_only_known(self) -> bool:
        """True when all that data_files installs is known."""
        all_ = self.values.items(self.given("data_files"))
        pairs = self.data_files
        return (
            self.certain
            and not self.not_files
            and all_.complete
            and len(pairs) == len(all_.items)
            and all(p.target is not None and p.files.known for p in pairs)
        )

    @cached_property
    def scripts(self) -> Items:
        """The items of console_scripts."""
        table = self.given("entry_points")
        if isinstance(table, ast.Dict):
            for key, value in zip(table.keys, table.values, strict=True):
                if isinstance(key, ast.Constant) and key.value == "console_scripts":
                    return self.values.items(value)
        return Items((), complete=table is None)

    @cached_property
    def programs(self) -> tuple[EntryPoint, ...]:
        """The programs of console_scripts that are known."""
        matches = (
            (node, _ENTRY.fullmatch(text))
            for node, text in self.scripts.items
            if isinstance(text, str)
        )
        return tuple(EntryPoint(m[1], m[2], m[3], n) for n, m in matches if m)


def read_setup(
    text: str, shown: str, folder: Path, *, trusted: bool
) -> SetupFile | None:
    """Read a setup.py; None when it is not Python."""
    tree = parse_python(text)
    return None if tree is None else SetupFile(tree, shown, folder, trusted)

"""Read Python files without running them."""

from __future__ import annotations

import ast
import warnings
from collections.abc import Iterator
from typing import NamedTuple


def parse_python(text: str | bytes) -> ast.Module | None:
    """Read Python without running it; None for other text."""
    try:
        with warnings.catch_warnings():
            # Python warns of odd escapes in the file, on the terminal of the user.
            warnings.simplefilter("ignore")
            return ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def compile_error(tree: ast.Module, name: str) -> SyntaxError | None:
    """Return what keeps Python from compiling a file that it can read.

    Args:
        tree: the file; nothing of it runs.
        name: of the file.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            compile(tree, name, "exec", dont_inherit=True)
    except SyntaxError as error:
        return error
    except (ValueError, RecursionError, MemoryError):
        return None
    return None


class Import(NamedTuple):
    """A name that a file imports.

    Attributes:
        name: the name in the file; "*" for all of a module.
        module: where it comes from, with dots.
        member: what it is in the module; None for the module itself.
        step: the statement.
    """

    name: str
    module: str
    member: str | None
    step: ast.Import | ast.ImportFrom


def imports_in(tree: ast.AST) -> Iterator[Import]:
    """Yield what some Python imports."""
    for node in ast.walk(tree):
        yield from imported_by(node)


def imported_by(step: ast.AST) -> Iterator[Import]:
    """Yield what a statement imports; nothing for one that is no import."""
    if isinstance(step, ast.Import):
        for each in step.names:
            name = each.asname or each.name.partition(".")[0]
            yield Import(name, each.name, None, step)
    elif isinstance(step, ast.ImportFrom):
        for each in step.names:
            name, module = each.asname or each.name, step.module or ""
            yield Import(name, module, each.name, step)


def call_name(function: ast.expr) -> str:
    """Return the name of the called object: "Node" in ``actions.Node(…)``."""
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""

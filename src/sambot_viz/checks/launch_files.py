"""Read Python files without running them."""

from __future__ import annotations

import ast
import warnings


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


def call_name(function: ast.expr) -> str:
    """Return the name of the called object: "Node" in ``actions.Node(…)``."""
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""

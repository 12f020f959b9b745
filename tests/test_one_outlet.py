"""Only the outlet writes to a terminal or a log."""

from __future__ import annotations

import ast
from collections.abc import Collection, Mapping
from pathlib import Path

import pytest

WRITERS: Mapping[str, Collection[str]] = {
    "sys": {"stdout", "stderr", "__stdout__", "__stderr__"},
    "logging": {
        "basicConfig", "getLogger", "StreamHandler", "FileHandler", "lastResort",
        "error", "warning", "exception", "info", "debug", "critical", "log",
    },
    "warnings": {"warn", "warn_explicit", "showwarning"},
    "traceback": {
        "print_exc", "print_exception", "print_last", "print_stack", "print_tb",
    },
    "rich": {"print", "inspect", "console"},
    "os": {"write"},
    "contextlib": {"redirect_stdout", "redirect_stderr"},
    "pprint": {"pprint", "pp"},
    "faulthandler": {"enable", "dump_traceback"},
}  # fmt: skip
"""Module → what of it writes to a terminal or a log."""
ALLOWED = {
    # Which records of other libraries there are at all, and that viser prints none.
    "viser_private/connections.py": {"logging.getLogger", "rich.print"},
    # To pipes of children, and from one to its parent.
    "robot/child_process.py": {"os.write"},
    "robot/fork_server.py": {"os.write"},
    "robot/xacro/child/forks.py": {"os.write"},
}


def writers(tree: ast.AST) -> set[str]:
    """What a module uses of `WRITERS`, however it is imported, and `print`."""
    names = {
        alias.asname or alias.name: alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.Import)
        for alias in node.names
    }
    found: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and node.id in ("print", "input", "breakpoint"):
            found.add(node.id)
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            module = names.get(node.value.id, "")
            if node.attr in WRITERS.get(module, ()):
                found.add(f"{module}.{node.attr}")
        elif isinstance(node, ast.ImportFrom) and node.module is not None:
            package = node.module.partition(".")[0]
            found |= {
                f"{package}.{alias.name}"
                for alias in node.names
                if alias.name in WRITERS.get(package, ())
                or node.module in ("rich.console", "logging.handlers", "rich.logging")
            }
    return found


def test_no_module_but_the_outlet_writes_to_a_terminal(repository: Path) -> None:
    root = repository / "src" / "sambot_viz"
    found = {
        path.relative_to(root).as_posix(): used
        for path in root.rglob("*.py")
        if (used := writers(ast.parse(path.read_text("utf-8"))))
    }
    assert found.pop("outlet.py")
    assert found == ALLOWED


@pytest.mark.parametrize(
    "code",
    [
        "print(1)",
        "f = print",
        "import sys as s\ns.stderr.write('')",
        "from sys import stdout",
        "import logging\nlogging.getLogger()",
        "from rich.console import Console",
        "import warnings\nwarnings.warn('')",
        "from traceback import print_exc",
    ],
)
def test_a_writer_is_found_however_it_is_called(code: str) -> None:
    assert writers(ast.parse(code))

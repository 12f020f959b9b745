"""The packages that pyproject.toml declares are those that the code imports."""

from __future__ import annotations

import ast
import re
import sys
from collections import ChainMap
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path

from sambot_viz import extras


def declared(repository: Path) -> dict[str, str]:
    return listed(repository, "dependencies")


def listed(repository: Path, name: str) -> dict[str, str]:
    """Distribution → the comment on its line: why it is needed."""
    text = (repository / "pyproject.toml").read_text("utf-8")
    block = text.partition(f"\n{name} = [\n")[2].partition("\n]")[0]
    lines = [
        re.match(r'\s*"([\w.-]+)[^"]*",\s*(?:#\s*(.*))?', x) for x in block.split("\n")
    ]
    assert all(lines), block
    return {line[1]: line[2] or "" for line in lines if line}


def imported(repository: Path) -> set[str]:
    """The distributions that the code imports when it runs."""
    homes = metadata.packages_distributions()
    names = {
        name
        for path in (repository / "src").rglob("*.py")
        for name in imports(ast.parse(path.read_text("utf-8")))
    }
    others = names - set(sys.stdlib_module_names) - {"sambot_viz"}
    # Python 3.10 does not know of packages that only list their files.
    return {homes.get(name, [name])[0].lower() for name in others}


def imports(node: ast.AST) -> Iterator[str]:
    """The top packages that a file imports, those for type checkers left out."""
    if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
        return
    if isinstance(node, ast.Import):
        yield from (alias.name.partition(".")[0] for alias in node.names)
    elif isinstance(node, ast.ImportFrom) and node.module:
        yield node.module.partition(".")[0]
    elif isinstance(node, ast.Call) and "import_module" in ast.dump(node.func):
        if isinstance(node.args[0], ast.Constant):
            yield str(node.args[0].value).partition(".")[0]
    for child in ast.iter_child_nodes(node):
        yield from imports(child)


def test_what_is_imported_is_declared_and_the_other_way_round(
    repository: Path,
) -> None:
    wanted = {name.lower() for name in declared(repository)}
    optional = (listed(repository, name) for name in ("zenoh", "dds", "metrics"))
    found = {name.replace("_", "-") for name in imported(repository)}
    assert {n.replace("_", "-") for n in wanted.union(*optional)} == found


def test_the_packages_of_the_extras_are_those_that_are_advised(
    repository: Path,
) -> None:
    text = (repository / "pyproject.toml").read_text("utf-8")
    table = text.partition("[project.optional-dependencies]")[2].partition("\n[p")[0]
    blocks = re.findall(r"^(\w+) = \[\n(.*?)^\]", table, re.MULTILINE | re.DOTALL)
    written = {name: tuple(re.findall(r'"([^"]+)"', block)) for name, block in blocks}
    assert dict(extras.PACKAGES) == written
    command = extras.installation("zenoh")
    assert command == 'pip install "eclipse-zenoh>=1.10,<2"'


def test_every_declared_package_has_a_reason(repository: Path) -> None:
    # What is for Jupyter is not imported: it starts this program.
    extra = ("jupyter", "zenoh", "dds", "metrics")
    optional = (listed(repository, name) for name in extra)
    named = {**declared(repository), **ChainMap(*optional)}
    assert [name for name, why in named.items() if not why] == []
    assert "jupyter-server-proxy" in named

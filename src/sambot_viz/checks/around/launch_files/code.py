"""Find what stops ``ros2 launch`` in a launch file that Python can read."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.checks.around.launch_files.imports import modules
from sambot_viz.checks.around.launch_files.names import PREDEFINED, bound_names
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.place import rewritten
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name
from sambot_viz.edits import write, write_between
from sambot_viz.errors import Fix, Place, Problem, nearest

if TYPE_CHECKING:
    from sambot_viz.checks.around.setup_file import SetupFile

_ENTRY = "generate_launch_description"
_DESCRIPTION = "LaunchDescription"
_CODE = "launch-code"
_LIKENESS = 0.8

_IN_SETUP = {"glob": "glob", "setup": "setuptools", "find_packages": "setuptools"}
_NEVER_CALLED = (ast.Tuple, ast.List, ast.Dict, ast.Constant, ast.JoinedStr)
_MODULES = frozenset({"launch", "launch_ros", "os", "sys", "xacro"})


def empty_launch_files(around: Surroundings) -> Iterator[Problem]:
    """Report launch files without content: often nobody starts them yet."""
    for package in around.packages:
        for path in package.ending("launch.py"):
            text = package.text(path)
            if text is not None and not text.strip():
                yield Problem.at(
                    Place(package.shown(path), 1),
                    "warning",
                    _CODE,
                    f"this launch file is empty: ros2 launch stops with it, because it "
                    f"looks for {_ENTRY}",
                    "delete the file, or write that function into it",
                )


def missing_entries(around: Surroundings) -> Iterator[Problem]:
    """Report a misspelt generate_launch_description, and one that returns nothing."""
    for launch in around.launches:
        functions = [n for n in launch.tree.body if isinstance(n, ast.FunctionDef)]
        entry = next((f for f in functions if f.name == _ENTRY), None)
        if _is_module(launch):
            continue
        if entry is not None:
            lost = any(isinstance(node, ast.Return) for node in launch.tree.body)
            if not lost and not _returns(entry):
                yield _without_return(entry, launch)
        elif not _is_bound(_ENTRY, launch.tree):
            near = nearest(_ENTRY, (f.name for f in functions), _LIKENESS)
            builders = [f.name for f in functions if _describes(f)]
            near = near or (builders[0] if len(builders) == 1 else None)
            for function in functions:
                if function.name == near:
                    yield Problem.at(
                        Place(launch.shown, function.lineno, function.col_offset + 5),
                        "error",
                        _CODE,
                        f"ros2 launch looks for the function {_ENTRY}, but this one "
                        f"is called {near}: it stops with an error",
                        write(
                            Place(
                                launch.shown, function.lineno, function.col_offset + 1
                            ),
                            function.name,
                            _ENTRY,
                        ),
                    )


def _is_module(launch: LaunchFile) -> bool:
    """Return whether a file is a module of a Python package, for others to import."""
    folder = Path(launch.shown).parent
    return folder.name != "launch" and (folder / "__init__.py").exists()


def _describes(function: ast.FunctionDef) -> bool:
    """Return whether a function returns a LaunchDescription that it builds."""
    return any(
        isinstance(node, ast.Return)
        and isinstance(node.value, ast.Call)
        and call_name(node.value.func) == _DESCRIPTION
        for node in function.body
    )


def _returns(function: ast.FunctionDef) -> bool:
    """Return whether a function may return a value, or never ends regularly."""
    inner: list[ast.AST] = list(function.body)
    while inner:
        node = inner.pop()
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            continue
        if isinstance(node, (ast.Raise, ast.Yield, ast.YieldFrom)):
            return True
        if isinstance(node, ast.Return) and node.value is not None:
            return True
        inner += ast.iter_child_nodes(node)
    return False


def _without_return(function: ast.FunctionDef, launch: LaunchFile) -> Problem:
    """Report a missing return at the lost description, or at the function."""
    place = Place(launch.shown, function.lineno, function.col_offset + 1)
    hint: str | Fix = f"end it with return {_DESCRIPTION}([…])"
    for node in function.body:
        value = node.value if isinstance(node, (ast.Expr, ast.Assign)) else None
        if not isinstance(value, ast.Call) or call_name(value.func) != _DESCRIPTION:
            continue
        if isinstance(node, ast.Expr):
            place = launch.place(value)
            hint = write(
                place,
                _DESCRIPTION,
                f"return {_DESCRIPTION}",
                hint=f"write return {_DESCRIPTION}(",
            )
        elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            hint = f"add return {node.targets[0].id} at its end"
    return Problem.at(
        place,
        "error",
        _CODE,
        f"{_ENTRY} (line {function.lineno}) returns nothing, so ros2 launch has "
        "nothing to start",
        hint,
    )


def unknown_names(around: Surroundings) -> Iterator[Problem]:
    """Report used names that the file neither imports nor defines."""
    for file in python_files(around):
        undefined = undefined_names(file.tree)
        bound = bound_names(file.tree) if undefined else set[str]()
        advised: set[str] = set()
        for name, node in undefined.items():
            code, stops = stopped(file)
            fix = _advice(name, bound, code, file, node, tuple(undefined))
            if fix.hint in advised and "import" in fix.hint and fix.edits:
                continue
            advised.add(fix.hint)
            yield Problem.at(
                file.place(node),
                "error",
                code,
                f"{name} is used here, but it is neither imported nor defined: {stops} "
                "stops with it",
                fix,
            )


def missing_commas(around: Surroundings) -> Iterator[Problem]:
    """Report two items of a list without a comma: Python reads them as a call."""
    for file in python_files(around):
        for node in ast.walk(file.tree):
            item = node.func if isinstance(node, ast.Call) else None
            item = node.value if isinstance(node, ast.Subscript) else item
            if isinstance(item, ast.Constant) and item.value in modules():
                code, stops = stopped(file)
                yield Problem.at(
                    file.place(item),
                    "error",
                    code,
                    f"{item.value} is in quotation marks, and a text cannot be called: "
                    f"{stops} stops with it",
                    rewritten(item, file.shown, str(item.value)),
                )
            elif isinstance(item, _NEVER_CALLED):
                code, stops = stopped(file)
                end = Place(file.shown, item.end_lineno or item.lineno)
                second = "(" if isinstance(node, ast.Call) else "["
                yield Problem.at(
                    end,
                    "error",
                    code,
                    "a comma is missing at the end of this line: Python takes the "
                    f"{second} after it for a call of what is before it; {stops} stops "
                    "with it"
                    if second == "("
                    else "a comma is missing at the end of this line: Python takes "
                    f"the [ after it for an index; {stops} stops with it",
                    _comma(item, file),
                )


def _comma(item: ast.expr, file: LaunchFile | SetupFile) -> Fix:
    end = Place(file.shown, item.end_lineno or 1, (item.end_col_offset or 0) + 1)
    return write_between(end, end, ",", "add a comma there")


def python_files(around: Surroundings) -> Iterator[LaunchFile | SetupFile]:
    """Yield the launch files and the setup.py of each package."""
    for package in around.packages:
        yield from package.launches
        if package.setup is not None:
            yield package.setup


def stopped(file: LaunchFile | SetupFile) -> tuple[str, str]:
    """Return the code of a finding, and the program that stops."""
    if isinstance(file, LaunchFile):
        return _CODE, "ros2 launch"
    return "setup-py-code", "colcon build"


def undefined_names(tree: ast.Module) -> dict[str, ast.Name]:
    """Return the names without a value, each with its first use."""
    bound = bound_names(tree)
    found: dict[str, ast.Name] = {}
    for node in ast.walk(tree) if "*" not in bound else ():
        if isinstance(node, ast.Name) and node.id not in bound:
            first = found.setdefault(node.id, node)
            if node.lineno < first.lineno:
                found[node.id] = node
    return found


def _advice(
    name: str,
    bound: set[str],
    code: str,
    file: LaunchFile | SetupFile,
    node: ast.Name,
    undefined: Sequence[str],
) -> Fix:
    own = bound - PREDEFINED
    known = {**modules(), **(_IN_SETUP if code != _CODE else {})}
    module = known.get(name)
    if module is not None:
        names = sorted(other for other in undefined if known.get(other) == module)
        return _imported(f"from {module} import {', '.join(names)}", file)
    has_members = any(
        isinstance(n, ast.Attribute)
        and isinstance(n.value, ast.Name)
        and n.value.id == name
        for n in ast.walk(file.tree)
    )
    if name in _MODULES and (has_members or name not in _texts(file.tree)):
        return _imported(f"import {name}", file)
    near = nearest(name, sorted(own), 0.7) or nearest(name, known, 0.85)
    if name in _texts(file.tree):
        # Another place has it in quotation marks: it names an argument, package or
        # node.
        return rewritten(node, file.shown, f"'{name}'")
    every = [n for n in ast.walk(file.tree) if isinstance(n, ast.Name)]
    stored = [n for n in every if n.id == near]
    often = sum(n.id == name for n in every) > 1
    if often and near is not None and [type(n.ctx) for n in stored] == [ast.Store]:
        # Other lines read the undefined name too, and no line reads this one.
        return write(file.place(stored[0]), near, name, f" in line {stored[0].lineno}")
    if near in own:
        return write(file.place(node), name, near)
    if near is not None:
        return Fix(f"write {near}")
    return Fix("import it at the top of the file, or define it above this line")


def _texts(tree: ast.Module) -> set[str]:
    nodes = (n for n in ast.walk(tree) if isinstance(n, ast.Constant))
    return {n.value for n in nodes if isinstance(n.value, str)}


def _imported(line: str, file: LaunchFile | SetupFile) -> Fix:
    """Return the fix that adds an import before the others."""
    hint = f"add {line} at the top of the file"
    for step in file.tree.body:
        future = isinstance(step, ast.ImportFrom) and step.module == "__future__"
        if isinstance(step, (ast.Import, ast.ImportFrom)) and not future:
            begin = Place(file.shown, step.lineno, 1)
            return write_between(begin, begin, f"{line}\n", hint)
    for step in file.tree.body:
        if not (isinstance(step, ast.Expr) and isinstance(step.value, ast.Constant)):
            begin = Place(file.shown, step.lineno, 1)
            return write_between(begin, begin, f"{line}\n\n", hint)
    return Fix(hint)


def _is_bound(name: str, tree: ast.Module) -> bool:
    return not {name, "*"}.isdisjoint(bound_names(tree))

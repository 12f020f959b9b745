"""Report files and programs in setup.py that the package does not have."""

from __future__ import annotations

import ast
import posixpath
from collections.abc import Iterator
from fnmatch import fnmatchcase

from sambot_viz.checks.around.launch_files.names import PREDEFINED, bound_names
from sambot_viz.checks.around.misspelt import is_misspelt
from sambot_viz.checks.around.place import rewritten, where
from sambot_viz.checks.around.setup_file import (
    INDEX,
    DataFiles,
    EntryPoint,
    SetupFile,
)
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name, parse_python
from sambot_viz.edits import source_of, write, write_between
from sambot_viz.errors import Fix, Place, Problem, nearest

_MARK = "__init__.py"
"""The file that makes a folder a Python package."""
_ADD = "add "


def missing_data_files(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report files and folders in data_files that setup.py cannot copy."""
    for entry, node, path in setup.not_files:
        is_folder = (around.files.folder / path).is_dir()
        what = "is a folder" if is_folder else "does not exist"
        yield Problem.at(
            setup.place(node),
            "error",
            "setup-file-missing",
            f"data_files lists {path}, which {what}: colcon build stops",
            _of_folder(path, node, setup, around)
            if is_folder
            else _instead(path, entry, around),
        )


def missing_marks(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report data_files without the mark by which ROS finds the package."""
    name, given = around.files.name, setup.given("data_files")
    if given is None or not setup.installs_only_known:
        return
    installed = {
        f"{entry.target}/{posixpath.basename(path or '')}"
        for entry in setup.data_files
        for _, path in entry.files.items
    }
    share = setup.share(name, "")
    for mark, line in (
        (f"{INDEX}/{name}", f"('{INDEX}', ['resource/{name}'])"),
        (f"share/{name}/package.xml", f"({share}, ['package.xml'])"),
    ):
        if mark in installed or around.cmake is not None:
            continue
        other = _elsewhere(mark, setup)
        if other is not None:
            yield other
            continue
        place, hint = setup.place(given), f"add {line} to data_files"
        begin = Place(place.file, place.line, (place.column or 1) + 1)
        listed_here = (
            isinstance(given, ast.List)
            and (around.files.folder / f"resource/{name}").is_file()
        )
        yield Problem.at(
            place,
            "warning",
            "setup-file-missing",
            f"data_files has no {mark}, by which ROS finds the package: colcon adds it "
            "with a warning, and later versions do not",
            write_between(begin, begin, f"\n        {line},", hint)
            if listed_here
            else hint,
        )


def _elsewhere(mark: str, setup: SetupFile) -> Problem | None:
    """Report the one entry that installs the file of a mark to another folder."""
    right, name = posixpath.split(mark)
    entries = [
        (entry, path)
        for entry in setup.data_files
        for _, path in entry.files.items
        if posixpath.basename(path or "") == name and entry.target
    ]
    if len(entries) != 1 or nearest(entries[0][0].target or "", [right], 0.8) is None:
        return None
    entry, path = entries[0]
    folder = entry.node.elts[0] if isinstance(entry.node, ast.Tuple) else entry.node
    return Problem.at(
        setup.place(folder),
        "warning",
        "setup-file-missing",
        f"{path} is installed to {entry.target}, but ROS finds the package by {mark}",
        _at_right_place(folder, entry.target or "", right, setup),
    )


def _at_right_place(folder: ast.expr, wrong: str, right: str, setup: SetupFile) -> Fix:
    """Return the fix that writes another folder, or the slash that it lacks."""
    hint = f"write {right}"
    match folder:
        case ast.Constant():
            return rewritten(folder, setup.shown, f"'{right}'", hint)
        case ast.BinOp(left=ast.Constant(value=str(first)) as left) if (
            f"{first}/{wrong.removeprefix(first)}" == right
        ):
            return rewritten(left, setup.shown, f"'{first}/'")
        case _:
            return Fix(hint)


def unfound_modules(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report find_packages() that does not find the package of a program."""
    call = setup.given("packages")
    is_search = isinstance(call, ast.Call) and call_name(call.func) == "find_packages"
    if not is_search or not setup.certain or setup.given("package_dir") is not None:
        return
    search = next((c for c in setup.values.calls if c.node is call), None)
    for program in setup.programs if search is not None else ():
        top = program.module.partition(".")[0]
        if search is None or not (around.files.folder / top / _MARK).is_file():
            continue
        folder = search.given("where", 0)
        said = setup.values.text(folder)
        left_out = _patterns(setup, search.given("exclude", 1))
        only = _patterns(setup, search.given("include", 2)) or ("*",)
        if folder is not None and said and said.strip("./"):
            cause = f"looks in {said}, but {top} is beside setup.py"
            fix = _without(folder, setup)
        elif any(fnmatchcase(top, pattern) for pattern in left_out):
            cause = f"leaves out {top}"
            fix = Fix(f"take {top} out of exclude")
        elif not any(fnmatchcase(top, pattern) for pattern in only):
            cause = f"includes only {', '.join(only)}"
            fix = Fix(f"write {top} into include")
        else:
            continue
        yield Problem.at(
            setup.place(call),
            "error",
            "entry-point-missing",
            f"find_packages() {cause}: {top} is not installed, and ros2 run stops with "
            f"{program.name}",
            fix,
        )
        return


def _patterns(setup: SetupFile, node: ast.expr | None) -> tuple[str, ...]:
    return tuple(setup.values.texts(node)) if node is not None else ()


def _without(node: ast.expr, setup: SetupFile) -> Fix:
    """Return the fix that deletes an argument and the comma behind it."""
    hint = f"delete {ast.unparse(node)} there"
    source = source_of(setup.shown)
    if source is None or node.end_lineno != node.lineno:
        return Fix(hint)
    line = source.text.split("\n")[node.lineno - 1]
    before = line[: node.col_offset]
    begin = len(before) - len("where=") if before.endswith("where=") else len(before)
    behind = line[node.end_col_offset or 0 :]
    end = (node.end_col_offset or 0) + len(behind) - len(behind.lstrip(", "))
    at, to = (Place(setup.shown, node.lineno, n + 1) for n in (begin, end))
    return write_between(at, to, "", hint)


def _of_folder(
    path: str, node: ast.expr, setup: SetupFile, around: Surroundings
) -> str | Fix:
    found = [p for e in setup.data_files for n, p in e.files.items if n is node]
    if node in [g for entry in setup.data_files for g in entry.globs]:
        folder = path if found == [path] else posixpath.dirname(path)
        beside = [p for p in around.files.paths if posixpath.dirname(p) == folder]
        endings = {posixpath.splitext(p)[1] for p in beside}
        nested = any(
            posixpath.dirname(p).startswith(f"{path}/") for p in around.files.paths
        )
        if len(endings) == 1 or (beside and folder == path and not nested):
            ending = endings.pop() if len(endings) == 1 else ""
            right = setup.globbed(f"{folder}/*{ending}")
            if right is not None:
                return rewritten(node, setup.shown, right)
    below = f"('share/{around.files.name}/{path}', {setup.globbed(f'{path}/*')})"
    return f"list the files in it, with an entry of their own such as {below}"


def _instead(path: str, entry: DataFiles, around: Surroundings) -> str:
    folder = posixpath.dirname(path)
    beside = [p for p in around.files.paths if posixpath.dirname(p) == folder]
    if entry.target == INDEX and path == f"resource/{around.files.name}":
        if len(beside) == 1:
            return f"rename {beside[0]} to {path}"
        return f"make an empty file {path}"
    near = nearest(path, beside) or nearest(path, around.files.paths, 0.8)
    return f"write {near}" if near else f"delete {path} here, or make that file"


def joined_scripts(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report two programs of console_scripts that are one text."""
    for node, text in setup.scripts.items:
        if text is not None and text.count("=") > 1:
            second = node.end_lineno if node.end_lineno != node.lineno else None
            yield Problem.at(
                setup.place(node),
                "error",
                "setup-py-code",
                f"two programs of console_scripts are one text, {text}, because a "
                "comma is missing between them: colcon build stops",
                f"add a comma before line {second}" if second else "add the comma",
            )


def missing_entry_points(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report programs of console_scripts whose module or function does not exist."""
    if not setup.certain or setup.given("package_dir") is not None:
        return
    advised: set[str] = set()
    for program in setup.programs:
        fault = _fault(program, setup, around)
        if fault is not None and fault[1] not in advised:
            cause, hint = fault
            advised.add(hint)
            said = f"{program.module}:{program.function}"
            start = f"write {program.name} = "
            place = setup.place(program.node)
            right = hint.removeprefix(start)
            fix = write(place, said, right, hint=hint) if right != hint else Fix(hint)
            if hint.startswith(_ADD):
                fix = _listed(hint, setup, around)
            yield Problem.at(
                place,
                "error",
                "entry-point-missing",
                f"the program {program.name} is {said}, but {cause}: ros2 run stops "
                "with it",
                fix,
            )


def _fault(
    program: EntryPoint, setup: SetupFile, around: Surroundings
) -> tuple[str, str] | None:
    """Return the fault of a program, and what to write."""
    path = program.module.replace(".", "/")
    files = (f"{path}.py", f"{path}/__init__.py")
    file = next((f for f in files if (around.files.folder / f).is_file()), None)
    if file is None:
        return _no_module(program, path, around)
    packages = setup.values.listed(setup.values.of(setup.given("packages"))).known
    folder = posixpath.dirname(path)
    if (
        folder
        and _is_found(setup)
        and not (around.files.folder / folder / _MARK).is_file()
    ):
        at = where(setup.place(setup.given("packages")), setup.shown)
        return (
            f"{folder} has no {_MARK}, without which find_packages() ({at}) does not "
            "find it, so it is not installed",
            f"make an empty file {folder}/{_MARK}",
        )
    above = folder.replace("/", ".")
    if packages is not None and above and above not in packages:
        at = where(setup.place(setup.given("packages")), setup.shown)
        return (
            f"packages ({at}) does not list {above}, so it is not installed",
            f"{_ADD}'{above}' to packages",
        )
    return _no_function(program, file, around)


def _listed(hint: str, setup: SetupFile, around: Surroundings) -> Fix:
    """Return the fix that lists a package, and none without a folder."""
    node = setup.given("packages")
    if not isinstance(node, ast.List) or node.lineno != node.end_lineno:
        return Fix(hint)
    texts = [(item, setup.values.text(item)) for item in node.elts]
    kept = [
        ast.unparse(item)
        for item, text in texts
        if text is None or (around.files.folder / text.replace(".", "/")).is_dir()
    ]
    added = hint.removeprefix(_ADD).removesuffix(" to packages")
    hint = hint if len(kept) == len(texts) else ""
    return rewritten(node, setup.shown, f"[{', '.join([*kept, added])}]", hint)


def _is_found(setup: SetupFile) -> bool:
    """Return whether find_packages() looks for the packages in all folders."""
    match setup.given("packages"):
        case ast.Call(func=func, args=[], keywords=keywords):
            named = {keyword.arg for keyword in keywords}
            return call_name(func) == "find_packages" and named <= {"exclude"}
        case _:
            return False


def _no_module(
    program: EntryPoint, path: str, around: Surroundings
) -> tuple[str, str] | None:
    has, own = around.files.folder, around.files.name
    folder, top = posixpath.dirname(path), path.partition("/")[0]
    if not (has / top).is_dir() and not (has / f"{top}.py").is_file():
        inside = path.replace(top, own, 1) if "/" in path else f"{own}/{path}"
        named = f"depend>{top}<" in (around.files.text("package.xml") or "")
        if named or not (has / f"{inside}.py").is_file():
            return None
        better = f"{inside.replace('/', '.')}:{program.function}"
        what = f"folder {top}" if "/" in path else f"{top}.py beside setup.py"
        return f"the package has no {what}", f"write {program.name} = {better}"
    if not folder or not (has / folder).is_dir():
        return None
    files = [p for p in around.files.paths if posixpath.dirname(p) == folder]
    modules = {
        f"{p.removesuffix('.py').replace('/', '.')}": p
        for p in files
        if p.endswith(".py") and not p.endswith("__.py")
    }
    near = nearest(program.module, modules)
    if near is None or not is_misspelt(program.module, near):
        return f"there is no {path}.py", f"make that file, or delete {program.name}"
    return (
        f"there is no {path}.py; there is {modules[near]}",
        f"write {program.name} = {near}:{program.function}",
    )


def _no_function(
    program: EntryPoint, file: str, around: Surroundings
) -> tuple[str, str] | None:
    tree = parse_python(around.files.text(file) or "")
    first = program.function.partition(".")[0]
    names = bound_names(tree) if tree is not None else {"*"}
    if not {first, "*"}.isdisjoint(names):
        return None
    own = sorted(name for name in names - PREDEFINED if name[:2] != "__")
    near = nearest(first, own, 0.7) or ("main" if "main" in names else None)
    if near is None:
        return f"{file} has no {first}", f"define {first}() in {file}"
    return (
        f"{file} has no {first}; it has {near}",
        f"write {program.name} = {program.module}:{near}",
    )

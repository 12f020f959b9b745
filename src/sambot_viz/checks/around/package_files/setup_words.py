"""Report words and forms in setup.py that setuptools ignores, or that stop it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import partial

from sambot_viz.checks.around.launching.python_parts import Listing, Table
from sambot_viz.checks.around.place import rewritten
from sambot_viz.checks.around.setup_file import INDEX, SetupFile
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.words import WordKind, WrittenWord, misspelt
from sambot_viz.edits import write, write_between
from sambot_viz.errors import Fix, Place, Problem

_CODE = "setup-py-code"
_UNREAD = WordKind(
    "setup_py",
    _CODE,
    "{owner} has no {wrong}, but {right}: what is given here is not read",
    "warning",
)
_NEEDED = WordKind(
    "setup_py",
    _CODE,
    "{owner} has {wrong}, which is no package of Python, but {right} is",
    "warning",
)
_NEARLY = re.compile(
    r"\s*(?:(?P<name>[\w.-]+)(?:\s*(?P<sign>=)\s*|\s*:\s*(?=[\w./]+\s*:)|\s+))?"
    r"(?P<path>[\w./]+)(?:\s*:\s*(?P<function>\w+))?\s*"
)


def misspelt_arguments(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report arguments of setup, and kinds of entry points, that nothing reads."""
    call = setup.call
    if call is None:
        return
    given = {k.arg for k in call.keywords if k.arg}
    words = [
        WrittenWord(
            "setup", argument.arg, given, place, partial(write, place, argument.arg)
        )
        for argument in call.keywords
        if argument.arg
        for place in [Place(setup.shown, argument.lineno, argument.col_offset + 1)]
    ]
    table = setup.values.of(setup.given("entry_points"))
    pairs = table.pairs if isinstance(table, Table) else ()
    kinds = {pair.key: setup.place(pair.key_node) for pair in pairs}
    names = {kind: place for kind, place in kinds.items() if isinstance(kind, str)}
    words += [
        WrittenWord("entry_points", kind, names, place, partial(write, place, kind))
        for kind, place in names.items()
    ]
    yield from misspelt(words, _UNREAD)
    needed = [
        WrittenWord(argument, text, (), place, partial(write, place, text))
        for argument in ("install_requires", "tests_require")
        for text, node in setup.values.items(setup.given(argument)).items
        if isinstance(text, str)
        for place in [setup.place(node)]
    ]
    yield from misspelt(needed, _NEEDED)


def texts_for_lists(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report entries of data_files with one text in place of a list of files."""
    for value, _ in setup.values.items(setup.given("data_files")).items:
        pair = value.items if isinstance(value, Listing) else ()
        text, node = pair[1] if len(pair) == 2 else (None, None)
        if node is None or not isinstance(text, str):
            continue
        yield Problem.at(
            setup.place(node),
            "error",
            _CODE,
            f"the files of this entry are the text {text} and no list: each letter is "
            "taken for a file, and colcon build stops",
            _listed(node, text, setup),
        )


def _listed(node: ast.expr, text: str, setup: SetupFile) -> Fix:
    if "*" in text:
        right = setup.globbed(text)
        if right is None:
            return Fix(f"write glob('{text}'), and from glob import glob at the top")
    else:
        right = f"[{ast.unparse(node)}]"
    return rewritten(node, setup.shown, right)


def malformed_entry_points(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report programs whose text is almost NAME = MODULE:FUNCTION."""
    for node, text in setup.scripts.items:
        meant = _meant(text, around) if text is not None else None
        if text is None or meant is None:
            continue
        name, module, function = meant
        right, place = f"{name} = {module}:{function}", setup.place(node)
        said = text.partition("=")[2].strip()
        if not said:
            cause = f"there is no = between a program and its function in {text}"
        elif ":" not in said:
            cause = f"the program {name} is {said}, and a colon has to be before the "
            cause += f"function {function}"
        else:
            cause = f"the program {name} is {said}, and a module has dots and no .py"
        yield Problem.at(
            place,
            "error",
            "entry-point-missing",
            f"{cause}: ros2 run stops with it",
            write(
                place,
                said or text,
                f"{module}:{function}" if said else right,
                hint=f"write {right}",
            ),
        )


def _meant(text: str, around: Surroundings) -> tuple[str, str, str] | None:
    """Return program, module and function; None for a right text or a different one."""
    match = _NEARLY.fullmatch(text)
    if match is None:
        return None
    path, function = match["path"], match["function"]
    module = path.replace("/", ".").removesuffix(".py")
    name = match["name"] or module.rpartition(".")[2]
    above, _, last = module.rpartition(".")
    meant = [(module, function or "main")] + ([] if function else [(above, last)])
    for each, called in meant:
        file = around.files.folder / f"{each.replace('.', '/')}.py"
        if each and file.is_file():
            is_right = match["sign"] and match["function"] and path == each
            return None if is_right else (name, each, called)
    return None


def quoted_names(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report a text in data_files that is the name of a variable: 'package_name'."""
    names = {
        target.id
        for step in setup.tree.body
        if isinstance(step, ast.Assign)
        for target in step.targets
        if isinstance(target, ast.Name)
    }
    given = setup.given("data_files")
    for node in ast.walk(given) if given is not None else ():
        if isinstance(node, ast.Constant) and node.value in names:
            yield Problem.at(
                setup.place(node),
                "error",
                "install-destination",
                f"{node.value} is in quotation marks, so that it is a text and not the "
                "value of that name: nothing of it is found",
                rewritten(node, setup.shown, str(node.value)),
            )


def loose_texts(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report texts in data_files that are outside the pairs and not files."""
    for value, node in setup.values.items(setup.given("data_files")).items:
        if not isinstance(value, str) or (around.files.folder / value).is_file():
            continue
        mark = f"resource/{around.files.name}"
        is_index = value == INDEX and (around.files.folder / mark).is_file()
        right = f"('{INDEX}', ['{mark}'])"
        yield Problem.at(
            setup.place(node),
            "error",
            "setup-file-missing",
            f"data_files has {value} alone, and no list of files for it: colcon build "
            "stops",
            rewritten(node, setup.shown, right)
            if is_index
            else f"write ('{value}', [ … ]) with the files for that folder",
        )


def without_name(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report a call of setup without the name of the package."""
    call, config = setup.call, around.files.text("setup.cfg") or ""
    if call is None or not setup.certain or not call.keywords or "name" in config:
        return
    given = {keyword.arg for keyword in call.keywords}
    if "name" in given or "version" not in given or around.cmake is not None:
        return
    if (around.files.folder / "pyproject.toml").is_file():
        return
    first = call.keywords[0]
    begin = Place(setup.shown, first.lineno, first.col_offset + 1)
    written = f"name='{around.files.name}'"
    blanks = " " * first.col_offset
    yield Problem.at(
        setup.place(call),
        "error",
        _CODE,
        "setup( … ) is given no name: what colcon builds is not found as this package",
        write_between(begin, begin, f"{written},\n{blanks}", f"add {written}"),
    )

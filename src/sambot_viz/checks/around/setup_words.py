"""Words and forms in setup.py that setuptools passes over, or that stop it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import partial

from sambot_viz.checks.around.launching.python_parts import Listing, Table
from sambot_viz.checks.around.place import rewritten
from sambot_viz.checks.around.setup_file import SetupFile
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.words import WordKind, WrittenWord, misspelt
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Place, Problem

_CODE = "setup-py-code"
_UNREAD = WordKind(
    "setup_py",
    _CODE,
    "{owner} has no {wrong}, but {right}: what is given here is not read",
    "warning",
)
_NEARLY = re.compile(
    r"\s*(?:(?P<name>[\w.-]+)(?:\s*(?P<sign>=)\s*|\s+))?"
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


def texts_for_lists(setup: SetupFile, around: Surroundings) -> Iterator[Problem]:
    """Report entries of data_files whose files are one text and no list."""
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
    """Report programs whose text is not NAME = MODULE:FUNCTION, but nearly."""
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
    """Return program, module and function; None where the text says them, or none."""
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

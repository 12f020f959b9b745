"""Words and forms in setup.py that setuptools passes over, or that stop it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from sambot_viz.checks.around.launching.python_parts import Listing
from sambot_viz.checks.around.place import rewritten
from sambot_viz.checks.around.setup_file import SetupFile
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Place, Problem, nearest

_LIKENESS = 0.75
_CODE = "setup-py-code"
_DOTTED = re.compile(r"\s*([\w.-]+)\s*=\s*([\w.]+)\.(\w+)\s*")


def misspelt_arguments(around: Surroundings) -> Iterator[Problem]:
    """Report arguments of setup, and kinds of entry points, that nothing reads."""
    setup = around.setup
    call = setup.call if setup is not None else None
    if setup is None or call is None:
        return
    given = {k.arg for k in call.keywords if k.arg}
    for argument in call.keywords:
        wrong = argument.arg or ""
        place = Place(setup.shown, argument.lineno, argument.col_offset + 1)
        yield from _misspelt("setup", wrong, given, place)
    table = setup.given("entry_points")
    keys = table.keys if isinstance(table, ast.Dict) else []
    kinds = [key for key in keys if isinstance(key, ast.Constant)]
    for key in kinds:
        names = {str(one.value) for one in kinds}
        yield from _misspelt("entry_points", str(key.value), names, setup.place(key))


def _misspelt(
    owner: str, wrong: str, given: set[str], place: Place
) -> Iterator[Problem]:
    known = vocabulary("setup_py")[owner]
    near = nearest(wrong, known, _LIKENESS) if wrong not in known else None
    if near is not None and near not in given:
        yield Problem.at(
            place,
            "warning",
            _CODE,
            f"{owner} has no {wrong}, but {near}: what is given here is not read",
            write(place, wrong, near),
        )


def texts_for_lists(around: Surroundings) -> Iterator[Problem]:
    """Report entries of data_files whose files are one text and no list."""
    setup = around.setup
    entries = setup.values.items(setup.given("data_files")).items if setup else ()
    for value, _ in entries:
        pair = value.items if isinstance(value, Listing) else ()
        text, node = pair[1] if len(pair) == 2 else (None, None)
        if setup is None or node is None or not isinstance(text, str):
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


def entry_points_without_colon(around: Surroundings) -> Iterator[Problem]:
    """Report programs whose module and function are joined by a dot."""
    setup = around.setup
    for node, text in setup.scripts.items if setup is not None else ():
        match = _DOTTED.fullmatch(text) if text is not None else None
        if setup is None or match is None:
            continue
        name, module, function = match.groups()
        if not (around.files.folder / f"{module.replace('.', '/')}.py").is_file():
            continue
        right = f"{name} = {module}:{function}"
        yield Problem.at(
            setup.place(node),
            "error",
            "entry-point-missing",
            f"the program {name} is {module}.{function}, and a colon has to be before "
            f"the function {function}: ros2 run stops with it",
            write(
                setup.place(node),
                f"{module}.{function}",
                f"{module}:{function}",
                hint=f"write {right}",
            ),
        )

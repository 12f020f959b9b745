"""``sambot-viz check``: find the mistakes in a model, and how to fix them."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz import bundled
from sambot_viz.commands.command_line import Parser, config_path, model_path, parse
from sambot_viz.errors import Problem, UsageError
from sambot_viz.files import each_file_once, relative_path
from sambot_viz.options import Options
from sambot_viz.outlet import can_ask, write_json, write_lines, write_out
from sambot_viz.problems import group_problems, write_problems

if TYPE_CHECKING:
    from sambot_viz.checks.checked import Checked


def run(words: list[str]) -> int:
    """Check a model; 0 when it has no errors (it may have warnings), else 1.

    With --explain, print what a code means.
    """
    given, options = parse(parser(), words)
    if given.explain is not None:
        from sambot_viz.explanations import as_text

        write_lines(f"{as_text(given.explain)}\n")
        return 0
    _refuse_what_cannot_be_fixed(given, options)
    # The import is late: completion and --help need no rules.
    from sambot_viz.checks.checked import check_all

    path, config = model_path(options), config_path(options)
    if path is None:
        path = bundled.model_path()
    elif not os.path.exists(path):
        raise UsageError(bundled.missing("model", path))
    check = partial(
        check_all,
        path,
        config=config,
        xacro_args=options.xacro_args,
        package_path=options.package_path,
        workspace=options.workspace,
        trusted=options.trusted,
    )
    if given.fix:
        found = check()
        own = () if config is None else (config.absolute(),)
        found = replace(found, problems=_fix(path, found, check, given, own))
        _print(path, found, given.format)
    else:
        with each_file_once():
            found = check()
            _print(path, found, given.format)
    return int(any(problem.severity == "error" for problem in found.problems))


def _fix(
    path: Path,
    found: Checked,
    check: Callable[[], Checked],
    given: argparse.Namespace,
    own: tuple[Path, ...],
) -> tuple[Problem, ...]:
    """Apply the edits that are wanted; returns the problems that are left.

    Args:
        path: the model, or a folder.
        found: what is wrong with it.
        check: finds it again.
        given: the flags of the command.
        own: files that may be changed wherever they are.
    """
    from sambot_viz.commands.fix import Fixing, folders_of

    folder = path if path.is_dir() else None
    models = [one.model for one in found.models] or [path]
    folders = [one for model in models for one in folders_of(model, folder)]
    folders += own
    known = [found]

    def find_problems() -> list[Problem]:
        return [*(known.pop() if known else check()).problems]

    infos = given.infos or not given.yes
    fixing = Fixing(find_problems, folders, asks=not given.yes, infos=infos)
    return tuple(fixing.run())


def _print(path: Path, found: Checked, how: str) -> None:
    if how == "json":
        write_json(_as_json(found))
    elif how == "sarif":
        from sambot_viz.commands.sarif import sarif_log

        model = found.models[0].model if len(found.models) == 1 else path
        write_json(sarif_log(found.problems, model))
    else:
        _write(path, found)


def _refuse_what_cannot_be_fixed(given: argparse.Namespace, options: Options) -> None:
    """Raise UsageError where no edit can be applied, or no question asked."""
    if given.yes and not given.fix:
        raise UsageError("--yes answers the questions of --fix; give both")
    if given.infos and not given.yes:
        raise UsageError("--infos says what --fix --yes applies; give all three")
    if not given.fix:
        return
    if given.format != "text":
        raise UsageError(
            f"--fix does not go with --format {given.format}; leave it out"
        )
    if not options.trusted:
        raise UsageError("--fix does not go with --untrusted: it changes files")
    if options.model is None:
        raise UsageError("--fix needs a MODEL; the bundled robot is not changed")
    if not given.yes and not can_ask():
        raise UsageError("--fix asks on a terminal, and there is none; add --yes")


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz check",
        groups=("model", "check", "config"),
        model="model file, package folder, folder of packages, or a file of a package",
        description="List what is wrong with a model and its mesh files, where, and "
        "how to fix it, and with its package: names that differ between it and other "
        "files, its .rviz, launch files and build files. Of a package without a model, "
        "those that its launch files open are checked. "
        "Exit status: 0 fine (there may be warnings), 1 errors found, 2 usage.",
    )
    made.add_format("sarif")
    made.add_argument(
        "--explain",
        metavar="CODE",
        help="print what a code means, with an example, and check nothing",
    )
    made.add_argument(
        "--fix",
        action="store_true",
        help="show the edits of the findings that have some, ask, write them into the "
        "files of the package, and list what is left",
    )
    made.add_argument(
        "--yes",
        action="store_true",
        help="with --fix: apply the edits of errors and warnings without asking",
    )
    made.add_argument(
        "--infos",
        action="store_true",
        help="with --fix --yes: apply the edits of infos too",
    )
    return made


def _as_json(found: Checked) -> dict[str, object]:
    models = [
        {"model": str(one.model), "opened_by": one.opened_by or None}
        for one in found.models
    ]
    return {
        "model": models[0]["model"] if models else None,
        "models": models,
        "problems": [group.as_json() for group in group_problems(found.problems)],
    }


def _write(path: Path, found: Checked) -> None:
    models = () if found.package is not None else found.models
    for one in models:
        if one.opened_by:
            write_out(f"model: {one.model}, which {one.opened_by} opens")
        elif len(models) > 1:
            write_out(f"model: {one.model}")
    if found.problems:
        write_problems(found.problems, write_out, most=None)
    else:
        model = models[0].model if len(models) == 1 else path
        write_out(f"{model}: no problems found")
    if found.elsewhere:
        what = "finding is" if found.elsewhere == 1 else "findings are"
        folder = relative_path(found.package or path)
        write_out(
            f"{found.elsewhere} more {what} in other files of its package: sambot-viz "
            f"check {folder}"
        )

"""``sambot-viz check``: what is wrong with a model, and how to fix it."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

from sambot_viz.bundled import Found, find
from sambot_viz.checks import check, check_folder
from sambot_viz.commands.command_line import Parser, model_path, parse
from sambot_viz.errors import Problem, UsageError
from sambot_viz.options import Options
from sambot_viz.outlet import can_ask, write_json, write_out
from sambot_viz.problems import group_problems, write_problems


def run(words: list[str]) -> int:
    """Check a model; 0 when it has no errors (it may have warnings), else 1."""
    given, options = parse(parser(), words)
    _refuse_what_cannot_be_fixed(given, options)
    path = model_path(options)
    found = find(path)
    find_problems = partial(_problems, options, found)
    if given.fix:
        from sambot_viz.commands.fix import Fixing, folders_of

        folder = path if path is not None and path.is_dir() else None
        folders = folders_of(found.model, folder)
        problems = Fixing(find_problems, folders, asks=not given.yes).run()
    else:
        problems = find_problems()
    _print(problems, found.model, given.format)
    return int(any(problem.severity == "error" for problem in problems))


def _print(problems: list[Problem], model: Path, how: str) -> None:
    if how == "json":
        listed = [group.as_json() for group in group_problems(problems)]
        write_json({"model": str(model), "problems": listed})
    elif how == "sarif":
        from sambot_viz.commands.sarif import sarif_log

        write_json(sarif_log(problems, model))
    elif problems:
        write_problems(problems, write_out, most=None)
    else:
        write_out(f"{model}: no problems found")


def _refuse_what_cannot_be_fixed(given: argparse.Namespace, options: Options) -> None:
    """Raise UsageError where edits cannot be applied, or not be asked for."""
    if not given.fix:
        if given.yes:
            raise UsageError("--yes answers the questions of --fix; give both")
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
        groups=("model",),
        description="List what is wrong with a model and its mesh files, where, and "
        "how to fix it, and names that differ between it and the other files of its "
        "package; of a package folder also what is wrong with its .rviz, launch files "
        "and setup.py. "
        "Exit status: 0 fine (there may be warnings), 1 errors found, 2 usage.",
    )
    made.add_format("sarif")
    made.add_argument(
        "--fix",
        action="store_true",
        help="show the edits of the findings that have some, ask, write them into the "
        "files of the package, and list what is left",
    )
    made.add_argument(
        "--yes", action="store_true", help="with --fix: apply all edits without asking"
    )
    return made


def _problems(options: Options, found: Found) -> list[Problem]:
    """Return the findings about a model, or about all files of a package folder."""
    args, packages = options.xacro_args, options.package_path
    folder = model_path(options)
    if folder is None or not folder.is_dir():
        return check(
            found.model, xacro_args=args, package_path=packages, trusted=options.trusted
        )
    return check_folder(
        folder,
        found.model,
        found.config,
        xacro_args=args,
        package_path=packages,
        trusted=options.trusted,
    )

"""``sambot-viz check``: what is wrong with a model, and how to fix it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz import bundled
from sambot_viz.commands.command_line import Parser, model_path, parse
from sambot_viz.errors import UsageError
from sambot_viz.outlet import write_json, write_out
from sambot_viz.problems import group_problems, write_problems

if TYPE_CHECKING:
    from sambot_viz.checks.checked import Checked


def run(words: list[str]) -> int:
    """Check a model; 0 when it has no errors (it may have warnings), else 1."""
    given, options = parse(parser(), words)
    # The import is late: completion and --help need no rules.
    from sambot_viz.checks.checked import check_all

    path = model_path(options)
    if path is None:
        path = bundled.model_path()
    elif not os.path.exists(path):
        raise UsageError(bundled.missing("model", path))
    found = check_all(
        path,
        xacro_args=options.xacro_args,
        package_path=options.package_path,
        workspace=options.workspace,
        trusted=options.trusted,
    )
    if given.format == "json":
        write_json(_as_json(found))
    else:
        _write(path, found)
    return int(any(problem.severity == "error" for problem in found.problems))


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz check",
        groups=("model", "check"),
        model="model file, package folder, or folder of packages",
        description="List what is wrong with a model and its mesh files, where, and "
        "how to fix it, and with its package: names that differ between it and other "
        "files, its .rviz, launch files and build files. Of a package without a model, "
        "those that its launch files open are checked. "
        "Exit status: 0 fine (there may be warnings), 1 errors found, 2 usage.",
    )
    made.add_format()
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
    for one in found.models:
        if one.opened_by:
            write_out(f"model: {one.model}, which {one.opened_by} opens")
    if found.problems:
        write_problems(found.problems, write_out, most=None)
    else:
        model = found.models[0].model if found.models else path
        write_out(f"{model}: no problems found")

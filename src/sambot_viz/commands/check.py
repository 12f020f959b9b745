"""``sambot-viz check``: what is wrong with a model, and how to mend it."""

from __future__ import annotations

import json
import sys

from sambot_viz import problem_text
from sambot_viz.bundled import Found, find
from sambot_viz.checks import check
from sambot_viz.commands.options import ModelOptions, Parser, add_model_options, parse
from sambot_viz.errors import Problem


def run(words: list[str]) -> int:
    """Check a model; 0 when it has no errors (it may have warnings), else 1."""
    parser = Parser(
        prog="sambot-viz check",
        description="Say what is wrong with a model, where, and how to mend it; of a "
        "package folder also what of its .rviz, launch files and setup.py is wrong. "
        "Exit status: 0 fine (there may be warnings), 1 errors found, 2 usage.",
    )
    add_model_options(parser)
    parser.add_argument("--format", choices=("text", "json"), default="text")
    options, wanted = parse(parser, words)
    found = find(wanted.model)
    model, problems = found.model, _problems(wanted, found)
    if options.format == "json":
        listed = [problem.as_json() for problem in problems]
        print(json.dumps({"model": str(model), "problems": listed}, indent=2))
    elif problems:
        problem_text.write(problems, sys.stdout)
    else:
        print(f"{model}: no problems found")
    return int(any(problem.severity == "error" for problem in problems))


def _problems(wanted: ModelOptions, found: Found) -> list[Problem]:
    """Of a model, or of a package folder with its config and launch files."""
    args, packages = wanted.xacro_args, wanted.package_path
    if wanted.model is None or not wanted.model.is_dir():
        return check(
            found.model,
            xacro_args=args,
            package_path=packages,
            trusted=wanted.trusted,
        )
    from sambot_viz.checks.folder import check_folder

    return check_folder(
        wanted.model,
        found.model,
        found.config,
        xacro_args=args,
        package_path=packages,
        trusted=wanted.trusted,
    )

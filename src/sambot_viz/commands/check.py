"""``sambot-viz check``: what is wrong with a model, and how to mend it."""

from __future__ import annotations

import json
import sys

from sambot_viz import report
from sambot_viz.checks import check
from sambot_viz.commands.options import Parser, add_model_options, parse
from sambot_viz.find import find


def run(words: list[str]) -> int:
    """Check a model; 0 when it has no errors (it may have warnings), else 1."""
    parser = Parser(
        prog="sambot-viz check",
        description="Say what is wrong with a model, where, and how to mend it. "
        "Exit status: 0 fine (there may be warnings), 1 errors found, 2 usage.",
    )
    add_model_options(parser)
    parser.add_argument("--format", choices=("text", "json"), default="text")
    options, wanted = parse(parser, words)
    model = find(wanted.model).model
    problems = check(
        model, xacro_args=wanted.xacro_args, package_path=wanted.package_path
    )
    if options.format == "json":
        found = [problem.as_json() for problem in problems]
        print(json.dumps({"model": str(model), "problems": found}, indent=2))
    elif problems:
        report.write(problems, sys.stdout)
    else:
        print(f"{model}: no problems found")
    return int(any(problem.severity == "error" for problem in problems))

"""``sambot-viz check``: what is wrong with a model, and how to fix it."""

from __future__ import annotations

from sambot_viz.bundled import Found, find
from sambot_viz.checks import check, check_folder
from sambot_viz.commands.command_line import Parser, model_path, parse
from sambot_viz.errors import Problem
from sambot_viz.options import Options
from sambot_viz.outlet import write_json, write_out
from sambot_viz.problems import group_problems, write_problems


def run(words: list[str]) -> int:
    """Check a model; 0 when it has no errors (it may have warnings), else 1."""
    given, options = parse(parser(), words)
    found = find(model_path(options))
    model, problems = found.model, _problems(options, found)
    if given.format == "json":
        listed = [group.as_json() for group in group_problems(problems)]
        write_json({"model": str(model), "problems": listed})
    elif problems:
        write_problems(problems, write_out, most=None)
    else:
        write_out(f"{model}: no problems found")
    return int(any(problem.severity == "error" for problem in problems))


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
    made.add_format()
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

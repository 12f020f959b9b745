"""``sambot-viz lesson``: learn by one; list them, write a new one, check it."""

from __future__ import annotations

import shutil
from argparse import Namespace
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from sambot_viz.bundled import assets_folder
from sambot_viz.commands.command_line import Parser, parse
from sambot_viz.errors import LessonError, UsageError, nearest
from sambot_viz.lessons.check_lesson import check_lesson
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.lessons.read_lesson import lesson_names, open_lesson
from sambot_viz.lessons.study import Study
from sambot_viz.options import Options
from sambot_viz.outlet import write_err, write_json, write_out
from sambot_viz.problems import write_problems

ACTIONS = ("list", "new", "check")


def run(words: list[str]) -> int:
    """Show a lesson, or list, begin or check some; 1 when one has errors, else 0."""
    given, options = parse(parser(), words)
    if given.action in ACTIONS and given.static is not None:
        raise UsageError(
            f"--static writes a lesson: name one in place of {given.action}, such as "
            f"sambot-viz lesson {lesson_names()[0]} --static {given.static}"
        )
    if given.action == "list":
        return _list(given.format)
    solution = Path(given.solution) if given.solution else None
    if solution is not None and not solution.exists():
        raise UsageError(f"--solution {solution}: it does not exist")
    if given.action not in ACTIONS:
        if given.static is not None:
            return _write(given, solution)
        return _learn(given, options)
    if given.path is None:
        what = "a new folder" if given.action == "new" else "a lesson.yaml"
        raise UsageError(f"sambot-viz lesson {given.action} needs {what}")
    if given.action == "new":
        return _new(Path(given.path))
    return _check(Path(given.path), solution, given.format)


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz lesson",
        groups=("listen", "counts"),
        takes_model=False,
        description="LESSON: show a lesson beside the robot that you write, until "
        "Ctrl-C; with --static, write it as files. list: name the lessons that ship. "
        "new DIR: write a lesson of one step to begin with. check FILE: try a lesson "
        "with its solution, which has to pass, and its start, which must not. Exit "
        "status: 0 fine (there may be warnings), 1 errors found, 2 usage.",
    )
    made.add_argument(
        "action",
        metavar="LESSON",
        help="name of a lesson that ships, a lesson.yaml, or its folder; or one of the "
        "words list, new and check",
    )
    made.add_argument(
        "path",
        metavar="FILE",
        nargs="?",
        help="the folder of a new lesson; the lesson to check, a file or a name",
    )
    made.add_argument(
        "--solution",
        metavar="DIR",
        help="with check: what has to pass, in place of the solution that it names; "
        "with --static: its robots are shown as what those of the steps become",
    )
    made.add_argument(
        "--static",
        metavar="DIR",
        help="with a lesson: write it as files for any web server into this new "
        "folder: texts, pictures, hints and robots, which check nothing",
    )
    add_track(made)
    made.add_argument(
        "--dir",
        metavar="DIR",
        help="with a lesson: your folder; by default a new one with the name of the "
        "lesson",
    )
    made.add_argument(
        "--report",
        action="store_true",
        help="with a lesson: save what is typed by itself, and write its state into "
        "your folder, for the board of sambot-viz class --hub",
    )
    made.add_open()
    made.add_format()
    return made


def add_track(made: Parser) -> None:
    """Add ``--track``."""
    made.add_argument(
        "--track",
        metavar="TRACK",
        help="the way through the lesson, such as urdf or sdf; by default that of the "
        "files that are there, or the first one",
    )


def _learn(given: Namespace, options: Options) -> int:
    """Show a lesson, and the model of a student, until Ctrl-C."""
    lesson = lesson_of(given.action, ACTIONS)
    if given.path is not None:
        raise UsageError(f"name your folder with --dir: --dir {given.path}")
    folder = Path(given.dir or lesson.name)
    study = Study.begun(lesson, folder, given.track)
    options = options.learning(study)
    write_err(f"sambot-viz: your files are in {folder}; you begin with {options.model}")
    # The imports are late: the other actions need no page.
    from sambot_viz.commands.show import serve

    if not given.report:
        serve(options, given.open)
        return 0
    from sambot_viz.classroom.student_page import reported

    serve(options, given.open, partial(reported, study))
    return 0


def _write(given: Namespace, solution: Path | None) -> int:
    """Write a lesson as files for a web server."""
    if given.path is not None or given.dir is not None:
        raise UsageError("--static shows the lesson to all: leave the other folder out")
    lesson = lesson_of(given.action, ACTIONS)
    folder = _new_folder(Path(given.static), "--static ")
    from sambot_viz.commands.static_lesson import write_lesson

    ships = given.action in lesson_names() and not Path(given.action).exists()
    name = given.action if ships else None
    write_lesson(lesson, folder, given.track, solution, name)
    write_out(f"{folder / 'index.html'}: {lesson.title}")
    return 0


def lesson_of(word: str, actions: Sequence[str]) -> Lesson:
    """Return a lesson; the error for a misspelt action offers the action.

    Args:
        word: its name, its file or its folder.
        actions: the words that are valid in its place.

    Raises:
        UsageError: there is no such lesson.
        LessonError: it cannot be read.
    """
    near = nearest(word, actions, likeness=0.7)
    if near is not None and not Path(word).exists():
        raise UsageError(f"sambot-viz lesson cannot '{word}'; did you mean '{near}'?")
    return open_lesson(word)


def _list(how: str) -> int:
    lessons = [open_lesson(name) for name in lesson_names()]
    if how == "json":
        write_json({"lessons": [_as_json(lesson) for lesson in lessons]})
        return 0
    for lesson in lessons:
        points = sum(step.points for step in lesson.steps)
        amount = f"{len(lesson.steps)} steps, {points:g} points"
        tracks = ", ".join(name for name in lesson.tracks if name)
        write_out(f"{lesson.name}: {lesson.title} ({amount})")
        write_out(f"    {' '.join(lesson.about.split())}")
        if tracks:
            write_out(f"    tracks: {tracks}")
    return 0


def _as_json(lesson: Lesson) -> dict[str, object]:
    return {
        "name": lesson.name,
        "title": lesson.title,
        "about": lesson.about,
        "tracks": [name for name in lesson.tracks if name],
        "steps": [
            {"name": step.name, "title": step.title, "points": step.points}
            for step in lesson.steps
        ],
    }


def _new_folder(folder: Path, flag: str = "") -> Path:
    """Return a folder that is empty, or not there yet.

    Raises:
        UsageError: something is in it.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise UsageError(f"{flag}'{folder}' is there already; name a new folder")
    return folder


def _new(folder: Path) -> int:
    _new_folder(folder)
    try:
        shutil.copytree(assets_folder() / "new-lesson", folder, dirs_exist_ok=True)
    except OSError as error:
        raise UsageError(f"cannot write '{folder}': {error.strerror}") from error
    write_out(f"{folder}/lesson.yaml: change it, then sambot-viz lesson check {folder}")
    return 0


def _check(path: Path, solution: Path | None, how: str) -> int:
    try:
        problems = check_lesson(open_lesson(path), solution)
    except LessonError as error:
        problems = list(error.problems)
    if how == "json":
        rows = [problem.as_json() for problem in problems]
        write_json({"lesson": str(path), "problems": rows})
    elif problems:
        write_problems(problems, write_out, most=None)
    else:
        write_out(f"{path}: the solution passes, and the start does not")
    return int(any(problem.severity == "error" for problem in problems))

"""Write a lesson as files for a web server: `sambot-viz lesson NAME --static DIR`."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import quote

from sambot_viz.commands.export import write_page
from sambot_viz.errors import RobotError, UsageError, did_you_mean
from sambot_viz.files import reason_of
from sambot_viz.inputs import Inputs
from sambot_viz.lessons.check_lesson import given_in, named_solution
from sambot_viz.lessons.lesson import Lesson, LessonStep
from sambot_viz.lessons.markdown import pictures
from sambot_viz.lessons.web_page import PICTURES, StepRobots, lesson_page
from sambot_viz.options import Options
from sambot_viz.outlet import write_err

_START = "start"
"""The folder with the files to begin with."""


def write_lesson(
    lesson: Lesson,
    folder: Path,
    track: str | None,
    solution: Path | None,
    ships: str | None,
) -> None:
    """Write the page of a lesson, its pictures and files, and a page for each robot.

    Args:
        lesson: the lesson.
        folder: an empty one, or one to make.
        track: the way through the lesson; None for the first.
        solution: whose robots are the references; None for that of the lesson.
        ships: its name, where it ships with the program.

    Raises:
        UsageError: there is no such track, or a file cannot be written.
    """
    if track is not None and track not in lesson.tracks:
        near = did_you_mean(track, lesson.tracks)
        raise UsageError(f"the lesson {lesson.name} has no track '{track}'; {near}")
    name = next(iter(lesson.tracks)) if track is None else track
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _copy_pictures(lesson, folder)
        files = [*_copy_start(lesson, name, folder)]
        robots = _Robots(folder)
        shown = {
            step.name: _robots_of(lesson, step, name, solution, robots)
            for step in lesson.steps
        }
        page = lesson_page(lesson, name, shown, files, ships)
        (folder / "index.html").write_text(page, "utf-8")
    except OSError as error:
        raise UsageError(f"cannot write into '{folder}': {reason_of(error)}") from error


def _copy_pictures(lesson: Lesson, folder: Path) -> None:
    texts = [text for step in lesson.steps for text in _texts(step)]
    for picture in {name for text in texts for name in pictures(text)}:
        target = folder / PICTURES / picture
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(lesson.folder / picture, target)


def _texts(step: LessonStep) -> Iterator[str]:
    yield step.text
    yield from (text for _, text in step.in_track)
    yield from (hint.text for hint in step.hints)


def _copy_start(lesson: Lesson, track: str, folder: Path) -> Iterator[str]:
    """Copy the files to begin with; give their addresses beside the page."""
    start = lesson.tracks[track].start
    if not start:
        return
    source = lesson.folder / start
    files = [source] if source.is_file() else sorted(source.rglob("*"))
    root = source.parent if source.is_file() else source
    for file in files:
        if file.is_file():
            inside = Path(_START) / file.relative_to(root)
            (folder / inside).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, folder / inside)
            yield quote(inside.as_posix())


def _robots_of(
    lesson: Lesson, step: LessonStep, track: str, solution: Path | None, robots: _Robots
) -> StepRobots:
    way = lesson.tracks[track]
    start = lesson.folder / way.start if way.start else None
    reference = solution or named_solution(lesson)
    models: list[Path | None] = []
    for folder in (start, reference):
        given = None
        if folder is not None and folder.exists():
            given = given_in(lesson, folder / track, track, way)
            given = given or given_in(lesson, folder, track, way)
        model = None if given is None else given.model_of(step)
        models.append(model if model is not None and model.is_file() else None)
    begun, done = models
    page = robots.page(begun)
    # A model that is still empty is to be written, and has no error to find.
    broken = begun is not None and not page and begun.stat().st_size > 0
    return StepRobots(page, robots.page(done), broken)


class _Robots:
    """Writes a page for each model, once.

    Args:
        folder: where the pages are.
    """

    def __init__(self, folder: Path) -> None:
        self._folder, self._pages = folder, dict[Path, str]()

    def page(self, model: Path | None) -> str:
        """Return the page of a model; "" where it cannot be shown."""
        if model is None:
            return ""
        if model not in self._pages:
            number = 1 + sum(bool(page) for page in self._pages.values())
            name = f"robot-{number}.html"
            self._pages[model] = name if self._write(model, self._folder / name) else ""
        return self._pages[model]

    def _write(self, model: Path, page: Path) -> bool:
        if not model.stat().st_size:
            return False
        try:
            with Inputs(Options(model, panels=False)) as inputs:
                write_page(inputs, page, sweep=True)
        except RobotError:
            write_err(f"sambot-viz: note: {model} has errors, and gets no page")
            return False
        return True

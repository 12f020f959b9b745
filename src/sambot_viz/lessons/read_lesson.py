"""Reads a `Lesson` from a lesson.yaml, or from the name of a bundled lesson."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from sambot_viz import limits
from sambot_viz.bundled import assets_folder
from sambot_viz.checks.around.files.parameters import read_yaml
from sambot_viz.checks.around.files.yaml_repair import fault_in
from sambot_viz.errors import (
    LessonError,
    Place,
    Problem,
    UsageError,
    did_you_mean,
)
from sambot_viz.files import read_limited, reason_of
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.lessons.reading.records import read_record
from sambot_viz.lessons.reading.report import LessonReport

LESSON_FILE = "lesson.yaml"
"""The file of a lesson, in its own folder."""


def lesson_names() -> list[str]:
    """Return the names of the bundled lessons, sorted."""
    found = (assets_folder() / "lessons").glob(f"*/{LESSON_FILE}")
    return sorted(file.parent.name for file in found)


def open_lesson(lesson: str | Path) -> Lesson:
    """Return a lesson.

    Args:
        lesson: name of a bundled lesson, a lesson.yaml, or the folder of one.

    Raises:
        UsageError: the lesson does not exist.
        LessonError: the lesson cannot be read.
    """
    path = Path(lesson)
    if path.is_dir() and (path / LESSON_FILE).is_file():
        path = path / LESSON_FILE
    if path.is_file():
        return read_lesson(path)
    names = lesson_names()
    if str(lesson) in names:
        return read_lesson(assets_folder() / "lessons" / str(lesson) / LESSON_FILE)
    near = did_you_mean(str(lesson), names)
    raise UsageError(f"no lesson '{lesson}': neither a file nor one that ships; {near}")


def read_lesson(path: Path) -> Lesson:
    """Read a lesson.yaml.

    Raises:
        LessonError: the file is not a valid lesson; `.problems` lists all faults.
    """
    text, file = _text_of(path), str(path)
    fault = fault_in(text)
    if fault is not None:
        place = Place(file, fault.line)
        problem = Problem.at(
            place, "error", "lesson-unreadable", fault.cause, fault.hint
        )
        raise LessonError([problem])
    read = read_yaml(text, path.name, file)
    if read is None:
        raise _refused(path, "the file is empty", "begin with name: and title:")
    report = LessonReport(path)
    lesson = read_record(Lesson, "a lesson", read.root, report, file=path)
    if lesson is not None:
        for problem in _faults(lesson):
            report.findings.note(problem)
    if lesson is None or report.findings.problems:
        raise LessonError(report.findings.problems)
    return lesson


def _text_of(path: Path) -> str:
    try:
        return read_limited(path, limits.LESSON.value).decode("utf-8")
    except (OSError, ValueError) as error:
        raise _refused(path, reason_of(error), "write YAML in UTF-8") from error


def _refused(path: Path, message: str, hint: str) -> LessonError:
    code = "lesson-unreadable"
    return LessonError([Problem("error", code, message, hint, str(path))])


def _faults(lesson: Lesson) -> Iterator[Problem]:
    """Yield the contradictions between the values of a lesson."""
    file = str(lesson.file)

    def wrong(message: str, hint: str) -> Problem:
        return Problem("error", "lesson-value", message, hint, file)

    if not lesson.given_tracks and not all(
        s.model or lesson.model for s in lesson.steps
    ):
        yield wrong(
            "no model file is named",
            "add model: with the name of the file that students write",
        )
    for name, count in Counter(step.name for step in lesson.steps).items():
        if count > 1:
            yield wrong(f"{count} steps are called '{name}'", "rename all but one")
    for step in lesson.steps:
        if step.points <= 0:
            yield wrong(f"the step {step.name} gives no points", "write points: 1")
        after = [hint.after for hint in step.hints]
        if after != sorted(after):
            yield wrong(
                f"the hints of {step.name} come after {after} tries, out of order",
                "order them by after:",
            )
        for track in lesson.tracks:
            hides = any(one.hidden for one in step.demands(track))
            if hides and not step.shown_hints(track, 10**9):
                yield wrong(
                    f"the step {step.name} hides what is expected, and has no hint "
                    "that would end it",
                    "add hints:, the answer last",
                )
        named = {*dict(step.in_track), *(h.only for h in step.hints if h.only)}
        named |= {one.only for one in step.conditions if one.only}
        for track in sorted(named - lesson.tracks.keys()):
            near = did_you_mean(track, [t for t in lesson.tracks if t])
            yield wrong(f"the step {step.name} names the track '{track}'", near)

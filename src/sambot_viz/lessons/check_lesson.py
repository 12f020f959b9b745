"""Checks a lesson for its teacher, before students use it."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from sambot_viz.errors import Problem
from sambot_viz.lessons.evaluation import messages
from sambot_viz.lessons.lesson import Lesson, Track
from sambot_viz.lessons.student_files import HandedIn, handed_in


def check_lesson(lesson: Lesson, solution: Path | None = None) -> list[Problem]:
    """Try a lesson with its solution and with its start.

    Args:
        lesson: the lesson.
        solution: folder with a correct solution; None for the lesson's own.

    Returns:
        An error for each step that the solution fails, and for a start that passes all
        steps; a warning for a step that the start passes, and for one without hints.
    """
    found: list[Problem] = []
    folder = solution or named_solution(lesson)
    if folder is None:
        hint = "add solution: with its folder, or give one with --solution"
        found.append(_of(lesson, "error", "the lesson has no solution", hint))
    for name, track in lesson.tracks.items():
        if folder is not None:
            found += _of_solution(lesson, folder, name, track)
        found += _of_start(lesson, name, track)
    found += _without_hints(lesson)
    return found


def _of(lesson: Lesson, severity: str, message: str, hint: str) -> Problem:
    file = str(lesson.file)
    if severity == "error":
        return Problem("error", "lesson-trial", message, hint, file)
    return Problem("warning", "lesson-trial", message, hint, file)


def _of_solution(
    lesson: Lesson, folder: Path, name: str, track: Track
) -> Iterator[Problem]:
    of_track = f" of the track {name}" if name else ""
    given = given_in(lesson, folder / name, name, track) or given_in(
        lesson, folder, name, track
    )
    if given is None:
        message = f"the solution{of_track} has no file {track.model}: {folder}"
        yield _of(lesson, "error", message, f"write {track.model} into it")
        return
    said, _ = messages(lesson, given, lesson.steps)
    for step, message in zip(lesson.steps, said, strict=True):
        if message:
            first = message.splitlines()[0]
            yield _of(
                lesson,
                "error",
                f"the solution{of_track} fails the step {step.name}: {first}",
                "correct the solution, or the condition",
            )


def _of_start(lesson: Lesson, name: str, track: Track) -> Iterator[Problem]:
    of_track = f" of the track {name}" if name else ""
    with tempfile.TemporaryDirectory() as empty:
        start = lesson.folder / track.start if track.start else Path(empty)
        if not start.exists():
            hint = "write it, or delete the line start:"
            yield _of(lesson, "error", f"there is no start {track.start}", hint)
            return
        given = given_in(lesson, start, name, track)
        given = given or HandedIn(start, name, start / track.model, False)
        said, _ = messages(lesson, given, lesson.steps)
    held = [s for s, text in zip(lesson.steps, said, strict=True) if not text]
    if len(held) == len(lesson.steps):
        message = f"the start{of_track} passes all steps"
        yield _of(lesson, "error", message, "add conditions that it does not meet")
        return
    for step in held:
        yield _of(
            lesson,
            "warning",
            f"the step {step.name} holds for the start{of_track}, before anything is "
            "written",
            "add a condition that the start does not meet",
        )


def named_solution(lesson: Lesson) -> Path | None:
    """Return the solution that a lesson names; None if it names none."""
    return lesson.folder / lesson.solution if lesson.solution else None


def given_in(lesson: Lesson, path: Path, name: str, track: Track) -> HandedIn | None:
    """Return the part of a folder or a file for a track; None if it has none.

    Args:
        lesson: the lesson.
        path: a solution, or a start.
        name: name of the track.
        track: the track.
    """
    if path.is_file():
        return HandedIn(path.parent, name, path, True)
    for file in (path / track.model, *sorted(path.glob(f"**/{track.model}"))):
        if file.is_file():
            return HandedIn(handed_in(lesson, path).folder, name, file, False)
    return None


def _without_hints(lesson: Lesson) -> Iterator[Problem]:
    for step in lesson.steps:
        if not step.hints:
            hint = "add hints: with after: and text:, the answer last"
            yield _of(lesson, "warning", f"the step {step.name} has no hints", hint)

"""One student's work on a lesson: the shown step, its results, and the next step."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path

from sambot_viz import limits
from sambot_viz.errors import Problem, RobotError, UsageError, did_you_mean
from sambot_viz.files import is_below, read_limited, reason_of
from sambot_viz.lessons.evaluation import (
    DemandResult,
    StepFault,
    StepResult,
    faults_in,
    outcomes_of,
)
from sambot_viz.lessons.lesson import Lesson, LessonStep
from sambot_viz.lessons.markdown import TextBlock, blocks
from sambot_viz.lessons.progress import Progress
from sambot_viz.lessons.student_files import BUILT, HandedIn, folder_of, handed_in
from sambot_viz.lessons.work import Work
from sambot_viz.robot.model import Robot

TEXTS = (".urdf", ".xacro", ".sdf", ".xml", ".py", ".yaml", ".yml", ".rviz", ".txt")
"""Endings of the files that a student writes."""


class Study:
    """A lesson with the folder of a student, for a page that shows both.

    Args:
        lesson: the lesson.
        folder: the student's folder, which must exist.
        track: track of the lesson; None for the track of the existing files.
        trusted: as for `load_robot`.

    Attributes:
        folder: absolute path of the student's folder.
        lesson: the lesson.
        track: track of the lesson.
        progress: progress of the student.
        trusted: as for `load_robot`.

    Raises:
        UsageError: the folder does not exist, or the lesson has no such track.
    """

    def __init__(
        self,
        lesson: Lesson,
        folder: Path,
        track: str | None = None,
        *,
        trusted: bool = True,
    ) -> None:
        if track is not None and track not in lesson.tracks:
            near = did_you_mean(track, lesson.tracks)
            raise UsageError(f"the lesson {lesson.name} has no track '{track}'; {near}")
        found = handed_in(lesson, folder)
        self.lesson = lesson
        self.track = found.track if track is None else track
        self.progress = Progress(folder, lesson.name)
        self.folder = folder.absolute()
        self.trusted = trusted
        self._model: Path | None = None

    @classmethod
    def begun(
        cls,
        lesson: Lesson,
        folder: Path,
        track: str | None = None,
        *,
        trusted: bool = True,
    ) -> Study:
        """Start in a folder, which is created if missing, or continue there.

        Afterwards the start files exist, and the model of the step.

        Raises:
            UsageError: a file cannot be written, or the lesson has no such track.
        """
        try:
            folder.mkdir(parents=True, exist_ok=True)
            study = cls(lesson, folder, track, trusted=trusted)
            study.begin()
            model = study.model_of(study.step)
            if not model.exists():
                model.parent.mkdir(parents=True, exist_ok=True)
                model.touch()
        except OSError as error:
            why = reason_of(error)
            raise UsageError(f"cannot write into '{folder}': {why}") from error
        return study

    @property
    def step(self) -> LessonStep:
        """The next step; the last one when all have passed."""
        return self.progress.current(self.lesson) or self.lesson.steps[-1]

    def begin(self) -> list[Path]:
        """Copy the start files; existing files stay.

        Returns:
            The written files.

        Raises:
            OSError: a file cannot be written.
        """
        start = self.lesson.tracks[self.track].start
        if not start:
            return []
        source = self.lesson.folder / start
        files = [source] if source.is_file() else sorted(source.rglob("*"))
        root = source.parent if source.is_file() else source
        written: list[Path] = []
        for file in files:
            target = self.folder / file.relative_to(root)
            if file.is_file() and not target.exists():
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(file, target)
                written.append(target)
        return written

    def model_of(self, step: LessonStep) -> Path:
        """Return the model file of a step, which need not exist."""
        return self._handed_in().model_of(step)

    def files(self) -> list[Path]:
        """Return the absolute paths of the student's folders and files.

        The list omits build results and hidden files, and ends at the limit.
        """
        found: list[Path] = []
        for folder, inner, names in os.walk(self.folder):
            inner[:] = sorted(n for n in inner if n[0] != "." and n not in BUILT)
            found += Path(folder), *(Path(folder, n) for n in names if n[0] != ".")
            if len(found) >= limits.STUDENT_FILES.value:
                break
        return found[: limits.STUDENT_FILES.value]

    def texts(self) -> list[Path]:
        """Return the student's text files, by their endings."""
        return [path for path in self.files() if path.suffix in TEXTS]

    def picture(self, name: str) -> bytes:
        """Return a picture of the lesson's folder; empty if it cannot be read."""
        folder = self.lesson.folder
        if not is_below(folder / name, [folder.resolve()]):
            return b""
        try:
            return read_limited(folder / name, limits.LESSON_PICTURE.value)
        except OSError:
            return b""

    def text_of(self, step: LessonStep) -> list[TextBlock]:
        """Return the text of a step, with the text for the track."""
        return blocks(f"{step.text}\n\n{dict(step.in_track).get(self.track, '')}")

    def hints_of(self, step: LessonStep) -> list[list[TextBlock]]:
        """Return the hints that have appeared after the tries so far."""
        tries = self.progress.of(step.name).tries
        return [blocks(hint.text) for hint in step.shown_hints(self.track, tries)]

    def tries_to_hint(self, step: LessonStep) -> int:
        """Return the number of tries until the next hint; 0 when none is left."""
        tries = self.progress.of(step.name).tries
        later = step.shown_hints(self.track, 10**9)[
            len(step.shown_hints(self.track, tries)) :
        ]
        return later[0].after - tries if later else 0

    def work_of(
        self,
        step: LessonStep,
        loaded: Robot | RobotError | None = None,
        problems: Iterable[Problem] | None = None,
        edited: Mapping[str, str] | None = None,
    ) -> Work:
        """Return a student's work on a step, which reads the files once.

        Args:
            step: the step.
            loaded: the robot, or the reason why there is none, if already known.
            problems: findings of `check`, if already known.
            edited: as for `load_robot`.
        """
        given = self._handed_in()
        return Work(
            given.model_of(step),
            given.folder_of(step),
            trusted=self.trusted,
            loaded=loaded,
            problems=problems,
            edited=edited,
        )

    def outcomes(self, step: LessonStep, work: Work) -> list[DemandResult]:
        """Return the current results of all demands, without counting a try."""
        tries = self.progress.of(step.name).tries
        return outcomes_of(step, work, self.track, tries)

    def look(self, step: LessonStep, work: Work) -> list[StepFault]:
        """Return the current faults without counting a try, after each key."""
        return faults_in(self.outcomes(step, work))

    def attempt(self, step: LessonStep, work: Work) -> StepResult:
        """Return the result of a step, count the try and keep it in the folder.

        Raises:
            OSError: the progress cannot be written.
        """
        return self.count(step, self.look(step, work))

    def count(self, step: LessonStep, faults: Iterable[StepFault]) -> StepResult:
        """Count a try with these faults, and save the progress.

        Raises:
            OSError: the progress cannot be written.
        """
        said = "\n".join(fault.message for fault in faults)
        result = StepResult.of(self.lesson, step, said)
        self.progress.note(result)
        self.progress.save()
        return result

    def show(self, step: LessonStep) -> None:
        """Save which step the student reads.

        Raises:
            OSError: the progress cannot be written.
        """
        self.progress.show(step.name)
        self.progress.save()

    def _handed_in(self) -> HandedIn:
        # Searching all folders for a model that has not moved takes long.
        known = self._model
        if known is None or not known.is_file():
            found = handed_in(self.lesson, self.folder)
            own = found.track == self.track
            known = found.model if own else None
            self._model = known
        if known is None:
            model = self.folder / self.lesson.tracks[self.track].model
            return HandedIn(self.folder, self.track, model, False)
        return HandedIn(folder_of(known, self.folder), self.track, known, False)

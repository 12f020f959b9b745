"""One student's way through a lesson: what is shown, what holds, what comes next."""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path

from sambot_viz.errors import Problem, RobotError, UsageError, did_you_mean
from sambot_viz.lessons.evaluation import StepFault, StepResult, faults_of
from sambot_viz.lessons.lesson import Lesson, LessonStep
from sambot_viz.lessons.markdown import TextBlock, blocks
from sambot_viz.lessons.progress import Progress
from sambot_viz.lessons.student_files import HandedIn, handed_in
from sambot_viz.lessons.work import Work
from sambot_viz.robot.model import Robot


class Study:
    """A lesson with the folder of a student, for a page that shows both.

    Args:
        lesson: the lesson.
        folder: the student's folder; it has to exist.
        track: the way through the lesson; None for that of the files that are there.
        trusted: as for `load_robot`.

    Attributes:
        lesson: the lesson.
        track: the way through it.
        progress: how far the student is.

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
        self._folder = folder
        self._trusted = trusted

    @property
    def step(self) -> LessonStep:
        """The first step that has not held; the last one when all have."""
        return self.progress.current(self.lesson) or self.lesson.steps[-1]

    def begin(self) -> list[Path]:
        """Copy the files to begin with; those that are there already stay.

        Returns:
            What was written.

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
            target = self._folder / file.relative_to(root)
            if file.is_file() and not target.exists():
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(file, target)
                written.append(target)
        return written

    def text_of(self, step: LessonStep) -> list[TextBlock]:
        """Return the text of a step, with that of the track."""
        return blocks(f"{step.text}\n\n{dict(step.in_track).get(self.track, '')}")

    def hints_of(self, step: LessonStep) -> list[list[TextBlock]]:
        """Return the hints that have come, after the tries so far."""
        tries = self.progress.of(step.name).tries
        return [blocks(hint.text) for hint in step.shown_hints(self.track, tries)]

    def work_of(
        self,
        step: LessonStep,
        loaded: Robot | RobotError | None = None,
        problems: Iterable[Problem] | None = None,
    ) -> Work:
        """Return what the student has written for a step; the files are read once.

        Args:
            step: the step.
            loaded: the robot, or why there is none, where that is known already.
            problems: what `check` says, where that is known already.
        """
        given = self._handed_in()
        return Work(
            given.model_of(step),
            given.folder_of(step),
            trusted=self._trusted,
            loaded=loaded,
            problems=problems,
        )

    def look(self, step: LessonStep, work: Work) -> list[StepFault]:
        """Return what does not hold now; nothing is counted, for each key."""
        tries = self.progress.of(step.name).tries
        return faults_of(step, work, self.track, tries)

    def attempt(self, step: LessonStep, work: Work) -> StepResult:
        """Return the result of a step, count the try and keep it in the folder.

        Raises:
            OSError: the progress cannot be written.
        """
        said = "\n".join(fault.message for fault in self.look(step, work))
        result = StepResult.of(self.lesson, step, said)
        self.progress.note(result)
        self.progress.save()
        return result

    def _handed_in(self) -> HandedIn:
        found = handed_in(self.lesson, self._folder)
        if found.track == self.track:
            return found
        model = self._folder / self.lesson.tracks[self.track].model
        return HandedIn(self._folder, self.track, model, False)

"""A lesson in a session: the step that is shown, and what holds of it by now.

What the student has written is read in a thread, after each save and each text that is
typed in the page. That counts no try: only the button Check does. A step that holds in
the saved files counts, whichever step is read.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from sambot_viz.lessons.evaluation import DemandResult, faults_in
from sambot_viz.lessons.lesson import LessonStep
from sambot_viz.lessons.study import Study
from sambot_viz.lessons.work import Work
from sambot_viz.session.background import Background
from sambot_viz.session.editor.model_text import ModelText
from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.unsaved import unsaved


@dataclass(frozen=True, slots=True)
class FromTeacher:
    """What the teacher of a class says to a student.

    Attributes:
        number: another one for each sentence.
        text: the last sentence; "" when there is none.
        link: to the page of a student that is shown to all; "" when there is none.
        name: of that student.
    """

    number: int = 0
    text: str = ""
    link: str = ""
    name: str = ""


class ShownLesson:
    """The lesson of one session.

    Args:
        study: the student's way through it.
        text: those of the page; None where it has none.
        facts: after a change of one of these the student may have written something.
        change: of the session.
        report: shows an error that nobody expected.

    Attributes:
        study: the student's way through it.
        changed: told after a change of what is shown.
        step: the step that is shown.
        outcomes: what holds of it, and what does not; None until that is known.
        also: steps that have come to hold while this one was read.
        checking: whether a try is being counted.
        other_model: the name of its model file, where the view shows another one.
        trouble: why the progress cannot be saved; "" when it is.
        teacher: the message of the teacher.
    """

    def __init__(
        self,
        study: Study,
        text: ModelText | None,
        facts: Iterable[Signal[Any]],
        change: Change,
        report: Callable[[Exception], object],
    ) -> None:
        self.study, self._text = study, text
        self._change, self._report = change, report
        self.changed = Signal(change, None)
        self.step = study.step
        self._model = study.model_of(self.step)
        self.outcomes: list[DemandResult] | None = None
        self.also: tuple[LessonStep, ...] = ()
        self.checking = False
        self.trouble = self.other_model = ""
        self.teacher = FromTeacher()
        self._closed = False
        self._background = Background("sambot-viz-lesson")
        self._disconnect = connect(facts, self.look)
        self.look()

    def close(self) -> None:
        """Follow the session no longer."""
        self._closed = True
        self._disconnect()

    def wait(self, timeout: float) -> bool:
        """Wait until all is looked at; False when that takes longer [s]."""
        return self._background.wait(timeout)

    # What the teacher of a class does; with the session locked.

    def announce(self, sentence: str) -> None:
        """Show a sentence of the teacher."""
        number = self.teacher.number + 1
        self.teacher = replace(self.teacher, number=number, text=sentence)
        self.changed.touch()

    def point_to(self, link: str, name: str) -> None:
        """Offer the page of a student; an empty link offers none."""
        self.teacher = replace(self.teacher, link=link, name=name)
        self.changed.touch()

    # What users do; with the session locked.

    def show(self, number: int) -> None:
        """Show a step.

        Args:
            number: from 1.

        Raises:
            UsageError: there is no such step.
        """
        self.step = self.study.lesson.step(number)
        self.outcomes, self.also = None, ()
        model = self.study.model_of(self.step)
        if self._text is not None:
            self._text.follow(model)
        elif model != self._model:
            self.other_model = model.name
        else:
            self.other_model = ""
        self._keep(self.study.show, self.step)
        self.look()

    def check(self) -> None:
        """Count a try of the step that is shown; a second call waits for the first."""
        if not self.checking:
            self.checking = True
            self.changed.touch()
            self._background.do(self.changed, self._check)

    def look(self) -> None:
        """Look again at what the student has written; returns at once."""
        self._background.do(self, self._look)

    # In the thread

    def _check(self) -> None:
        step = self.step
        try:
            with self._change.lock:
                texts = self._texts()
            outcomes, _ = self._read(step, texts)
            with self._change(self.changed):
                self._count(step, outcomes)
            # The last hint may say what was hidden.
            self._look()
        except Exception as error:
            self._report(error)
        finally:
            with self._change(self.changed):
                self.checking = False

    def _look(self) -> None:
        with self._change.lock:
            step, texts = self.step, self._texts()
            if self._closed:
                return
        try:
            outcomes, work = self._read(step, texts)
        except Exception as error:
            self._report(error)
            return
        with self._change():
            if step is not self.step:
                return
            passed = self.study.progress.of(step.name).passed
            if not passed and not texts and not faults_in(outcomes):
                self._count(step, outcomes)
            if outcomes != self.outcomes:
                self.outcomes = outcomes
                self.changed.touch()
        if not texts:
            self._look_at_others(step, {work.model: work})

    def _look_at_others(self, shown: LessonStep, works: dict[Path, Work]) -> None:
        """Count the steps that hold in the saved files, too.

        Args:
            shown: the step that is shown.
            works: what is read already, by the model file.
        """
        for step in self.study.lesson.steps:
            if step is shown or self.study.progress.of(step.name).passed:
                continue
            model = self.study.model_of(step)
            if model not in works:
                works[model] = self._work_of(step, {})
            try:
                outcomes = self.study.outcomes(step, works[model])
            except Exception as error:
                self._report(error)
                return
            with self._change.lock:
                if self._closed or shown is not self.step:
                    return
            if not faults_in(outcomes):
                with self._change(self.changed):
                    self._count(step, outcomes)
                    self.also += (step,)

    def _read(
        self, step: LessonStep, texts: Mapping[str, str]
    ) -> tuple[list[DemandResult], Work]:
        work = self._work_of(step, texts)
        with unsaved(texts):
            return self.study.outcomes(step, work), work

    def _work_of(self, step: LessonStep, texts: Mapping[str, str]) -> Work:
        """Return what is written for a step; what the editor has loaded is taken."""
        model, trusted = self.study.model_of(step), self.study.trusted
        with self._change.lock:
            text = self._text
            loaded = None if text is None else text.known(model, texts, trusted)
        return self.study.work_of(step, loaded, edited=texts)

    def _texts(self) -> Mapping[str, str]:
        return {} if self._text is None else self._text.texts

    def _count(self, step: LessonStep, outcomes: Iterable[DemandResult]) -> None:
        self._keep(self.study.count, step, faults_in(outcomes))

    def _keep(self, write: Callable[..., object], *facts: object) -> None:
        """Write something into the progress, or say why it cannot be kept."""
        try:
            write(*facts)
            self.trouble = ""
        except OSError as error:
            self.trouble = f"the progress cannot be kept: {error.strerror}"
        self.changed.touch()

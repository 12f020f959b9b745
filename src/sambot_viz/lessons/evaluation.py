"""Which steps of a lesson hold for what a student has written."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.errors import RobotError
from sambot_viz.lessons.conditions.condition import Unmet
from sambot_viz.lessons.demand import Demand, explained
from sambot_viz.lessons.lesson import Lesson, LessonStep
from sambot_viz.lessons.student_files import HandedIn
from sambot_viz.lessons.work import Work

_ELSE = "what is expected is said with the last hint"


@dataclass(frozen=True, slots=True)
class StepFault:
    """Something that does not hold.

    Attributes:
        unmet: what was found, what was expected, and where.
        message: both in words.
    """

    unmet: Unmet
    message: str


@dataclass(frozen=True, slots=True)
class DemandResult:
    """What became of one thing that a step demands.

    Attributes:
        subject: what it is about; empty when the model cannot be read.
        faults: what does not hold of it.
    """

    subject: str
    faults: tuple[StepFault, ...]


@dataclass(frozen=True, slots=True)
class StepResult:
    """What became of a step.

    Attributes:
        number: of the step in the lesson, from 1.
        name: of the step.
        title: its heading.
        points: what it has earned.
        max_points: what it can earn.
        message: what does not hold, one line each; empty when all holds.
    """

    number: int
    name: str
    title: str
    points: float
    max_points: float
    message: str

    @classmethod
    def of(cls, lesson: Lesson, step: LessonStep, message: str) -> StepResult:
        """Return the result of a step from what does not hold in it."""
        number, points = lesson.steps.index(step) + 1, 0.0 if message else step.points
        return cls(number, step.name, step.title, points, step.points, message)

    @property
    def passed(self) -> bool:
        """Whether all holds."""
        return not self.message

    def as_json(self) -> dict[str, object]:
        """Return the fields of a step in the JSON output."""
        return {
            "name": self.name,
            "passed": self.passed,
            "points": self.points,
            "max_points": self.max_points,
            "message": self.message,
        }


def outcomes_of(
    step: LessonStep, work: Work, track: str = "", tries: int = 0
) -> list[DemandResult]:
    """Return what holds in a step, and what does not.

    Args:
        step: the step.
        work: what the student has written.
        track: the way through the lesson.
        tries: how often it has failed before; what is hidden comes with the last hint.
    """
    hides = not step.is_exhausted(track, tries)
    found: list[DemandResult] = []
    for demand in step.demands(track):
        try:
            unmet = demand.unmet(work)
        except RobotError as error:
            # Every other condition would say the same.
            said = explained(error)
            return [DemandResult("", (StepFault(said, said.found),))]
        faults = _in_words(demand, unmet, hides)
        found.append(DemandResult(demand.subject, tuple(faults)))
    return found


def faults_in(outcomes: Iterable[DemandResult]) -> list[StepFault]:
    """Return what does not hold, each once."""
    found: dict[str, StepFault] = {}
    for outcome in outcomes:
        for fault in outcome.faults:
            found.setdefault(fault.message, fault)
    return list(found.values())


def faults_of(
    step: LessonStep, work: Work, track: str = "", tries: int = 0
) -> list[StepFault]:
    """Return what does not hold in a step; the arguments are as for `outcomes_of`."""
    return faults_in(outcomes_of(step, work, track, tries))


def _in_words(demand: Demand, unmet: Iterable[Unmet], hides: bool) -> list[StepFault]:
    faults: list[StepFault] = []
    for one in unmet:
        expected = f"expected: {demand.says or one.expected}"
        if demand.hidden and hides and not demand.says:
            expected = _ELSE
        faults.append(StepFault(one, f"{one.found}; {expected}"))
    return faults


def messages(
    lesson: Lesson, given: HandedIn, steps: Iterable[LessonStep]
) -> tuple[list[str], str]:
    """Evaluate steps for files of unknown origin.

    Returns:
        For each step what does not hold, a line each; and why no model could be read,
        empty where one was.
    """
    works: dict[Path, Work] = {}
    found: list[str] = []
    for step in steps:
        model = given.model_of(step)
        if model not in works:
            works[model] = Work(model, given.folder_of(step), trusted=False)
        faults = faults_of(step, works[model], given.track)
        found.append("\n".join(fault.message for fault in faults))
    refusals = [work.refusal for work in works.values()]
    refused = [error for error in refusals if error is not None]
    all_refused = refused and len(refused) == len(refusals)
    return found, explained(refused[0]).found if all_refused else ""

"""Evaluates which steps of a lesson a student's files pass."""

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

_ELSE = "the last hint says what is expected"


@dataclass(frozen=True, slots=True)
class StepFault:
    """A part of a demand that does not hold.

    Attributes:
        unmet: the found and the expected value, and the place.
        message: both values in words.
    """

    unmet: Unmet
    message: str


@dataclass(frozen=True, slots=True)
class DemandResult:
    """The result of one demand of a step.

    Attributes:
        subject: subject of the demand; empty when the model cannot be read.
        faults: parts that do not hold.
    """

    subject: str
    faults: tuple[StepFault, ...]


@dataclass(frozen=True, slots=True)
class StepResult:
    """The result of a step.

    Attributes:
        number: number of the step in the lesson, from 1.
        name: name of the step.
        title: heading of the step.
        points: earned points.
        max_points: points that the step can earn.
        message: unmet demands, one line each; empty when all hold.
    """

    number: int
    name: str
    title: str
    points: float
    max_points: float
    message: str

    @classmethod
    def of(cls, lesson: Lesson, step: LessonStep, message: str) -> StepResult:
        """Return the result of a step with these unmet demands."""
        number, points = lesson.steps.index(step) + 1, 0.0 if message else step.points
        return cls(number, step.name, step.title, points, step.points, message)

    @property
    def passed(self) -> bool:
        """Return whether all demands hold."""
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
    """Return the results of all demands of a step.

    Args:
        step: the step.
        work: files of the student.
        track: track of the lesson.
        tries: number of failed tries so far; the last hint reveals hidden values.
    """
    hides = not step.is_exhausted(track, tries)
    found: list[DemandResult] = []
    for demand in step.demands(track):
        try:
            unmet = demand.unmet(work)
        except RobotError as error:
            # Every other condition would report the same.
            said = explained(error)
            return [DemandResult("", (StepFault(said, said.found),))]
        faults = _in_words(demand, unmet, hides)
        found.append(DemandResult(demand.subject, tuple(faults)))
    return found


def faults_in(outcomes: Iterable[DemandResult]) -> list[StepFault]:
    """Return the faults of all results, each once."""
    found: dict[str, StepFault] = {}
    for outcome in outcomes:
        for fault in outcome.faults:
            found.setdefault(fault.message, fault)
    return list(found.values())


def faults_of(
    step: LessonStep, work: Work, track: str = "", tries: int = 0
) -> list[StepFault]:
    """Return the faults of a step; the arguments are as for `outcomes_of`."""
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
        The faults of each step, one line each, and the reason why no model could be
        read; empty if one could.
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

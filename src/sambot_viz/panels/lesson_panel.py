"""The Lesson panel: the text of a step, what holds of it, and the list of steps."""

from __future__ import annotations

import base64
import mimetypes
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict

from sambot_viz.errors import Place
from sambot_viz.lessons.evaluation import DemandResult
from sambot_viz.lessons.markdown import TextBlock
from sambot_viz.panels.command import Argument, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.problems.problems_panel import place_of_line, without_folders
from sambot_viz.panels.rows.row import Data, Json, LongText, Row
from sambot_viz.session.shown_lesson import ShownLesson

_NUMBER = Argument(int, least=1)


class LessonPanel(Panel):
    """The step of a lesson that is shown, and the list of all.

    Args:
        lesson: what there is to learn.
    """

    name = "lesson"

    def __init__(self, lesson: ShownLesson) -> None:
        self.remade_by = (lesson.changed,)
        self._lesson, self._study = lesson, lesson.study

    def rows(self) -> Sequence[Row]:
        """Return a row that says that there is a lesson."""
        return [Row("lesson/note", "", "note", value=self._study.lesson.title)]

    def data(self) -> Sequence[Data]:
        """Return the list of steps, the text of one, and what holds of it."""
        step = self._lesson.step
        hints = self._study.hints_of(step)
        text = self._study.text_of(step)
        return [
            Data("lesson/steps", {"title": self._study.lesson.title, **self._steps()}),
            Data(
                "lesson/text",
                {
                    "title": step.title,
                    "blocks": self._blocks(text),
                    "other_model": self._lesson.other_model,
                },
            ),
            Data("lesson/hints", [self._blocks(hint) for hint in hints]),
            Data("lesson/state", self._state()),
            Data("lesson/teacher", asdict(self._lesson.teacher)),
        ]

    def _steps(self) -> dict[str, Json]:
        lesson, progress = self._study.lesson, self._study.progress
        return {
            "shown": lesson.steps.index(self._lesson.step) + 1,
            "steps": [
                {
                    "title": step.title,
                    "points": step.points,
                    "passed": progress.of(step.name).passed,
                }
                for step in lesson.steps
            ],
        }

    def _state(self) -> Json:
        shown, step = self._lesson, self._lesson.step
        progress = self._study.progress.of(step.name)
        outcomes = shown.outcomes
        return {
            "outcomes": None if outcomes is None else [*_rows(outcomes)],
            "tries": progress.tries,
            "passed": progress.passed,
            "checking": shown.checking,
            "trouble": shown.trouble,
            "also": [self._study.lesson.steps.index(one) + 1 for one in shown.also],
            "hint_in": self._study.tries_to_hint(step),
        }

    def _blocks(self, blocks: Iterable[TextBlock]) -> Json:
        return [self._block(block) for block in blocks]

    def _block(self, block: TextBlock) -> Json:
        made: dict[str, Json] = {**block.as_json()}
        if block.kind == "picture":
            made["data"] = LongText(self._picture(block.word))
        return made

    def _picture(self, name: str) -> str:
        """Return the data address of a picture; "" where it cannot be read."""
        data, kind = self._study.picture(name), mimetypes.guess_type(name)[0] or ""
        if not data or not kind.startswith("image/"):
            return ""
        return f"data:{kind};base64,{base64.b64encode(data).decode()}"

    # What the page calls

    @command("lesson/show", _NUMBER, name="Step")
    def _show(self, number: int) -> None:
        self._lesson.show(number)

    @command("lesson/check", name="Check")
    def _check(self) -> None:
        self._lesson.check()


def _rows(outcomes: Iterable[DemandResult]) -> Iterator[Json]:
    """Give what holds, and each fault once."""
    said: set[str] = set()
    for outcome in outcomes:
        if not outcome.faults:
            yield {"holds": True, "text": outcome.subject, "place": ""}
        for fault in outcome.faults:
            if fault.message not in said:
                said.add(fault.message)
                yield {"holds": False, **_fault(fault.message, fault.unmet.place)}


def _fault(message: str, place: Place | None) -> dict[str, Json]:
    """Give a sentence, and beside it the place that it may have inside."""
    if place is None:
        return {"text": without_folders(message), "place": ""}
    known = (place.file, place.line, place.column)
    inside = ":".join(str(part) for part in known if part is not None)
    words = without_folders(message.replace(f"{inside}: ", "", 1))
    return {"text": words, "place": place_of_line(place.file, place.line)}

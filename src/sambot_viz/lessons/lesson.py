"""A lesson: its steps with their conditions, hints and points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from sambot_viz.errors import Place, UsageError, did_you_mean
from sambot_viz.lessons.demand import DEMAND, Demand
from sambot_viz.lessons.markdown import faults, pictures
from sambot_viz.lessons.reading.records import given, read_record
from sambot_viz.lessons.reading.report import LessonReport
from sambot_viz.lessons.reading.values import (
    COUNT,
    FLAG,
    NUMBER,
    TEXT,
    ValueKind,
    all_of,
    map_of,
)


def _read_markdown(node: yaml.Node, report: LessonReport) -> str | None:
    text = TEXT.read(node, report)
    # The text of a block starts on the line below its key.
    style = getattr(node, "style", None)
    first = report.place(node).line + (style in ("|", ">"))
    good = True
    for line, message, hint in faults(text or ""):
        place = Place(report.file, first + line)
        report.findings.add("error", "lesson-text", message, hint, place)
        good = False
    for name in pictures(text or "") if good else ():
        if not (report.folder / name).is_file():
            place = report.place(node)
            message, hint = f"there is no picture {name}", "put it beside the lesson"
            report.findings.add("error", "lesson-text", message, hint, place)
            good = False
    return text if good else None


MARKDOWN = ValueKind("a text", _read_markdown)


@dataclass(frozen=True, slots=True, kw_only=True)
class Hint:
    """A hint that appears after some failed tries.

    Attributes:
        after: number of failed tries.
        text: Markdown.
        only: track of the hint; empty for all tracks.
    """

    after: int = given(COUNT)
    text: str = given(MARKDOWN)
    only: str = given(TEXT, "")


@dataclass(frozen=True, slots=True, kw_only=True)
class Track:
    """A variant of a lesson, such as one for each model format.

    Attributes:
        model: the model file, in the student's folder.
        start: folder or file with the start state, beside the lesson; empty for none.
    """

    model: str = given(TEXT)
    start: str = given(TEXT, "")


def _record(record: type[Any], of: str, words: str) -> ValueKind:
    def read(node: yaml.Node, report: LessonReport) -> Any:
        return read_record(record, of, node, report)

    return ValueKind(words, read)


_HINT = _record(Hint, "a hint", "after: and text:")
_TRACK = _record(Track, "a track", "model: and start:")


@dataclass(frozen=True, slots=True, kw_only=True)
class LessonStep:
    """One step.

    Attributes:
        name: name on the command line and in results.
        title: heading.
        text: Markdown.
        in_track: track → Markdown that follows the text there.
        conditions: conditions of the step.
        hints: hints, in order of appearance.
        points: points for the whole step.
        model: the model file, where it differs from that of the track.
    """

    name: str = given(TEXT)
    title: str = given(TEXT)
    text: str = given(MARKDOWN)
    in_track: tuple[tuple[str, str], ...] = given(
        map_of(MARKDOWN, "a map of tracks to texts"), ()
    )
    conditions: tuple[Demand, ...] = given(all_of(DEMAND, "a list of conditions"))
    hints: tuple[Hint, ...] = given(all_of(_HINT, "a list of hints"), ())
    points: float = given(NUMBER, 1.0)
    model: str = given(TEXT, "")

    def demands(self, track: str) -> Sequence[Demand]:
        """Return the demands of the step in a track."""
        return [one for one in self.conditions if one.only in ("", track)]

    def shown_hints(self, track: str, tries: int) -> Sequence[Hint]:
        """Return the hints of a track after a number of failed tries."""
        return [h for h in self._hints(track) if h.after <= tries]

    def is_exhausted(self, track: str, tries: int) -> bool:
        """Return whether the last hint has appeared, so that nothing stays hidden."""
        hints = self._hints(track)
        return bool(hints) and len(self.shown_hints(track, tries)) == len(hints)

    def _hints(self, track: str) -> Sequence[Hint]:
        return [one for one in self.hints if one.only in ("", track)]


_STEP = _record(LessonStep, "a step", "a map with name, title, text and conditions")


@dataclass(frozen=True, slots=True, kw_only=True)
class Lesson:
    """A lesson.

    Attributes:
        file: its lesson.yaml, as the user wrote it.
        name: name of the lesson.
        title: heading.
        about: subject of the lesson, in one or two sentences.
        model: the model file, in the student's folder; empty with tracks.
        start: folder or file with the start state; empty for none.
        solution: folder or file that passes; with tracks, one folder for each.
        given_tracks: names and tracks.
        fixes: whether the page offers to apply the fixes of problems.
        steps: the steps, in order.
    """

    file: Path
    name: str = given(TEXT)
    title: str = given(TEXT)
    about: str = given(TEXT, "")
    model: str = given(TEXT, "")
    start: str = given(TEXT, "")
    solution: str = given(TEXT, "")
    given_tracks: tuple[tuple[str, Track], ...] = given(
        map_of(_TRACK, "a map of names to tracks"), (), key="tracks"
    )
    fixes: bool = given(FLAG, True)
    steps: tuple[LessonStep, ...] = given(all_of(_STEP, "a list of steps"))

    @property
    def folder(self) -> Path:
        """The folder with its pictures and start files."""
        return self.file.parent

    @property
    def tracks(self) -> Mapping[str, Track]:
        """The tracks; a lesson without named tracks has one without a name."""
        alone = Track(model=self.model or self.steps[0].model, start=self.start)
        return dict(self.given_tracks) or {"": alone}

    def step(self, wanted: str | int) -> LessonStep:
        """Return a step by its number from 1, or its name.

        Raises:
            UsageError: the step does not exist.
        """
        if str(wanted).isdigit():
            if 1 <= int(wanted) <= len(self.steps):
                return self.steps[int(wanted) - 1]
            raise UsageError(
                f"the lesson {self.name} has no step {wanted}: its steps are 1 to "
                f"{len(self.steps)}"
            )
        for step in self.steps:
            if step.name == wanted:
                return step
        near = did_you_mean(str(wanted), [step.name for step in self.steps])
        raise UsageError(f"the lesson {self.name} has no step '{wanted}'; {near}")

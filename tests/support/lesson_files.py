"""Models and lessons as small texts, for tests of lessons."""

from __future__ import annotations

from pathlib import Path

from sambot_viz.lessons.conditions.condition import Condition, Unmet
from sambot_viz.lessons.lesson import Lesson
from sambot_viz.lessons.read_lesson import read_lesson
from sambot_viz.lessons.work import Work

DATA = Path(__file__).parents[1] / "data" / "lessons"
"""Lessons of the tests, and solutions of those that ship."""
BASE = DATA / "base"
"""A lesson of two steps."""

_HEAD = """\
name: l
title: L
model: robot.urdf
steps:
  - name: one
    title: One
    text: t
    conditions:
"""


def lesson_of(folder: Path, conditions: str) -> Lesson:
    """Write a lesson of one step with these lines as conditions, and read it."""
    lines = [f"      {line}" for line in conditions.strip().splitlines()]
    path = folder / "lesson.yaml"
    path.write_text(_HEAD + "\n".join(lines) + "\n")
    return read_lesson(path)


def condition_of(folder: Path, condition: str) -> Condition:
    """Read one condition, such as "link: {name: a}"."""
    (demand,) = lesson_of(folder, f"- {condition}").steps[0].conditions
    return demand.conditions[0]


def unmet(folder: Path, condition: str, work: Work) -> list[Unmet]:
    """Return what does not hold of one condition."""
    (demand,) = lesson_of(folder, f"- {condition}").steps[0].conditions
    return list(demand.unmet(work))

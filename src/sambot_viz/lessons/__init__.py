"""Lessons: steps with conditions on a robot and its files, and grades."""

from __future__ import annotations

from sambot_viz.lessons.grading import Grade, grade

__all__ = ["Grade", "grade"]

"""Lessons: steps with conditions that a robot and its files meet, and their grades."""

from __future__ import annotations

from sambot_viz.lessons.grading import Grade, grade

__all__ = ["Grade", "grade"]

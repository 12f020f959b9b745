"""Models and lessons as small texts, for tests of lessons."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from made_recording import (
    START,
    header,
    store_of_all,
    transforms_message,
    write_messages,
)

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


STATUS = "action_msgs/msg/GoalStatusArray"


def goal_statuses(codes: Sequence[int]) -> Any:
    """Return a message with the status of some goals."""
    store = store_of_all()
    types = store.types
    uuid = types["unique_identifier_msgs/msg/UUID"](np.zeros(16, np.uint8))
    goal = types["action_msgs/msg/GoalInfo"](uuid, header(store, 0.0, "map").stamp)
    return types[STATUS]([types["action_msgs/msg/GoalStatus"](goal, c) for c in codes])


def record_run(folder: Path, rate: int = 20, codes: Sequence[int] = (2, 4)) -> None:
    """Write the recording of a robot that drives two metres to a goal."""
    store = store_of_all()
    messages: list[tuple[str, str, int, object]] = []
    for number in range(2 * rate + 1):
        seconds = number / rate
        time = START * 10**9 + round(seconds * 1e9)
        frames = {"base_link": "odom", "odom": "map"}
        moved = transforms_message(store, seconds, frames)
        messages += [
            ("/demo/odom", "nav_msgs/msg/Odometry", time, b"\0" * 8),
            ("/demo/imu", "sensor_msgs/msg/Imu", time, b"\0" * 8),
            ("/tf", "tf2_msgs/msg/TFMessage", time, moved),
        ]
    topic = "/navigate_to_pose/_action/status"
    messages.append((topic, STATUS, messages[-1][2], goal_statuses(codes)))
    folder.mkdir(parents=True, exist_ok=True)
    write_messages(folder / "run.mcap", messages)

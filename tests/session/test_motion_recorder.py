"""What is known of the last minute of a motion."""

from __future__ import annotations

import itertools
import tracemalloc

import numpy as np
import pytest
from hand_clock import HandClock

from sambot_viz.session.robot.motion_recorder import (
    LONGEST,
    PERIOD,
    MotionRecorder,
)


@pytest.fixture
def clock() -> HandClock:
    return HandClock()


def test_the_steps_begin_where_everything_was_before(clock: HandClock) -> None:
    past = MotionRecorder(clock)
    past.clear({"a": 0.5, "b": 0.0})
    for q in (1.0, 2.0):
        past.note(["a", "follower"], {"a": q, "b": 0.0}, {})
        clock.advance(1.0)
    before, steps = past.last_minute()
    assert before.positions == {"a": 0.5, "b": 0.0}
    assert [dict(step.positions) for step in steps] == [{"a": 1.0}, {"a": 2.0}]
    assert [step.time for step in steps] == pytest.approx([PERIOD, 1.0 + PERIOD])


def test_what_is_older_than_a_minute_only_says_where_things_were(
    clock: HandClock,
) -> None:
    past = MotionRecorder(clock)
    past.clear({"a": 0.0})
    for second in range(100):
        clock.advance(1.0)
        past.note(["a"], {"a": float(second)}, {})
    before, steps = past.last_minute()
    assert before.positions == {"a": 99 - LONGEST - 1}
    assert [step.positions["a"] for step in steps] == list(range(39, 100))
    clock.advance(LONGEST + 1.0)
    before, steps = past.last_minute()
    assert (before.positions, steps) == ({"a": 99.0}, [])


def test_a_frame_begins_where_it_was_when_it_moved_first(clock: HandClock) -> None:
    past = MotionRecorder(clock)
    past.clear({})
    at = [np.diag([1.0, 1.0, 1.0, float(n)]) for n in range(3)]
    for n in (1, 2):
        past.begin("odom", at[n - 1])
        past.note([], {}, {"odom": at[n]})
        clock.advance(1.0)
    before, steps = past.last_minute()
    assert before.frames["odom"] is at[0]
    assert [step.frames["odom"] is at[n] for n, step in enumerate(steps, 1)] == [
        True
    ] * 2


def test_steps_that_follow_fast_are_one(clock: HandClock) -> None:
    past = MotionRecorder(clock)
    past.clear({"a": 0.0, "b": 0.0})
    past.note(["a"], {"a": 1.0}, {})
    past.note(["b"], {"a": 1.0, "b": 2.0}, {"odom": np.eye(4)})
    past.note(["a"], {"a": 3.0, "b": 2.0}, {})
    _, (step,) = past.last_minute()
    assert step.positions == {"a": 3.0, "b": 2.0}
    assert list(step.frames) == ["odom"]
    clock.advance(1.01 * PERIOD)
    past.note(["a"], {"a": 4.0, "b": 2.0}, {})
    assert len(past.last_minute()[1]) == 2


def test_a_day_of_three_hundred_moving_joints_takes_a_few_megabytes(
    clock: HandClock,
) -> None:
    names = [f"joint_{n}" for n in range(300)]
    past = MotionRecorder(clock)
    past.clear(dict.fromkeys(names, 0.0))
    values = itertools.count()
    tracemalloc.start()
    try:
        for _ in range(4000):
            clock.advance(PERIOD * 1.01)
            past.note(names, dict.fromkeys(names, float(next(values))), {})
        used, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert used < 4e6
    assert len(past.last_minute()[1]) > 900

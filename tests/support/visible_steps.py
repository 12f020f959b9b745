"""Plays a recording in steps, each of which is a picture of the page."""

from __future__ import annotations

from collections.abc import Iterator

from inside import session_of

from sambot_viz import Visualizer


def steps_to(viz: Visualizer, seconds: float, step: float) -> Iterator[float]:
    """Play from the start to a time [s], and yield the time at each step.

    Displays look at the time at each of them, as they do twice a second.
    """
    session = session_of(viz)
    assert session.data is not None and session.data.player is not None
    player = session.data.player
    viz.player.jump(0.0)
    while viz.player.time < seconds - step / 2:
        with session.lock:
            player.advance(step)
            session.robot.time_passed()
        yield viz.player.time

"""Reading a robot in a thread, while something slower is going on."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from threading import Thread
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from sambot_viz.robot.model import Robot

Loading: TypeAlias = "Future[Robot]"
"""A robot that is being read."""


def in_thread(load: Callable[[], Robot]) -> Loading:
    """Load a robot in a thread of its own, which ends with the program."""
    loading: Loading = Future()

    def run() -> None:
        try:
            loading.set_result(load())
        except BaseException as error:
            loading.set_exception(error)

    Thread(target=run, name="sambot-viz-load", daemon=True).start()
    return loading


def finished(robot: Robot) -> Loading:
    """A robot that is there already."""
    loading: Loading = Future()
    loading.set_result(robot)
    return loading

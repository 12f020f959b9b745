"""Reading a robot in a thread, while something slower is going on."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from concurrent.futures import Future, InvalidStateError
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
            robot = load()
        except BaseException as error:
            with contextlib.suppress(InvalidStateError):
                loading.set_exception(error)
        else:
            with contextlib.suppress(InvalidStateError):
                loading.set_result(robot)

    Thread(target=run, name="sambot-viz-load", daemon=True).start()
    return loading


def give_up(loading: Loading) -> None:
    """Let who waits for a robot go on with a KeyboardInterrupt.

    What reads it is not stopped: it ends with the program.
    """
    with contextlib.suppress(InvalidStateError):
        loading.set_exception(KeyboardInterrupt())


def finished(robot: Robot) -> Loading:
    """A robot that is there already."""
    loading: Loading = Future()
    loading.set_result(robot)
    return loading

"""How long tests wait for what must come.

``SAMBOT_VIZ_PATIENCE=3 bash tests/run`` waits three times as long, on a slow machine.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from itertools import chain, repeat
from typing import TypeVar

T = TypeVar("T")
_FACTOR = float(os.environ.get("SAMBOT_VIZ_PATIENCE", "1"))
NOT_YET = (AssertionError, ValueError)
"""What a condition raises that asserts, or unpacks, what is not there yet."""
_PAUSES = (0.02, 0.03, 0.05, 0.08, 0.12)
"""Between two looks [s]: to look costs time too, which what is waited for needs."""


def patience(seconds: float) -> float:
    """So many seconds on a usual machine, and more on a slow one."""
    return _FACTOR * seconds


def until(
    condition: Callable[[], T],
    timeout: float = 10.0,
    why: str = "",
    not_yet: type[Exception] | tuple[type[Exception], ...] = NOT_YET,
) -> T:
    """Return what a condition gives as soon as it is true.

    Args:
        condition: what is asked again and again.
        timeout: how long, on a usual machine [s].
        why: what to say when it does not become true.
        not_yet: a condition that raises one of these is not true yet.

    Raises:
        AssertionError: it did not become true in time.
    """
    end, pause = time.monotonic() + patience(timeout), threading.Event()
    pauses = chain(_PAUSES, repeat(_PAUSES[-1]))
    while True:
        trouble = ""
        try:
            if value := condition():
                return value
        except not_yet as error:
            trouble = str(error)
        if time.monotonic() > end:
            raise AssertionError(trouble or why or f"not true after {timeout:g} s")
        pause.wait(next(pauses))

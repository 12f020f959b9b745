"""How much work something is, counted: the same on each machine, however busy it is."""

from __future__ import annotations

import sys
from collections.abc import Callable


def calls_of(action: Callable[[], object]) -> int:
    """Run an action; returns how many functions it calls, those of C too.

    Only calls of this thread count, and not what one call does in C.
    """
    count = 0

    def note(frame: object, event: str, argument: object) -> None:
        del frame, argument
        nonlocal count
        count += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        action()
    finally:
        sys.setprofile(before)
    return count

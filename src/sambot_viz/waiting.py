"""Waiting that Ctrl-C ends on every system."""

from __future__ import annotations

import sys
import threading

_LOOK = 0.5
"""On Windows signals are looked for this often [s]: they do not end a longer wait."""


def wait_for(event: threading.Event) -> None:
    """Wait until an event is set; handlers of signals run meanwhile."""
    longest = _LOOK if sys.platform == "win32" else None
    while not event.wait(longest):
        pass

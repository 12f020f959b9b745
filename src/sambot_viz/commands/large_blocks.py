"""Keeps the memory of a server for days as small as what it holds."""

from __future__ import annotations

import ctypes
import sys
from contextlib import suppress

LARGE = 2**20
"""A block of this size goes back to the system as soon as it is free [bytes]."""
_M_MMAP_THRESHOLD = -3


def return_when_free() -> None:
    """Have Linux's C library give large blocks back; elsewhere nothing is done.

    That library raises the limit by itself up to 32 MB, and keeps what is below: after
    thirty pages with 50 MB of meshes each, 0.7 GB that nothing uses.
    """
    if sys.platform == "linux":
        # Other C libraries, such as that of Alpine, have no such function.
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).mallopt(_M_MMAP_THRESHOLD, LARGE)

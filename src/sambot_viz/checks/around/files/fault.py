"""A fault that stops a program from reading a file."""

from __future__ import annotations

from typing import NamedTuple


class Fault(NamedTuple):
    """A fault in a text, and how to fix it.

    Attributes:
        line: its line, from 1.
        cause: the cause of the fault.
        hint: what to write.
        better: the corrected line, where only one line changes.
        at: the line to change; None for `line`.
    """

    line: int
    cause: str
    hint: str
    better: str | None = None
    at: int | None = None

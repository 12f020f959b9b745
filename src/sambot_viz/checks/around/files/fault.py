"""A fault that stops a program from reading a file."""

from __future__ import annotations

from typing import NamedTuple


class Fault(NamedTuple):
    """What is wrong in a text.

    Attributes:
        line: its line, from 1.
        cause: what is wrong there.
        hint: what to write.
        better: the line as it should be, where one line is all that changes.
        at: the line that is to change; None for the same.
    """

    line: int
    cause: str
    hint: str
    better: str | None = None
    at: int | None = None

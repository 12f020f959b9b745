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
    """

    line: int
    cause: str
    hint: str
    better: str | None = None

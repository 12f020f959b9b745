"""The exception of a failed expansion, and the repeating part of endless ones."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")


class OutputLimit(Exception):
    """The expanded text exceeds the limit."""


def again(things: Sequence[T]) -> list[T]:
    """Return the repeated items of a list, in its order."""
    return [thing for thing in things if things.count(thing) > 1]


def unwrapped(error: BaseException) -> tuple[BaseException, list[str]]:
    """Return the exception below xacro's wrappers, and the expressions on the way."""
    expressions: list[str] = []
    while True:
        suffix = getattr(error, "suffix", None) or ""
        match = re.search(r"when evaluating expression '(.*)'", suffix, re.DOTALL)
        if match:
            expressions.insert(0, match[1])
        inner = getattr(error, "exc", None)
        if not isinstance(inner, BaseException):
            return error, expressions
        error = inner

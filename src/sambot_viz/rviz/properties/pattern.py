"""Regular expressions that users write, searched in linear time.

RViz searches its filters with C++'s `std::regex`. Python's own `re` tries every way to
match: an expression of 20 characters can take longer than the age of the universe. RE2
has no backtracking; what it cannot express (look-ahead, back references) is refused.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import re2 as _re2  # pyright: ignore[reportMissingTypeStubs]

LONGEST_PATTERN = 1000
_MEMORY = 1 << 17
"""Memory for one compiled expression [B]; larger ones are refused."""


class Pattern:
    """A compiled expression.

    Args:
        compiled: RE2's object.
    """

    def __init__(self, compiled: Any) -> None:
        self._compiled = compiled

    def matches(self, text: str) -> bool:
        """Return whether the expression matches anywhere in a text."""
        found = self._compiled.search(text.encode("utf-8", "replace"))
        return found is not None


@lru_cache(maxsize=64)
def compile_pattern(expression: str) -> Pattern | None:
    """Compile an expression for searching.

    Args:
        expression: in RE2's syntax, at most 1000 characters.

    Returns:
        None when it is not an expression, or one that RE2 cannot search.
    """
    if len(expression) > LONGEST_PATTERN:
        return None
    re2: Any = _re2
    options = re2.Options()
    options.log_errors = False
    options.max_mem = _MEMORY
    try:
        return Pattern(re2.compile(expression, options))
    except (re2.error, UnicodeError):
        return None

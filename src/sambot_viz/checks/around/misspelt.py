"""Distinguish misspelt names from different ones, word by word."""

from __future__ import annotations

import re

from sambot_viz.errors import nearest

_BETWEEN = re.compile(r"[_\-./]")
_WORD_LIKENESS = 0.6


def is_misspelt(name: str, right: str) -> bool:
    """Return whether each word of a name is similar to that of the right one.

    detect_marker is another program than detect_sign, whatever the letters.
    """
    words, others = _BETWEEN.split(name), _BETWEEN.split(right)
    if "".join(words).lower() == "".join(others).lower():
        return True
    return len(words) == len(others) and all(
        nearest(word.lower(), [other.lower()], _WORD_LIKENESS)
        for word, other in zip(words, others, strict=True)
        if word != other
    )

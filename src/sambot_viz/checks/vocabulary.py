"""Read the words that other programs know from the tables in vocabularies."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path

_TABLES = Path(__file__).with_name("vocabularies")


@cache
def vocabulary(name: str) -> Mapping[str, tuple[str, ...]]:
    """Return a table: the first word of each line, and the words after it.

    Args:
        name: of the file, without its ending.
    """
    text = (_TABLES / f"{name}.txt").read_text("utf-8")
    lines = (line.split() for line in text.splitlines() if line[:1] != "#")
    return {line[0]: tuple(line[1:]) for line in lines if line}

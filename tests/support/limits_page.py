"""Writes docs/limits.md from the table of limits.

tests/.venv/test/bin/python tests/support/limits_page.py
"""

from __future__ import annotations

from pathlib import Path

from sambot_viz import limits

PAGE = Path(__file__).resolve().parents[2] / "docs" / "limits.md"

_HEAD = """\
# Limits

This page is generated from `src/sambot_viz/limits.py`. Everything that comes from
outside is counted against this table. What is above a limit costs its own topic, file
or page; the rest goes on, and a sentence with the figures says it.

| of | at most | above it |
| --- | ---: | --- |
"""


def table() -> list[limits.LimitRow]:
    """The rows, in the order of the module."""
    return [one for one in vars(limits).values() if isinstance(one, limits.LimitRow)]


def page() -> str:
    """The whole page."""
    return _HEAD + "".join(
        f"| {one.what} | {one.value:,} {one.unit}".rstrip() + f" | {one.above} |\n"
        for one in table()
    )


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")

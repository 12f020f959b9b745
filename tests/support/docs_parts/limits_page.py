"""docs/limits.md, from the table of limits."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz import limits
from sambot_viz.limits import data, drawn, files, meshes, pages

_HEAD = """\
# Limits

This page is generated from `src/sambot_viz/limits/`. Everything that comes from
outside is counted against this table. What is above a limit costs its own topic, file
or page; the rest goes on. Where something is lost that a user has asked for, a sentence
with the limit says so.
"""
_PARTS = {
    "Recordings and live robots": data,
    "What is drawn": drawn,
    "Files of robots and configs": files,
    "Meshes": meshes,
    "Pages": pages,
}


def rows() -> dict[str, limits.LimitRow]:
    """The rows by their names, in the order of the page."""
    return {
        name: row
        for module in _PARTS.values()
        for name, row in vars(module).items()
        if isinstance(row, limits.LimitRow)
    }


def _lines() -> Iterator[str]:
    yield _HEAD
    for heading, module in _PARTS.items():
        yield f"\n## {heading}\n\n| of | at most | above it |\n| --- | ---: | --- |\n"
        for row in vars(module).values():
            if isinstance(row, limits.LimitRow):
                most = f"{row.value:,} {row.unit}".rstrip()
                yield f"| {row.what} | {most} | {row.above} |\n"


def page() -> str:
    """The whole page."""
    return "".join(_lines())

"""Writes the table of conditions into docs/lessons.md.

PYTHONPATH=tests/support python tests/support/lesson_page.py
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from sambot_viz.lessons.conditions.kinds import KINDS
from sambot_viz.lessons.reading.records import keys_of

PAGE = Path(__file__).resolve().parents[2] / "docs" / "lessons.md"
_PART = re.compile(r"(?<=lesson_page.py -->\n).*(?=<!-- end of kinds -->)", re.DOTALL)


def page() -> str:
    """The whole page, with the table of now."""
    table = "\n".join(_rows()) + "\n"
    return _PART.sub(lambda _: table, PAGE.read_text("utf-8"))


def _rows() -> Iterator[str]:
    yield "| kind | holds when | keys |"
    yield "| --- | --- | --- |"
    for name, kind in KINDS.items():
        keys = ", ".join(
            f"**`{key}`**" if needed else f"`{key}`"
            for key, (_, _, needed) in keys_of(kind).items()
        )
        meaning = " ".join((kind.__doc__ or "").split()).rstrip(".")
        yield f"| `{name}` | {meaning[0].lower()}{meaning[1:]} | {keys} |"


if __name__ == "__main__":
    PAGE.write_text(page(), "utf-8")

"""The table of conditions in docs/lessons.md, from their classes."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.lessons.conditions.kinds import KINDS
from sambot_viz.lessons.reading.records import keys_of

_PART = re.compile(r"(?<=<!-- kinds: begin -->\n).*(?=<!-- kinds: end -->)", re.DOTALL)


def page(text: str) -> str:
    """The page with the table of now.

    Raises:
        ValueError: the page has no place for it.
    """
    if not _PART.search(text):
        raise ValueError("the two comments around the table are not there")
    table = "\n".join(_rows()) + "\n"
    return _PART.sub(lambda _: table, text)


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

"""The status of a display as HTML."""

from __future__ import annotations

from collections.abc import Mapping

from sambot_viz.displays.status import Level, Status
from sambot_viz.text import html_text

SHOWN_STATUS_ROWS = 40
"""Rows of a status that are written out; a robot of 300 links has as many."""


def line_html(line: str, level: Level) -> str:
    """One coloured line; `line` is HTML already."""
    return f'<div class="sambot-status sambot-{level.lower()}">{line}</div>'


def status_html(title: str, level: Level | None, rows: Mapping[str, Status]) -> str:
    """A status as RViz words and colours it, its rows folded away when all is well."""
    if level is None:
        return ""
    opened = "" if level == "Ok" else " open"
    bad_first = sorted(rows.items(), key=lambda row: row[1].level == "Ok")
    lines = [
        f'<li class="sambot-{row.level.lower()}"><b>{html_text(key)}</b> '
        f"{html_text(row.text).replace('•', '<br>•')}</li>"
        for key, row in bad_first[:SHOWN_STATUS_ROWS]
    ]
    if len(rows) > SHOWN_STATUS_ROWS:
        lines.append(f"<li>and {len(rows) - SHOWN_STATUS_ROWS} more</li>")
    return (
        f'<details class="sambot-status"{opened}>'
        f'<summary class="sambot-{level.lower()}">{title}: {level}</summary>'
        f"<ul>{''.join(lines)}</ul></details>"
    )

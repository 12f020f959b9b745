"""The table of displays and their properties, for docs/displays.md.

Write it again after a change of the declarations::

    PYTHONPATH=tests/support python -m display_table > docs/displays.md
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.rviz import Property

LEVELS = {
    "full": "shown",
    "approximate": "approximated",
    "none": "not supported",
    "kept": "kept",
}


def display_table() -> str:
    """The whole page."""
    lines = [
        "# Displays and their properties",
        "",
        "Made from the declarations in the code. All other displays and keys of a "
        "file are kept when it is saved.",
    ]
    for kind, display in sorted(DISPLAYS.items()):
        lines += ["", f"## {kind.rpartition('/')[2]}", "", display.help]
        rows = list(_rows(display.properties, ""))
        if rows:
            lines += [
                "",
                "| Property | Default | Level | |",
                "| --- | --- | --- | --- |",
            ]
            lines += rows
    return "\n".join(lines) + "\n"


def _rows(properties: Sequence[Property], above: str) -> Iterator[str]:
    for prop in properties:
        path = f"{above}{prop.name}"
        if prop.has_value or prop.note:
            shown = prop.show(prop.default) if prop.has_value else ""
            default = f"`{shown}`" if shown else ""
            unit = f" {prop.unit}" if prop.unit and default else ""
            about = prop.note or prop.help
            yield f"| {path} | {default}{unit} | {LEVELS[prop.support]} | {about} |"
        yield from _rows(prop.children, f"{path}/")


if __name__ == "__main__":
    print(display_table(), end="")

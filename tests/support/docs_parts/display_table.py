"""docs/displays.md: displays and their properties, from the declarations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.rviz import Property
from sambot_viz.rviz.other_packages import OTHERS, package_of

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
        "",
        "What is drawn is compared with pictures of RViz (`tests/golden`). Outlines "
        "are within a pixel of those of RViz for ROS 1, and within two of those of "
        "RViz 2's own tests, for 97 % of their length or more; colours of flat "
        "patches are within 8 of 255. Lines of one pixel are smoothed otherwise, and "
        "letters are 3.7 % larger than those of RViz for ROS 1, as in RViz 2. What "
        "else differs is said of each display.",
    ]
    for kind, display in sorted(DISPLAYS.items()):
        lines += ["", f"## {kind.rpartition('/')[2]}", "", DISPLAYS.help_of(kind)]
        if display.differs:
            lines += ["", display.differs]
        rows = list(_rows(display.properties, ""))
        if rows:
            lines += [
                "",
                "| Property | Default | Level | |",
                "| --- | --- | --- | --- |",
            ]
            lines += rows
    lines += [
        "",
        "## Displays of other packages",
        "",
        "They are not shown; `sambot-viz config` and the page say of each what it is. "
        "A display of a package that is not in this table is kept in the same way.",
        "",
        "| Class | Package | Shows | From |",
        "| --- | --- | --- | --- |",
    ]
    for kind, (what, needs) in sorted(OTHERS.items()):
        lines.append(f"| `{kind}` | {package_of(kind)} | {what} | {needs} |")
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

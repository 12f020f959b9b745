"""Report which parts of an .rviz file are shown, approximated or not supported."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Literal, TypeAlias

from sambot_viz.errors import Problem
from sambot_viz.rviz.class_items import ClassItem, DisplayConfig
from sambot_viz.rviz.item import ConfigItem
from sambot_viz.rviz.other_packages import about_other
from sambot_viz.rviz.properties.property import KeptProperty, Support
from sambot_viz.rviz.rviz_config import RvizConfig
from sambot_viz.text import text

Level: TypeAlias = Literal[
    "shown", "approximated", "not supported", "kept", "unknown key"
]
"""The level of support.

A "kept" key has no effect in RViz for ROS 2 either; an "unknown key" is one that RViz
does not know.
"""

_LEVELS: dict[Support, Level] = {
    "full": "shown",
    "approximate": "approximated",
    "none": "not supported",
    "kept": "kept",
}
_WIDEST = 40


@dataclass(frozen=True, slots=True)
class PropertyReport:
    """One property of the file.

    Attributes:
        path: keys from its owner on, joined by "/".
        value: what it says; empty for maps that are not declared.
        level: how far it is shown.
        note: a remark on that.
        given: the file says it; otherwise it is a default.
    """

    path: str
    value: str
    level: Level
    note: str = ""
    given: bool = True

    def as_json(self) -> dict[str, Any]:
        """Return the fields for ``--format json``."""
        return asdict(self)


@dataclass(frozen=True, slots=True)
class ItemReport:
    """Global Options, a display, a view or a tool.

    Attributes:
        name: its label.
        class_id: the class as written; empty for Global Options.
        level: "shown", or "not supported" when the class is not known.
        enabled: its box; None where there is none.
        properties: its properties.
        displays: the members of a group.
        note: description of a display of another package; empty for all others.
    """

    name: str
    class_id: str
    level: Level
    enabled: bool | None
    properties: tuple[PropertyReport, ...]
    displays: tuple[ItemReport, ...] = ()
    note: str = ""

    def as_json(self) -> dict[str, Any]:
        """Return the fields for ``--format json``."""
        return {
            "name": self.name,
            "class": self.class_id,
            "level": self.level,
            "note": self.note,
            "enabled": self.enabled,
            "properties": [row.as_json() for row in self.properties],
            "displays": [display.as_json() for display in self.displays],
        }

    def walk(self) -> Iterator[ItemReport]:
        """This item and all members of the group it may be."""
        yield self
        for display in self.displays:
            yield from display.walk()


@dataclass(frozen=True, slots=True)
class ConfigReport:
    """The output of ``sambot-viz config FILE.rviz``.

    Attributes:
        file: the path as the user wrote it.
        global_options: the first row of the displays.
        displays: the displays, groups with their members.
        view: the current view.
        saved_views: the other views.
        tools: the tools of the toolbar.
        panels: the classes of RViz's panels; ours are others, so they are only kept.
        problems: the warnings about the file.
    """

    file: str | None
    global_options: ItemReport
    displays: tuple[ItemReport, ...]
    view: ItemReport
    saved_views: tuple[ItemReport, ...]
    tools: tuple[ItemReport, ...]
    panels: tuple[str, ...]
    problems: tuple[Problem, ...] = field(default_factory=tuple)

    def counts(self) -> dict[Level, int]:
        """Count the displays and given properties of displays on each level."""
        counts: dict[Level, int] = dict.fromkeys((*_LEVELS.values(), "unknown key"), 0)
        for item in (item for display in self.displays for item in display.walk()):
            if item.level == "not supported":
                counts[item.level] += 1
                continue
            for row in item.properties:
                counts[row.level] += row.given
        return counts

    def as_json(self) -> dict[str, Any]:
        """Everything, for ``--format json``."""
        return {
            "file": self.file,
            "counts": dict(self.counts()),
            "global_options": self.global_options.as_json(),
            "displays": [display.as_json() for display in self.displays],
            "view": self.view.as_json(),
            "saved_views": [view.as_json() for view in self.saved_views],
            "tools": [tool.as_json() for tool in self.tools],
            "panels": list(self.panels),
            "problems": [problem.as_json() for problem in self.problems],
        }

    def as_text(self) -> str:
        """A table for people: what the file gives, with the level of each piece."""
        lines = list(_item_lines(self.global_options, 0))
        for display in self.displays:
            lines += ["", *_item_lines(display, 0)]
        lines += ["", *_item_lines(self.view, 0)]
        for title, items in (("Saved views", self.saved_views), ("Tools", self.tools)):
            if items:
                lines += ["", title]
                for item in items:
                    name = text(item.name or item.class_id)
                    lines.append(f"  {name:<{_WIDEST}}  {item.level}")
        if self.panels:
            kept = ", ".join(text(panel) for panel in self.panels)
            lines += ["", f"Panels of RViz, kept in the file: {kept}"]
        all_items = [item for display in self.displays for item in display.walk()]
        unknown = sum(item.level == "not supported" for item in all_items)
        lines += ["", f"{len(all_items)} displays, {unknown} of them not supported"]
        return "\n".join(lines) + "\n"


def config_report(config: RvizConfig) -> ConfigReport:
    """Say what of a config is shown, approximated, not supported, or unknown.

    Args:
        config: the file, read with the declarations of all we can show.
    """
    options = config.global_options
    panels = config.panels if isinstance(config.panels, list) else []
    return ConfigReport(
        file=config.file,
        global_options=ItemReport(
            "Global Options", "", "shown", None, tuple(_properties(options))
        ),
        displays=tuple(_display(display) for display in config.displays),
        view=_item(config.view),
        saved_views=tuple(_item(view) for view in config.saved_views),
        tools=tuple(_item(tool) for tool in config.tools),
        panels=tuple(
            str(panel.get("Class") or "") for panel in panels if isinstance(panel, dict)
        ),
        problems=config.problems,
    )


def _display(display: DisplayConfig) -> ItemReport:
    members = tuple(_display(member) for member in display.displays)
    note = "" if display.supported else about_other(display.kind)
    return replace(_item(display, display.enabled, members), note=note)


def _item(
    item: ClassItem, enabled: bool | None = None, members: tuple[ItemReport, ...] = ()
) -> ItemReport:
    rows = _properties(item) if item.supported else _kept(item)
    level: Level = "shown" if item.supported else "not supported"
    return ItemReport(item.name, item.class_id, level, enabled, tuple(rows), members)


def _properties(item: ConfigItem) -> Iterator[PropertyReport]:
    for path, declared in item.declared.items():
        prop = declared.property
        if isinstance(prop, KeptProperty) and path in item.raw:
            value = item.raw.get(path)
            shown = value if isinstance(value, str) else ""
            yield PropertyReport(path, shown, _LEVELS[prop.support], prop.note)
        if not prop.has_value or prop.read_only:
            continue
        value = prop.show(item.get(path))
        level, given = _LEVELS[prop.support], item.is_given(path)
        yield PropertyReport(path, value, level, prop.note, given)
    for path in item.unknown_keys:
        yield PropertyReport(path, "", "unknown key", "kept in the file")


def _kept(item: ClassItem) -> Iterator[PropertyReport]:
    """Yield the keys of an item whose class is not known."""
    for key, value in item.raw.items():
        if key not in ("Class", "Name", "Enabled", "Value", "Displays"):
            shown = value if isinstance(value, str) else ""
            yield PropertyReport(key, shown, "not supported", "kept in the file")


def _item_lines(item: ItemReport, depth: int) -> Iterator[str]:
    margin = "  " * depth
    known = f" ({text(item.class_id)})" if item.class_id else ""
    box = {True: ", on", False: ", off", None: ""}[item.enabled]
    yield f"{margin}{text(item.name)}{known}{box}: {item.level}"
    if item.level == "not supported":
        if item.note:
            yield f"{margin}  {item.note}"
        count = len(item.properties)
        yield f"{margin}  its {count} properties are kept in the file"
    else:
        yield from _rows([row for row in item.properties if row.given], f"{margin}  ")
    for display in item.displays:
        yield from _item_lines(display, depth + 1)


def _rows(rows: Sequence[PropertyReport], margin: str) -> Iterator[str]:
    if not rows:
        return
    paths = [text(row.path, _WIDEST) for row in rows]
    values = [text(row.value, _WIDEST) for row in rows]
    left, middle = max(map(len, paths)), max(map(len, values))
    for row, path, value in zip(rows, paths, values, strict=True):
        note = f" ({text(row.note)})" if row.note else ""
        yield f"{margin}{path:<{left}}  {value:<{middle}}  {row.level}{note}"

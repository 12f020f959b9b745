"""The Displays panel: RViz's tree of displays, as rows."""

from __future__ import annotations

import itertools
import weakref
from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial
from typing import Any

from sambot_viz.displays.display import Display
from sambot_viz.displays.entries import EntryList
from sambot_viz.displays.status import StatusList
from sambot_viz.errors import UsageError
from sambot_viz.panels.expanded import keep_expanded, mark_expanded
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.property_rows import is_listed, property_row, property_rows
from sambot_viz.panels.row import Level, Row
from sambot_viz.rviz import DisplayConfig
from sambot_viz.rviz.class_name import GROUP, row_text
from sambot_viz.session import Session

OPTIONS, STATUS = "options", "status"
_LEVELS: dict[str, Level] = {"Ok": "ok", "Warn": "warn", "Error": "error"}


class DisplaysPanel(Panel):
    """Global Options, and each display with its status, properties and entries.

    The rows of a single link, joint or frame, and of statuses that are fine, are only
    made when a page has unfolded what they are below: a robot has hundreds.

    Args:
        session: whose displays these are.
        remake: called when a page has unfolded something.
    """

    name = "displays"
    remade_by = frozenset({"config", "robot", "frames", "status"})
    moved_by = frozenset({"joints"})

    def __init__(self, session: Session, remake: Callable[[Panel], None]) -> None:
        self._session = session
        self._remake = remake
        self._numbers: weakref.WeakKeyDictionary[DisplayConfig, int] = (
            weakref.WeakKeyDictionary()
        )
        self._count = itertools.count(1)
        self._unfolded: set[str] = set()
        self._facts: list[tuple[str, EntryList, str]] = []

    def rows(self) -> Sequence[Row]:
        """All rows; a row comes after the one above it."""
        self._facts.clear()
        config = self._session.config
        made = [*self._global_rows(), *self._display_rows(config.displays, "")]
        return [*mark_expanded(made, config.expanded), *self._actions()]

    def keep_unfolded(self, unfolded: Collection[str]) -> None:
        """Write into the document which rows are unfolded, from their ids."""
        config = self._session.config
        made = [*self._global_rows(), *self._display_rows(config.displays, "")]
        keep_expanded(config, made, unfolded)

    def values(self) -> dict[str, Any]:
        """What is shown of links and frames that are unfolded."""
        return {
            _fact_id(row_id, key): value
            for row_id, entries, name in self._facts
            for key, value in entries.facts(name).items()
        }

    # Finding what a row means

    def id_of(self, config: DisplayConfig) -> str:
        """The id of a display's row; it stays the same when the display is moved."""
        if config not in self._numbers:
            self._numbers[config] = next(self._count)
        return f"d{self._numbers[config]}"

    def display_of(self, row_id: str) -> DisplayConfig:
        """The display of a row.

        Raises:
            UsageError: it is not there any more.
        """
        for config, number in self._numbers.items():
            if f"d{number}" == row_id and _is_in(config, self._session):
                return config
        raise UsageError("this display is not there any more")

    # The rows

    def _global_rows(self) -> Iterator[Row]:
        session = self._session
        yield Row(OPTIONS, "", "group", "Global Options", icon="options", expanded=True)
        yield from property_rows(
            session.config.global_options, OPTIONS, session.set_global
        )
        status = session.drawn.global_status()
        yield Row(
            STATUS,
            "",
            "status",
            "Global Status",
            value=status.level,
            level=_LEVELS[status.level],
            expanded=status.level != "Ok",
        )
        yield Row(
            f"{STATUS}/Fixed Frame",
            STATUS,
            "status",
            "Fixed Frame",
            value=status.text,
            level=_LEVELS[status.level],
        )

    def _display_rows(
        self, configs: Sequence[DisplayConfig], above: str
    ) -> Iterator[Row]:
        displays = {id(display.config): display for display in self._session.displays}
        for config in configs:
            row_id, display = self.id_of(config), displays.get(id(config))
            yield self._head(config, display, row_id, above)
            if display is not None:
                yield from self._status_rows(display, row_id)
                yield from self._property_rows(display, row_id)
            elif config.kind != GROUP:
                yield _unsupported(config, row_id)
            yield from self._display_rows(config.displays, row_id)

    def _head(
        self, config: DisplayConfig, display: Display | None, row_id: str, above: str
    ) -> Row:
        level = None
        if display is not None and display.shown:
            level = _LEVELS[display.status.level]
        elif not config.supported:
            level = "info"
        return Row(
            row_id,
            above,
            "display",
            config.name,
            value=config.enabled,
            level=level,
            icon=config.kind.rpartition("/")[2],
            help=_help(config, display),
            bold=True,
            extra={"display": config.kind, "known": config.supported},
            set=partial(self._session.set_enabled, config),
        )

    def _status_rows(self, display: Display, row_id: str) -> Iterator[Row]:
        if not display.shown:
            return
        status, status_id = display.status, f"{row_id}/:status"
        lazy = status.level == "Ok"
        yield Row(
            status_id,
            row_id,
            "status",
            "Status",
            value=status.level,
            level=_LEVELS[status.level],
            expanded=not lazy,
            extra={"lazy": True} if lazy and status.rows else None,
        )
        if not lazy or status_id in self._unfolded:
            yield from _statuses(status, status_id)

    def _property_rows(self, display: Display, row_id: str) -> Iterator[Row]:
        item = display.config
        change = partial(self._session.set_property, display)
        entries = {found.title: found for found in display.entries()}
        for path, declared in item.declared.items():
            if not is_listed(item, declared):
                continue
            found = entries.get(path)
            if declared.property.open_keys and found is None:
                continue
            yield property_row(item, declared, row_id, change)
            if found is not None:
                yield from self._entry_rows(display, found, f"{row_id}/{path}")

    def _entry_rows(
        self, display: Display, entries: EntryList, above: str
    ) -> Iterator[Row]:
        for name in entries.names:
            item, row_id = entries.item(name), f"{above}/{name}"
            change = partial(self._session.set_entry, display, entries.title, name)
            wanted = entries.rows(name) if entries.rows else tuple(item.declared)
            box = "Value" in wanted and "Value" in item.declared
            yield Row(
                row_id,
                above,
                "display" if box else "group",
                name,
                value=item.get("Value") if box else None,
                icon=entries.singular,
                extra={"lazy": True, "entry": True},
                set=partial(change, "Value") if box else None,
            )
            if row_id in self._unfolded:
                self._facts.append((row_id, entries, name))
                for path in wanted:
                    if path != "Value" and path in item.declared:
                        yield property_row(item, item.declared[path], row_id, change)
                for key, value in entries.facts(name).items():
                    yield Row(_fact_id(row_id, key), row_id, "fact", key, value)

    # What the page can ask for

    def _actions(self) -> Iterator[Row]:
        yield _action("displays/unfold", (str,), self._unfold)
        yield _action("displays/duplicate", (str,), self._duplicate)
        yield _action("displays/remove", (str,), self._delete)
        yield _action("displays/rename", (str, str), self._rename)
        yield _action("displays/move", (str, str, int), self._move)

    def _unfold(self, arguments: tuple[str]) -> None:
        (row_id,) = arguments
        if row_id not in self._unfolded:
            self._unfolded.add(row_id)
            self._remake(self)

    def _duplicate(self, arguments: tuple[str]) -> None:
        self._session.duplicate_display(self.display_of(arguments[0]))

    def _delete(self, arguments: tuple[str]) -> None:
        self._session.remove_display(self.display_of(arguments[0]))

    def _rename(self, arguments: tuple[str, str]) -> None:
        row_id, name = arguments
        if not name.strip():
            raise UsageError("a display needs a name")
        self._session.rename_display(self.display_of(row_id), name.strip())

    def _move(self, arguments: tuple[str, str, int]) -> None:
        row_id, group, index = arguments
        into = self.display_of(group) if group else None
        self._session.move_display(self.display_of(row_id), index, into)


def _action(row_id: str, takes: tuple[Any, ...], act: Callable[[Any], object]) -> Row:
    return Row(row_id, "", "action", takes=takes, set=act)


def _statuses(status: StatusList, above: str) -> Iterator[Row]:
    for key, row in status.rows.items():
        yield Row(
            f"{above}/{key}", above, "status", key, row.text, level=_LEVELS[row.level]
        )


def _fact_id(row_id: str, key: str) -> str:
    return f"{row_id}/:{key}"


def _unsupported(config: DisplayConfig, above: str) -> Row:
    return Row(
        f"{above}/:status",
        above,
        "note",
        "Status",
        f"Displays of type {row_text(config.kind)} are not shown yet. It stays in the "
        "file as it is.",
        level="info",
    )


def _help(config: DisplayConfig, display: Display | None) -> str:
    if display is not None:
        return display.help
    if config.kind == GROUP:
        return "Displays that are switched on and off together."
    return f"Displays of type {row_text(config.kind)} are not shown yet."


def _is_in(config: DisplayConfig, session: Session) -> bool:
    siblings = config.parent.displays if config.parent else session.config.displays
    inside = any(config is sibling for sibling in siblings)
    return inside and (config.parent is None or _is_in(config.parent, session))

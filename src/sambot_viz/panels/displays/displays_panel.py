"""The Displays panel: RViz's tree of displays, as rows."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from sambot_viz.displays.display import Display, EntryList
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.errors import UsageError
from sambot_viz.panels.command import Command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.problems.problems_panel import without_folders
from sambot_viz.panels.problems.status_rows import (
    LEVELS,
    STATUS,
    global_status_rows,
    status_rows,
)
from sambot_viz.panels.rows.ids import Ids
from sambot_viz.panels.rows.property_rows import is_listed, property_row, property_rows
from sambot_viz.panels.rows.row import Data, Json, Row
from sambot_viz.panels.unfolded import (
    LazyRows,
    keep_expanded,
    listed_rows,
    mark_expanded,
)
from sambot_viz.rviz import DisplayConfig, FileProperty
from sambot_viz.rviz.declarations import GROUP, row_text
from sambot_viz.rviz.other_packages import about_other
from sambot_viz.session.document.display_edits import DisplayEdits
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.shown_problems import Problems
from sambot_viz.session.signals import Signal, connect

OPTIONS = "options"
Facts = Callable[[], Mapping[str, str]]
"""Returns the values of rows that are only shown, by their names."""


class DisplaysPanel(Panel):
    """Global Options, and each display with its status, properties and entries.

    The rows of links, joints and frames, and of statuses that are fine, are only made
    when a page has unfolded what they are below: a robot has hundreds.

    Args:
        remake: called when a page has unfolded something.
        folders: whether paths of files are whole in the rows of all.
    """

    name = "displays"

    def __init__(
        self,
        document: ShownDocument,
        display_edits: DisplayEdits,
        scene: Scene,
        robot: RobotState,
        problems: Problems,
        remake: Callable[[Panel], None],
        folders: bool = True,
    ) -> None:
        self._folders = folders
        whole = (
            document.replaced,
            document.options,
            document.displays,
            scene.statuses,
            scene.frames,
            robot.changed,
            problems.saves,
        )
        self.remade_by = whole
        self.changed_by = (document.values,)
        self._document = document
        self._display_edits = display_edits
        self._scene = scene
        self._robot = robot
        self._problems = problems
        self._ids = Ids[DisplayConfig]("d")
        self._remake = remake
        self._lazy = LazyRows("displays/unfold", self._unfolded)
        # Rows as they were made at a revision of their display: a number that is set
        # makes only the rows of its display again.
        self._made: dict[DisplayConfig, tuple[int, list[Row]]] = {}
        self._facts: dict[DisplayConfig, list[tuple[str, Facts]]] = {}
        self._listed: frozenset[str] | None = None
        self._disconnect = connect(whole, self._forget)

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """The poses of links and frames, and the facts, that are unfolded."""
        return (self._robot.positions,) if any(self._facts.values()) else ()

    def close(self) -> None:
        """Follow the session no longer."""
        self._disconnect()

    def _forget(self) -> None:
        # What can be unfolded stays so until other rows are made: a page that asks in
        # between would wait for ever.
        self._made.clear()
        self._facts.clear()

    def _unfolded(self) -> None:
        self._forget()
        self._remake(self)

    def rows(self) -> Sequence[Row]:
        """Return all rows, each after its parent."""
        tree = self._tree()
        now = self.values()
        rows = (
            # It was made before the last motion.
            replace(row, value=now[row.id])
            if row.id in now and row.value != now[row.id]
            else row
            for row in tree
        )
        self._listed = listed_rows(tree, self._document.config.expanded)
        return [mark_expanded(row, self._listed) for row in rows]

    def data(self) -> Sequence[Data]:
        """Return the rows of what has a status of the level Error."""
        return [Data("displays/errors", [*self._with_errors()])]

    def _with_errors(self) -> Iterator[str]:
        if self._scene.global_status().level == "Error":
            yield STATUS
        for display in self._scene.displays:
            if display.shown and display.status.level == "Error":
                yield self.id_of(display.config)

    def changed_rows(self) -> Sequence[Row] | None:
        """Return what numbers that were set have changed in the rows of displays."""
        changed: list[Row] = []
        for display in self._scene.displays:
            if display.config not in self._made:
                return None
            revision, before = self._made[display.config]
            if revision != display.revision:
                rows = self._make(display.config, display, before[0].parent)
                if [row.id for row in rows] != [row.id for row in before]:
                    return None
                both = zip(rows, before, strict=True)
                changed += (row for row, was in both if row != was)
        return [mark_expanded(row, self._listed) for row in changed]

    def commands(self) -> list[Command]:
        """Return the command to unfold a row."""
        return [self._lazy.command()]

    def keep_unfolded(self, unfolded: Collection[str]) -> None:
        """Write into the document which rows are unfolded, from their ids."""
        keep_expanded(self._document.config, self._tree(), unfolded)
        # All rows are made with that from the next change on.
        self._made.clear()

    def _tree(self) -> list[Row]:
        if not self._made:
            self._lazy.clear()
        configs = self._document.config.displays
        return [*self._global_rows(), *self._display_rows(configs, "")]

    def values(self) -> Mapping[str, Json]:
        """Return the read-only data of unfolded links, frames and values."""
        return {
            _fact_id(row_id, key): value
            for shown in self._facts.values()
            for row_id, facts in shown
            for key, value in facts().items()
        }

    # Finding the object of a row

    def id_of(self, config: DisplayConfig) -> str:
        """Return the id of a display's row; it stays the same when it is moved."""
        return self._ids.of(config)

    def display_of(self, row_id: str) -> DisplayConfig:
        """Return the display of a row.

        Raises:
            UsageError: it no longer exists.
        """
        config = self._ids.find(row_id)
        if config is None or not self._document.config.holds(config):
            raise UsageError("this display no longer exists")
        return config

    # The rows

    def _global_rows(self) -> Iterator[Row]:
        document = self._document
        yield Row(OPTIONS, "", "group", "Global Options", icon="options", expanded=True)
        yield from property_rows(
            document.config.global_options, OPTIONS, document.set_option
        )
        yield from global_status_rows(self._scene)

    def _display_rows(
        self, configs: Sequence[DisplayConfig], parent: str
    ) -> Iterator[Row]:
        displays = {id(display.config): display for display in self._scene.displays}
        for config in configs:
            display = displays.get(id(config))
            revision = 0 if display is None else display.revision
            if config not in self._made or self._made[config][0] != revision:
                self._make(config, display, parent)
            yield from self._made[config][1]
            yield from self._display_rows(config.displays, self.id_of(config))

    def _make(
        self, config: DisplayConfig, display: Display | None, parent: str
    ) -> list[Row]:
        self._facts[config] = []
        rows = [self._for_all(row) for row in self._rows_of(config, display, parent)]
        self._made[config] = (0 if display is None else display.revision, rows)
        return rows

    def _for_all(self, row: Row) -> Row:
        """Leave out the folders of this computer, where viewers see the row."""
        if self._folders or row.kind not in ("file", "status"):
            return row
        return replace(row, value=without_folders(row.value))

    def whole_texts(self) -> dict[str, str]:
        """Return the texts that the rows of all have without folders, by their ids."""
        texts: dict[str, str] = {}
        for display in () if self._folders else self._scene.displays:
            row_id, config = self.id_of(display.config), display.config
            for path, declared in config.declared.items():
                if isinstance(declared.property, FileProperty):
                    texts[f"{row_id}/{path}"] = str(config.get(path))
            for key, status in display.status.rows.items():
                texts[f"{row_id}/:status/{key}"] = status.text
        return {key: one for key, one in texts.items() if without_folders(one) != one}

    def _rows_of(
        self, config: DisplayConfig, display: Display | None, parent: str
    ) -> Iterator[Row]:
        row_id = self.id_of(config)
        yield self._head(config, display, row_id, parent)
        if display is None:
            yield _unsupported(config, row_id)
        elif config.kind != GROUP:
            if display.shown:
                yield from self._status_rows(display, row_id)
            yield from self._property_rows(display, row_id)

    def _head(
        self, config: DisplayConfig, display: Display | None, row_id: str, parent: str
    ) -> Row:
        level = None
        if display is not None and display.shown:
            level = LEVELS[display.status.level]
        elif not config.supported:
            level = "info"
        return Row(
            row_id,
            parent,
            "display",
            config.name or config.kind.rpartition("/")[2],
            value=config.enabled,
            level=level,
            icon=config.kind.rpartition("/")[2],
            help=_help(config, display),
            bold=True,
            extra={"display": config.kind, "group": config.kind == GROUP},
            set=partial(self._display_edits.set_enabled, config),
        )

    def _status_rows(self, display: Display, parent: str) -> Iterator[Row]:
        row_id = f"{parent}/:status"
        # Without a robot, the problems that explain why.
        of_model = self._problems.of_newest
        mistakes = of_model if self._robot.model is None else ()
        unfolded = self._lazy.is_unfolded(row_id)
        listed = self._problems.shown.value.listed
        return status_rows(
            display, row_id, parent, self._scene, mistakes, listed, all_rows=unfolded
        )

    def _property_rows(self, display: Display, parent: str) -> Iterator[Row]:
        item = display.config
        change = partial(self._display_edits.set_property, display)
        entries = {found.title: found for found in display.entries()}
        notes, options, facts = display.notes(), display.options(), display.facts()
        of_list: dict[str, list[Row]] = {}
        for path, declared in item.declared.items():
            if not is_listed(item, declared):
                continue
            of = declared.above or declared
            if of.property.open_keys and of.path not in entries:
                continue
            row = property_row(item, declared, parent, change)
            if path in options:
                row = replace(row, kind="enum", editable=True, options=options[path])
            # The links of a robot come after the properties of their list, and facts
            # after those of their group.
            for title in [t for t in of_list if not path.startswith(f"{t}/")]:
                yield from of_list.pop(title)
            if path in entries:
                found = entries[path]
                unfolded = self._lazy.is_unfolded(row.id)
                row = replace(row, extra={"lazy": bool(found.names) and not unfolded})
                if unfolded:
                    of_list[path] = [*self._entry_rows(display, found, row.id)]
            if path in facts:
                unfolded = self._lazy.is_unfolded(row.id)
                row = replace(row, extra={"lazy": not unfolded})
                if unfolded:
                    rows = self._fact_rows(display, facts[path], row.id)
                    # They are sentences.
                    of_list[path] = [replace(r, extra={"wraps": True}) for r in rows]
            yield row
            if path in notes:
                yield Row(f"{row.id}/:note", row.parent, "note", value=notes[path])
        for rows in of_list.values():
            yield from rows

    def _entry_rows(
        self, display: Display, entries: EntryList, parent: str
    ) -> Iterator[Row]:
        for name in entries.names:
            item, row_id = entries.item(name), _entry_id(parent, name)
            edits = self._display_edits
            change = partial(edits.set_entry, display, entries.title, name)
            wanted = entries.rows(name) if entries.rows else tuple(item.declared)
            box = "Value" in wanted and "Value" in item.declared
            unfolded = not entries.has_details or self._lazy.is_unfolded(row_id)
            above = entries.above.get(name)
            yield Row(
                row_id,
                parent if above is None else _entry_id(parent, above),
                "display" if box else "group",
                name if above is None else name[len(above) + 1 :],
                value=item.get("Value") if box else None,
                icon=entries.singular,
                extra={"lazy": not unfolded, "entry": True},
                set=partial(change, "Value") if box else None,
            )
            if not (unfolded and entries.has_details):
                continue
            for path in wanted:
                if path != "Value" and path in item.declared:
                    yield property_row(item, item.declared[path], row_id, change)
            facts = partial(entries.facts, name)
            yield from self._fact_rows(display, facts, row_id)

    def _fact_rows(self, display: Display, facts: Facts, parent: str) -> Iterator[Row]:
        self._facts[display.config].append((parent, facts))
        for key, value in facts().items():
            yield Row(_fact_id(parent, key), parent, "readonly", key, value)


def _entry_id(parent: str, name: str) -> str:
    """Return the id of a link, joint or frame; its name may hold slashes."""
    return f"{parent}/={name.replace('%', '%25').replace('/', '%2F')}"


def _fact_id(row_id: str, key: str) -> str:
    return f"{row_id}/:{key}"


def _unsupported(config: DisplayConfig, parent: str) -> Row:
    about = about_other(config.kind)
    why = f". {about}" if about else ": this version does not know this type."
    sentence = f"Not shown{why} It stays in the file as it is."
    return Row(f"{parent}/:status", parent, "note", "Status", sentence, level="info")


def _help(config: DisplayConfig, display: Display | None) -> str:
    return row_text(config.kind) if display is None else DISPLAYS.help_of(config.kind)

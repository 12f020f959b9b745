"""The Displays panel: Global Options, and each display with its properties."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import viser

from sambot_viz.displays.display import Display
from sambot_viz.displays.entries import EntryList
from sambot_viz.panels.arrange import Arrange, labelled
from sambot_viz.panels.config_file import ConfigFile
from sambot_viz.panels.entry_rows import EntryRows
from sambot_viz.panels.status_html import line_html, status_html
from sambot_viz.panels.widgets import Input, add_property, frame_choices, watch
from sambot_viz.rviz import ConfigItem, Property, TfFrameProperty
from sambot_viz.session import Event, Session, walk
from sambot_viz.text import html_text, text

Change = Callable[[str, Any], None]
"""Sets the property at a path to a value."""


class DisplaysPanel:
    """RViz's tree of displays as folders.

    Args:
        session: whose displays these are.
        container: the folder or panel to fill.
    """

    def __init__(self, session: Session, container: viser.GuiFolderHandle) -> None:
        self._session = session
        self._gui = session.audience.gui
        self._container = container
        self._rows: list[_DisplayRows] = []
        self._options: _ItemRows | None = None
        self._folder: viser.GuiFolderHandle | None = None
        self._statuses: viser.GuiHtmlHandle | None = None
        self._arrange: Arrange | None = None
        self._built: tuple[object, ...] = ()
        with container:
            self._file = ConfigFile(session)
        session.listeners.append(self._hear)
        self._build()

    def close(self) -> None:
        """Follow the session no longer."""
        self._session.listeners.remove(self._hear)
        self._file.close()
        self._drop()

    def _hear(self, event: Event) -> None:
        if event == "joints":
            for row in self._rows:
                row.moved()
            return
        if event in ("config", "robot") and self._state() != self._built:
            self._build()
        elif event in ("frames", "robot"):
            names = self._frame_names()
            if self._options is not None:
                self._options.offer_frames(names)
            for row in self._rows:
                row.rows.offer_frames(names)
                row.offer_entries()
        elif event == "status":
            for row in self._rows:
                row.offer_entries()
        self._write_statuses()

    def _state(self) -> tuple[object, ...]:
        """What the rows are made from; they are made again when it differs."""
        config = self._session.config
        return (
            id(config),
            tuple((id(item), label) for label, item in labelled(config.displays)),
            tuple(
                tuple(entries.title for entries in display.entries())
                for display in self._session.displays
            ),
        )

    def _drop(self) -> None:
        for row in self._rows:
            row.close()
        self._rows.clear()
        if self._folder is not None:
            self._folder.remove()

    def _build(self) -> None:
        gui, session = self._gui, self._session
        self._drop()
        self._built = self._state()
        displays = {id(display.config): display for display in session.displays}
        with self._container:
            self._folder = gui.add_folder(None)
        with self._folder:
            with gui.add_folder("Global Options"):
                self._options = _ItemRows(
                    session,
                    session.config.global_options,
                    session.set_global,
                    self._frame_names(),
                )
            self._statuses = gui.add_html("")
            with gui.add_folder("Displays"):
                for label, item in labelled(session.config.displays):
                    display = displays.get(id(item))
                    if display is not None:
                        _add_box(gui, session, display, label)
                self._list_unsupported()
            for _, item in labelled(session.config.displays):
                display = displays.get(id(item))
                if display is not None and display.properties:
                    row = _DisplayRows(session, display, self._frame_names())
                    self._rows.append(row)
            chosen = self._arrange.chosen if self._arrange is not None else None
            self._arrange = Arrange(session, chosen)
        self._write_statuses()

    def _frame_names(self) -> Sequence[str]:
        return sorted(self._session.tree.frames)

    def _write_statuses(self) -> None:
        for row in self._rows:
            row.write_status()
        if self._statuses is not None:
            status = self._session.drawn.global_status()
            lines = [
                status_html("Global Status", status.level, {"Fixed Frame": status})
            ]
            for row in self._rows:
                level = row.display.status.level
                if row.display.shown and level != "Ok":
                    name = html_text(row.display.config.name)
                    lines.append(line_html(f"{name}: {level}", level))
            content = "".join(lines)
            if self._statuses.content != content:
                self._statuses.content = content

    def _list_unsupported(self) -> None:
        names = [
            f"{item.name} ({item.class_id})"
            for item in walk(self._session.config.displays)
            if not item.supported
        ]
        if names:
            rows = "".join(f"<li>{html_text(name)}</li>" for name in names)
            self._gui.add_html(
                '<details class="sambot-status"><summary>Not supported yet: '
                f"{len(names)}</summary><ul>{rows}</ul></details>"
            )


EntryFolder = Callable[[str], None]
"""Fills the folder of links, joints or frames, if there are any under that title."""


class _ItemRows:
    """The inputs of one item's properties, in the current container."""

    def __init__(
        self,
        session: Session,
        item: ConfigItem,
        change: Change,
        frames: Sequence[str],
        entries: Mapping[str, EntryFolder] | None = None,
    ) -> None:
        self._session = session
        self._gui = session.audience.gui
        self._item = item
        self._change = change
        self._entries = entries or {}
        self._inputs: dict[str, tuple[Input, Property]] = {}
        top = [d.property for path, d in item.declared.items() if "/" not in path]
        self._add_all(top, "", frames)
        self._hide_what_is_off()

    def offer_frames(self, frames: Sequence[str]) -> None:
        """The lists of frames offer the frames that exist."""
        for path, (handle, prop) in self._inputs.items():
            if isinstance(prop, TfFrameProperty) and isinstance(
                handle, viser.GuiDropdownHandle
            ):
                value = self._item.get(path)
                handle.options = frame_choices(prop, frames, value)
                handle.value = text(value)

    def _add_all(
        self, properties: Sequence[Property], above: str, frames: Sequence[str]
    ) -> None:
        for prop in properties:
            path = f"{above}{prop.name}"
            if prop.support == "none":
                continue
            if prop.has_value:
                get, change = partial(self._item.get, path), partial(self._set, path)
                handle = add_property(self._session, prop, get, change, frames)
                self._inputs[path] = (handle, prop)
                self._add_all(prop.children, f"{path}/", frames)
            elif not prop.open_keys:
                with self._gui.add_folder(prop.name, expand_by_default=False):
                    self._add_all(prop.children, f"{path}/", frames)
            elif path in self._entries:
                with self._gui.add_folder(prop.name, expand_by_default=False):
                    kept = [p for p in prop.children if p.support == "full"]
                    self._add_all(kept, f"{path}/", frames)
                    self._entries[path](path)

    def _set(self, path: str, value: Any) -> None:
        self._change(path, value)
        self._hide_what_is_off()

    def _hide_what_is_off(self) -> None:
        """Rows that only make sense for another value are hidden, as in RViz."""
        for path, (handle, _) in self._inputs.items():
            handle.visible = self._item.is_shown(path)


def _add_box(gui: viser.GuiApi, session: Session, display: Display, label: str) -> None:
    """The box that switches a display on and off."""
    config = display.config
    box = gui.add_checkbox(label, config.enabled, hint=text(display.help))
    watch(session, box, bool, partial(session.set_enabled, display))


class _DisplayRows:
    """The folder of one display: its status and its properties."""

    def __init__(
        self, session: Session, display: Display, frames: Sequence[str]
    ) -> None:
        self.display = display
        self._session = session
        self._version = -1
        self._was_shown: bool | None = None
        self._entries: list[EntryRows] = []
        gui, config = session.audience.gui, display.config
        with gui.add_folder(text(config.name, 40), expand_by_default=False):
            self._status = gui.add_html("")
            change = partial(session.set_property, display)
            folders = {found.title: self._add_entries for found in display.entries()}
            self.rows = _ItemRows(session, config, change, frames, folders)

    def close(self) -> None:
        """Write nothing any more."""
        for entries in self._entries:
            entries.close()

    def offer_entries(self) -> None:
        """The links, joints or frames may be others, or have other values."""
        for entries in self._entries:
            entries.offer()

    def moved(self) -> None:
        """Something has moved: positions follow."""
        for entries in self._entries:
            entries.moved()

    def _add_entries(self, title: str) -> None:
        find = partial(_entries_of, self.display, title)
        self._entries.append(EntryRows(self._session, self.display, find))

    def write_status(self) -> None:
        """Write the status again if it has changed."""
        status, shown = self.display.status, self.display.shown
        if (status.version, shown) == (self._version, self._was_shown):
            return
        self._version, self._was_shown = status.version, shown
        level = status.level if shown else None
        self._status.content = status_html("Status", level, status.rows)


def _entries_of(display: Display, title: str) -> EntryList | None:
    return next((found for found in display.entries() if found.title == title), None)

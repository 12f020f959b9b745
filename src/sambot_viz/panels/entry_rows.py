"""The rows of one link, joint or frame: a list to choose from, then what it has.

Hundreds of links with five rows each would be thousands of widgets; here there are a
dozen, for the one that was chosen.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import viser

from sambot_viz.displays.display import Display
from sambot_viz.displays.entries import EntryList
from sambot_viz.panels.widgets import Input, add_property, options, watch
from sambot_viz.rviz import ConfigItem
from sambot_viz.session import Session
from sambot_viz.session.throttle import Throttle
from sambot_viz.text import html_text, text

NOTHING: str = "—"
FACTS_PERIOD = 0.5
"""Positions of the chosen one are written this often while it moves [s]."""


class EntryRows:
    """A list of names and the rows of the chosen one, in the current container.

    Args:
        session: whose display it is.
        display: whose links, joints or frames they are.
        entries: gives them as they are now, or None while there are none.
    """

    def __init__(
        self,
        session: Session,
        display: Display,
        entries: Callable[[], EntryList | None],
    ) -> None:
        self._session = session
        self._gui = session.audience.gui
        self._display = display
        self._entries = entries
        self._chosen: str | None = None
        self._inputs: dict[str, Input] = {}
        self._facts_shown = ""
        found = entries()
        singular = found.singular if found else "entry"
        self._names = dict[str, str]()
        self._list = self._gui.add_dropdown(
            singular.capitalize(),
            (NOTHING,),
            initial_value=NOTHING,
            hint=f"Choose a {singular}; type to search.",
        )
        watch(self._session, self._list, self._named, self._choose)
        self._folder = self._gui.add_folder(None, visible=False)
        self._facts: viser.GuiHtmlHandle | None = None
        self._pacer = Throttle(session.worker, FACTS_PERIOD, self._follow)
        self.offer()

    def close(self) -> None:
        """Write nothing any more."""
        self._pacer.close()

    def offer(self) -> None:
        """The list offers those there are; the rows show what holds."""
        found = self._entries()
        names = found.names if found else ()
        shown = {text(name): name for name in reversed(names)}
        self._names = {label: shown[label] for label in options(names, NOTHING)[:-1]}
        offered = (NOTHING, *self._names)
        if tuple(self._list.options) != offered:
            self._list.options = offered
            if self._chosen not in names:
                self._chosen = None
            self._list.value = NOTHING if self._chosen is None else text(self._chosen)
        self._show()

    def moved(self) -> None:
        """Something has moved: the position follows, not too often."""
        if self._chosen is not None:
            self._pacer.request()

    def _named(self, label: Any) -> str:
        """A label that is offered.

        Raises:
            ValueError: it is not.
        """
        if label != NOTHING and label not in self._names:
            raise ValueError("not offered")
        return str(label)

    def _choose(self, label: str) -> None:
        with self._session.change():
            self._chosen = self._names.get(label)
            self._show()

    def _show(self) -> None:
        found = self._entries()
        if found is None or self._chosen is None:
            self._folder.visible = False
            return
        if not self._inputs:
            self._build(found.item(self._chosen))
        item = found.item(self._chosen)
        wanted = found.rows(self._chosen) if found.rows else tuple(item.declared)
        for name, handle in self._inputs.items():
            handle.visible = name in wanted
            if handle.value != item.get(name):
                handle.value = item.get(name)
        self._folder.visible = True
        self._write_facts()

    def _build(self, item: ConfigItem) -> None:
        with self._folder:
            for path, declared in item.declared.items():
                prop = declared.property
                # A box is saved as "Value"; RViz shows it beside the name.
                shown = replace(prop, name="Enabled") if path == "Value" else prop
                self._inputs[path] = add_property(
                    self._session,
                    shown,
                    partial(self._get, item, path),
                    partial(self._set, path),
                )
            self._facts = self._gui.add_html("")

    def _get(self, first: ConfigItem, path: str) -> Any:
        """The value of the chosen one; of the first that was chosen while none is."""
        found = self._entries()
        if found is None or self._chosen is None:
            return first.get(path)
        return found.item(self._chosen).get(path)

    def _set(self, row: str, value: Any) -> None:
        found = self._entries()
        if found is None or self._chosen is None:
            return
        self._session.set_entry(self._display, found.title, self._chosen, row, value)

    def _follow(self) -> None:
        with self._session.change():
            self._write_facts()

    def _write_facts(self) -> None:
        found = self._entries()
        if found is None or self._chosen is None or self._facts is None:
            return
        rows = "".join(
            f"<tr><th>{html_text(name)}</th><td>{html_text(value)}</td></tr>"
            for name, value in found.facts(self._chosen).items()
        )
        if rows != self._facts_shown:
            self._facts_shown = rows
            self._facts.content = f'<table class="sambot-facts">{rows}</table>'

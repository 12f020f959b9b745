"""The Views panel: the type of view, its numbers, and the saved views.

What is set here moves the cameras of all browsers of the session; what a mouse moves
is its own browser's camera, and these numbers follow it (see `view_control`).
"""

from __future__ import annotations

from functools import partial
from typing import Any

import viser

from sambot_viz.panels.picture import PictureRows
from sambot_viz.panels.tools import follow_browsers
from sambot_viz.panels.widgets import (
    Input,
    add_property,
    frame_choices,
    on_click,
    options,
    watch,
)
from sambot_viz.rviz import (
    FloatProperty,
    Property,
    TfFrameProperty,
    VectorProperty,
    ViewConfig,
)
from sambot_viz.rviz.class_name import row_text
from sambot_viz.session import Event, Session
from sambot_viz.session.browser_view import BrowserView
from sambot_viz.text import html_text, text
from sambot_viz.views.registry import VIEWS

DIGITS = 5
"""Decimals that are shown of a number; the document keeps all."""
NO_SAVED = "none yet"


class ViewsPanel:
    """The type of the view, its numbers, and the saved views of one session.

    Args:
        session: whose view this is.
        container: the tab to fill.
    """

    def __init__(self, session: Session, container: viser.GuiTabHandle) -> None:
        self._session = session
        self._gui = session.audience.gui
        self._container = container
        self._inputs: dict[str, tuple[Input, Property]] = {}
        self._folder: viser.GuiFolderHandle | None = None
        self._built: ViewConfig | None = None
        self._saved: list[str] = []
        session.listeners.append(self._hear)
        follow_browsers(session, self._hear)
        self._build()

    def close(self) -> None:
        """Follow the session no longer."""
        self._session.listeners.remove(self._hear)

    @property
    def _views(self) -> BrowserView | None:
        # The panels of one browser are rows of its own soon; until then, the first.
        browser = next(iter(self._session.browsers.values()), None)
        return None if browser is None else browser.view

    def _hear(self, event: Event) -> None:
        if self._views is None:
            return
        if event in ("view", "config"):
            if self._built is not self._views.view.config:
                self._build()
            elif self._saved != self._saved_labels():
                self._build()
            else:
                self._show_values()
        elif event in ("frames", "robot"):
            self._offer_frames()

    def _build(self) -> None:
        if self._folder is not None:
            self._folder.remove()
        self._inputs.clear()
        if self._views is None:
            return
        self._built = self._views.view.config
        self._saved = self._saved_labels()
        with self._container:
            self._folder = self._gui.add_folder(None)
        with self._folder:
            self._add_type(self._views)
            self._add_rows(self._views)
            self._add_saved(self._views)
            PictureRows(self._session)

    def _add_type(self, views: BrowserView) -> None:
        gui = self._gui
        view = views.view
        labels = {row_text(kind): kind for kind in VIEWS}
        kind = gui.add_dropdown(
            "Type", tuple(labels), initial_value=row_text(view.kind), hint=view.help
        )
        watch(self._session, kind, labels.__getitem__, views.set_kind)
        if not views.supported:
            name = html_text(self._session.config.view.class_id)
            gui.add_html(
                f'<p class="sambot-note sambot-warn">The config asks for a view of '
                f"type {name}, which is not known here: shown as Orbit, and kept as "
                "it is in the file.</p>"
            )
        zero = gui.add_button("Zero", hint="Back to where this type starts (key Z).")
        on_click(self._session, zero, views.zero)

    def _add_rows(self, views: BrowserView) -> None:
        config = views.view.config
        for path, declared in config.declared.items():
            prop = declared.property
            if prop.support == "none" or not prop.has_value:
                continue
            handle = add_property(
                self._session,
                prop,
                partial(self._shown_value, views, prop, path),
                partial(views.set, path),
                sorted(self._session.tree.frames),
            )
            self._inputs[path] = (handle, prop)
        follow = self._gui.add_checkbox(
            "Follow the presenter",
            self._session.follow_presenter,
            hint="All browsers show what the camera shows that moved last.",
        )
        watch(self._session, follow, bool, self._follow)

    def _shown_value(self, views: BrowserView, prop: Property, path: str) -> Any:
        return _shown(prop, views.values[path])

    def _follow(self, on: bool) -> None:
        self._session.follow_presenter = on

    def _add_saved(self, views: BrowserView) -> None:
        gui = self._gui
        saved = self._session.config.saved_views
        with gui.add_folder("Saved views"):
            labels = self._saved or [NO_SAVED]
            chosen = gui.add_dropdown(
                "View", options(labels, labels[-1]), initial_value=labels[-1]
            )
            chosen.disabled = not saved

            def pick() -> ViewConfig:
                return saved[labels.index(chosen.value)]

            save = gui.add_button("Save", hint="Add the current view to the list.")
            on_click(self._session, save, lambda: void(views.save()))
            if not saved:
                return
            use = gui.add_button("Use", hint="Make a copy the current view.")
            on_click(self._session, use, lambda: views.use(pick()))
            name = gui.add_text("Name", "", hint="A new name for the chosen view.")
            rename = gui.add_button("Rename")
            on_click(
                self._session,
                rename,
                lambda: views.rename(pick(), text(name.value, 100)),
            )
            remove = gui.add_button("Remove")
            on_click(self._session, remove, lambda: views.remove(pick()))

    def _saved_labels(self) -> list[str]:
        views = self._session.config.saved_views
        return [
            f"{i}: {text(view.name or view.class_id, 40)}"
            for i, view in enumerate(views, 1)
        ]

    def _show_values(self) -> None:
        """Bring the numbers in line with the view; only what differs is sent."""
        views = self._views
        for path, (handle, prop) in self._inputs.items() if views else ():
            assert views is not None
            value = self._shown_value(views, prop, path)
            if handle.value != value:
                handle.value = value

    def _offer_frames(self) -> None:
        frames, views = sorted(self._session.tree.frames), self._views
        for path, (handle, prop) in self._inputs.items() if views else ():
            assert views is not None
            if isinstance(prop, TfFrameProperty) and isinstance(
                handle, viser.GuiDropdownHandle
            ):
                value = views.values[path]
                offered = frame_choices(prop, frames, value)
                if handle.options != offered:
                    handle.options = offered
                    handle.value = text(value)


def void(value: object) -> None:
    """Drop a value, for callbacks that give none."""
    del value


def _shown(prop: Property, value: Any) -> Any:
    """A value as the panel shows it: with as many digits as a hand can use."""
    if isinstance(prop, FloatProperty):
        short = round(float(value), DIGITS)
        # The last digit may round it out of its range, which viser refuses.
        if prop.minimum is not None:
            short = max(short, prop.minimum)
        return short if prop.maximum is None else min(short, prop.maximum)
    if isinstance(prop, VectorProperty):
        return tuple(round(float(v), DIGITS) for v in value)
    return value

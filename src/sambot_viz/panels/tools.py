"""The toolbar: the tools with their keys, and what else a window has buttons for.

Its buttons are HTML, because viser's own cannot show which one is current. A click on
one is a press of its key, which viser's commands hear; so there is one way to each.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Literal

import viser

from sambot_viz import page
from sambot_viz.session import Event, Session
from sambot_viz.text import html_text
from sambot_viz.tools.tool import Key, Tool
from sambot_viz.views.registry import VIEWS


class ToolBar:
    """See the module.

    Args:
        session: whose tools these are.
        container: the folder or panel to fill.
    """

    def __init__(self, session: Session, container: viser.GuiFolderHandle) -> None:
        self._session = session
        self._gui = session.audience.gui
        with container:
            self._bar = self._gui.add_html(self._html())
            self._mark = self._gui.add_html(self._mark_html())
        self._add_commands()
        session.listeners.append(self._hear)

    def close(self) -> None:
        """Follow the session no longer."""
        self._session.listeners.remove(self._hear)

    def _hear(self, event: Event) -> None:
        if event in ("tools", "config"):
            content = self._html()
            if self._bar.content != content:
                self._bar.content = content
        if event in ("view", "config"):
            content = self._mark_html()
            if self._mark.content != content:
                self._mark.content = content

    def _html(self) -> str:
        tools = self._session.tools
        buttons = "".join(_tool_button(t, t is tools.current) for t in tools.tools)
        said = html_text(tools.status or tools.current.help)
        return (
            f'<div class="sambot-tools">{buttons}'
            f'<button title="Zero the view (Z)" {_presses("z")}>Zero</button>'
            f'<button title="Draw everything anew (R)" {_presses("r")}>Reset</button>'
            f'<button title="The whole screen" onclick="{FULL_SCREEN}">'
            "Full screen</button>"
            f'<button title="Hide the panels; H shows them again" onclick="{HIDE}">'
            "Hide</button></div>"
            f'<div class="sambot-note">{said}</div>'
        )

    def _mark_html(self) -> str:
        return page.mouse_element(self._session.views.view.kind.rpartition("/")[2])

    def _add_commands(self) -> None:
        tools, views = self._session.tools, self._session.views
        for tool in tools.tools:
            self._add(tool.label, tool.key, lambda _, k=tool.kind: tools.press(k))
        self._add("Focus on the selection", "F", tools.focus)
        self._add("Zero the view", "Z", lambda _: views.zero())
        self._add("Reset", "R", lambda _: self._session.refresh())
        self._add("Default tool", "escape", lambda _: tools.escape())
        for kind in VIEWS:
            name = kind.rpartition("/")[2]
            self._add(f"View: {name}", None, lambda _, k=kind: views.set_kind(k))

    def _add(
        self,
        label: str,
        key: Key | Literal["F", "Z", "R", "escape"] | None,
        action: Callable[[int], None],
    ) -> None:
        """A command; `action` takes the number of the browser that asked."""
        command = self._gui.add_command(label, hotkey=key)

        async def triggered(event: viser.CommandEvent) -> None:
            if event.client_id is not None:
                self._session.worker.post(partial(action, event.client_id))

        command.on_trigger(triggered)


FULL_SCREEN = (
    "document.fullscreenElement ? document.exitFullscreen()"
    " : document.documentElement.requestFullscreen()"
)
HIDE = "document.body.classList.toggle('sambot-bare')"


def _presses(key: str) -> str:
    """The attribute with which a button presses a key; the keys are our own."""
    return (
        'onclick="this.blur(); document.documentElement.dispatchEvent('
        f"new KeyboardEvent('keydown', {{key: '{key}', code: 'Key{key.upper()}',"
        ' bubbles: true}))"'
    )


def _tool_button(tool: Tool, current: bool) -> str:
    pressed = "true" if current else "false"
    return (
        f'<button aria-pressed="{pressed}" title="{html_text(tool.label)} '
        f'({tool.key}): {html_text(tool.help)}" {_presses(tool.key.lower())}>'
        f"{html_text(tool.label)}</button>"
    )

"""The toolbar: a button for each tool, and buttons for the view and the window.

The buttons are HTML, because viser's own cannot show which one is current. Each
triggers a viser command, as the command palette does. A tool has two commands: its
button always chooses it, its key follows RViz's rules for keys.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Literal

import viser

from sambot_viz import page, viser_private
from sambot_viz.session import Browser, Event, Session
from sambot_viz.text import html_text
from sambot_viz.tools.registry import TOOLS
from sambot_viz.tools.tool import Key, Tool
from sambot_viz.views.registry import VIEWS

CommandKey = Key | Literal["F", "Z", "R", "escape"]
Action = Callable[[int], None]
"""What a command does; it takes the number of the browser that asked."""
FOCUS, ZERO, RESET = "Focus on the selection", "Zero the view", "Reset"
FULL_SCREEN = (
    "document.fullscreenElement ? document.exitFullscreen()"
    " : document.documentElement.requestFullscreen()"
)
HIDE = "document.body.classList.toggle('sambot-bare')"


class ToolBar:
    """The toolbar of one session, with the hint of the current tool below it.

    Args:
        session: the session whose tools these are.
        container: the folder or panel to fill.
    """

    def __init__(self, session: Session, container: viser.GuiFolderHandle) -> None:
        self._session = session
        self._gui = session.audience.gui
        self._commands = self._add_commands()
        with container:
            self._bar = self._gui.add_html(self._html())
            self._mark = self._gui.add_html(self._mark_html())
        session.listeners.append(self._hear)
        follow_browsers(session, self._hear)

    def close(self) -> None:
        """Stop following the session."""
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
        # The panels of one browser are rows of its own soon; until then, the first.
        browser = next(iter(self._session.browsers.values()), None)
        tools: Sequence[Tool | type[Tool]] = tuple(TOOLS.values())
        said = current = ""
        if browser is not None:
            tools, current = browser.tools.tools, browser.tools.current.kind
            said = html_text(browser.tools.status or browser.tools.current.help)
        buttons = "".join(
            self._tool_button(tool, tool.kind == current) for tool in tools
        )
        return (
            f'<div class="sambot-tools">{buttons}'
            f'<button title="Zero the view (Z)" {self._triggers(ZERO)}>Zero</button>'
            f'<button title="Draw everything again (R)" {self._triggers(RESET)}>'
            "Reset</button>"
            f'<button title="Use the whole screen" onclick="{FULL_SCREEN}">'
            "Full screen</button>"
            f'<button title="Hide the panels; H shows them again" onclick="{HIDE}">'
            "Hide</button></div>"
            f'<div class="sambot-note">{said}</div>'
        )

    def _mark_html(self) -> str:
        browser = next(iter(self._session.browsers.values()), None)
        kind = "" if browser is None else browser.view.view.kind
        return page.mouse_element(kind.rpartition("/")[2])

    def _tool_button(self, tool: Tool | type[Tool], current: bool) -> str:
        pressed = "true" if current else "false"
        return (
            f'<button aria-pressed="{pressed}" title="{html_text(tool.label)} '
            f'({tool.key}): {html_text(tool.help)}" {self._triggers(tool.label)}>'
            f"{html_text(tool.label)}</button>"
        )

    def _triggers(self, command: str) -> str:
        """The attribute with which a button triggers a command."""
        uuid = viser_private.command_uuid(self._commands[command])
        return (
            'onclick="this.blur(); window.__viserMutable.sendMessage('
            f"{{type: 'CommandTriggerMessage', uuid: '{uuid}'}})\""
        )

    def _add_commands(self) -> dict[str, viser.CommandHandle]:
        """All commands, by their labels."""
        session = self._session

        def of_browser(act: Callable[[Browser], None], client_id: int) -> None:
            browser = session.browsers.get(client_id)
            if browser is not None:
                act(browser)

        actions: list[tuple[str, CommandKey | None, Action]] = []
        for tool in TOOLS.values():
            choose = partial(of_browser, partial(_choose, tool.kind))
            press = partial(of_browser, partial(_press, tool.kind))
            actions.append((tool.label, None, choose))
            actions.append((f"{tool.label}, as key {tool.key}", tool.key, press))
        actions.append((FOCUS, "F", partial(of_browser, lambda b: b.tools.focus())))
        actions.append((ZERO, "Z", partial(of_browser, lambda b: b.view.zero())))
        actions.append((RESET, "R", partial(_ignore, session.refresh)))
        escape = partial(of_browser, lambda b: b.tools.escape())
        actions.append(("Default tool", "escape", escape))
        for kind in VIEWS:
            label = f"View: {kind.rpartition('/')[2]}"
            set_kind = partial(_set_kind, kind)
            actions.append((label, None, partial(of_browser, set_kind)))
        return {label: self._add(label, key, act) for label, key, act in actions}

    def _add(
        self, label: str, key: CommandKey | None, action: Action
    ) -> viser.CommandHandle:
        command = self._gui.add_command(label, hotkey=key)

        async def triggered(event: viser.CommandEvent) -> None:
            if event.client_id is not None:
                self._session.worker.post(partial(action, event.client_id))

        command.on_trigger(triggered)
        return command


def _choose(kind: str, browser: Browser) -> None:
    browser.tools.choose(kind)


def _press(kind: str, browser: Browser) -> None:
    browser.tools.press(kind)


def _set_kind(kind: str, browser: Browser) -> None:
    browser.view.set_kind(kind)


def follow_browsers(session: Session, hear: Callable[[Event], None]) -> None:
    """Hear what changes in any browser of a session."""

    def joined(browser: Browser, here: bool) -> None:
        if here:
            browser.listeners.append(hear)
        hear("tools")
        hear("view")

    session.browser_listeners.append(joined)
    for browser in session.browsers.values():
        browser.listeners.append(hear)


def _ignore(act: Callable[..., Any], *arguments: object) -> None:
    """Call without the number of the browser, which comes last."""
    act(*arguments[:-1])

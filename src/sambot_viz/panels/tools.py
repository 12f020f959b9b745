"""The toolbar of one browser, and RViz's Tool Properties panel."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from sambot_viz.errors import UsageError
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.property_rows import property_rows
from sambot_viz.panels.row import Row, own
from sambot_viz.session import Session
from sambot_viz.session.browser.browser import Browser
from sambot_viz.tools.tool import Tool

_NUMBERS = ((float, int), (float, int))
_PLACE = ((float, int, type(None)), (float, int, type(None)))
"""Of the mouse in the view, 0 to 1 from left and top; None when it is not there."""


class ToolsPanel(Panel):
    """The tools, which of them is current, its hint, and what keys and buttons do.

    A tool's own action always chooses it. Its key follows RViz's rule for keys: pressed
    again, it goes back to the default tool ("tools/press").

    Args:
        session: what is shown.
        browser: whose tools these are.
    """

    name = "tools"

    def __init__(self, session: Session, browser: Browser) -> None:
        signals = session.signals
        self.remade_by = (signals.config, browser.tools.changed)
        self._session = session
        self._browser = browser

    def rows(self) -> Sequence[Row]:
        """A row per tool, then the hint and the actions."""
        tools = self._browser.tools.tools
        # "Reset" draws the scene again for everyone.
        reset = _action("tools/reset", lambda _: self._session.refresh())
        return [*own([*map(self._tool, tools), *self._others()]), reset]

    def _tool(self, tool: Tool) -> Row:
        current = tool is self._browser.tools.current
        return Row(
            f"tool/{tool.label}",
            "",
            "action",
            tool.label,
            value=current,
            help=tool.help,
            icon=tool.label,
            extra={"key": tool.key.lower(), "hover": current and tool.wants_hover},
            set=lambda _: self._browser.tools.choose(tool.kind),
        )

    def _others(self) -> Iterator[Row]:
        tools, view = self._browser.tools, self._browser.view
        hint = tools.status or tools.current.help
        touch = hint.replace(tools.current.help, tools.current.touch)
        yield Row("tools/hint", "", "note", value=hint, extra={"touch": touch})
        names = [item.name for item in tools.selection]
        yield Row("tools/selected", "", "names", value=names)
        yield _action("tools/escape", lambda _: tools.escape())
        yield Row("tools/press", "", "action", takes=(str,), set=self._press)
        yield Row("tools/hover", "", "action", takes=_NUMBERS, set=tools.hover)
        yield _action("tools/right_click", lambda _: tools.right_click())
        yield Row("tools/focus", "", "action", takes=_PLACE, set=self._focus)
        yield _action("tools/zero", lambda _: view.zero())

    def _press(self, arguments: tuple[str]) -> None:
        (label,) = arguments
        for tool in self._browser.tools.tools:
            if tool.label == label:
                self._browser.tools.press(tool.kind)
                return
        raise UsageError(f"there is no tool '{label}'")

    def _focus(self, place: tuple[float | None, float | None]) -> None:
        x, y = place
        self._browser.tools.focus(None if x is None or y is None else (x, y))


class ToolPropertiesPanel(Panel):
    """The settings of the tools that the document lists, as in RViz.

    Args:
        session: whose document it is.
        browser: whose tools these are.
    """

    name = "tool_properties"

    def __init__(self, session: Session, browser: Browser) -> None:
        signals = session.signals
        self.remade_by = (signals.config, browser.tools.changed)
        self._session = session
        self._browser = browser

    def rows(self) -> Sequence[Row]:
        """A group per tool that has settings."""
        made = [row for tool in self._browser.tools.tools for row in self._of(tool)]
        return made or [Row("tool_properties/none", "", "note", value=_NO_SETTINGS)]

    def _of(self, tool: Tool) -> Sequence[Row]:
        if tool.config is None:
            return ()
        group = f"tool_properties/{tool.label}"
        change = partial(self._session.set_tool_property, tool.kind)
        below = [*property_rows(tool.config, group, change)]
        head = Row(
            group,
            "",
            "group",
            tool.label,
            icon=tool.label,
            help=tool.help,
            expanded=True,
        )
        return [head, *below] if below else ()


def _action(row_id: str, act: Callable[[object], object]) -> Row:
    return Row(row_id, "", "action", set=act)


_NO_SETTINGS = "No tool of this config has settings."

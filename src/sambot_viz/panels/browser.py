"""What belongs to one browser alone: tools, undo, and answers to what it sent."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sambot_viz.panels.panel import Panel
from sambot_viz.panels.publisher import Publisher
from sambot_viz.panels.row import Json, Level, Row
from sambot_viz.session import Event, Session
from sambot_viz.session.browser import Browser


class BrowserPanels:
    """The rows that one browser has for itself.

    Args:
        session: what it shows.
        browser: the browser.
    """

    def __init__(self, session: Session, browser: Browser) -> None:
        self._notices = NoticePanel()
        self._browser = browser
        self._publisher = Publisher(
            browser.client,
            session.worker,
            [
                self._notices,
                ToolsPanel(browser),
                UndoPanel(session, browser),
            ],
            "browser",
        )
        browser.listeners.append(self.hear)

    def close(self) -> None:
        """Follow the browser no longer."""
        self._browser.listeners.remove(self.hear)
        self._publisher.close()

    def hear(self, event: Event) -> None:
        """Send what an event changes."""
        self._publisher.hear(event)

    def row(self, row_id: str) -> Row | None:
        """A row of this browser."""
        return self._publisher.row(row_id)

    def answer(self, row_id: str, sentence: str, row: Row | None) -> None:
        """Say why a value was refused; the page shows the value that holds again."""
        del row
        self._notices.say(sentence, "error", row_id)
        self._publisher.remake(self._notices)


class NoticePanel(Panel):
    """The last sentence to one browser."""

    name = "notice"

    def __init__(self) -> None:
        self._count = 0
        self._notice: Json = None

    def say(self, sentence: str, level: Level, row_id: str | None = None) -> None:
        """Show a sentence, at a row or above the status bar."""
        self._count += 1
        self._notice = {
            "number": self._count,
            "text": sentence,
            "level": level,
            "row": row_id,
        }

    def rows(self) -> Sequence[Row]:
        """The last notice."""
        return [Row("notice", "", "names", value=self._notice)]


class ToolsPanel(Panel):
    """The tools, which of them is current, and its hint."""

    name = "tools"
    remade_by = frozenset({"tools", "config"})

    def __init__(self, browser: Browser) -> None:
        self._tools = browser.tools

    def rows(self) -> Sequence[Row]:
        """A row per tool, then the hint."""
        return [*self._rows()]

    def _rows(self) -> Iterator[Row]:
        tools = self._tools
        for tool in tools.tools:
            yield Row(
                f"tool/{tool.label}",
                "",
                "action",
                tool.label,
                value=tool is tools.current,
                help=tool.help,
                icon=tool.label,
                extra={"key": tool.key.lower()},
                set=lambda _, kind=tool.kind: tools.choose(kind),
            )
        yield Row("tools/hint", "", "note", value=tools.status or tools.current.help)
        yield Row("tools/escape", "", "action", set=lambda _: tools.escape())


class UndoPanel(Panel):
    """What can be undone and done again."""

    name = "edit"
    remade_by = frozenset({"edits"})

    def __init__(self, session: Session, browser: Browser) -> None:
        self._edits, self._id = session.edits, browser.client_id

    def rows(self) -> Sequence[Row]:
        """Undo and Redo, with what they would do."""
        undo, redo = self._edits.undo_label(self._id), self._edits.redo_label(self._id)
        return [
            Row(
                "edit/undo",
                "",
                "action",
                "Undo",
                value=undo or "",
                enabled=undo is not None,
                set=lambda _: self._edits.undo(self._id),
            ),
            Row(
                "edit/redo",
                "",
                "action",
                "Redo",
                value=redo or "",
                enabled=redo is not None,
                set=lambda _: self._edits.redo(self._id),
            ),
        ]

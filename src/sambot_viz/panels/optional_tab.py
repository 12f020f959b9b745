"""A tab that is only there for robots that it is of use to."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import viser

from sambot_viz.session import Event, Session


class Closable(Protocol):
    """What fills a tab."""

    def close(self) -> None:
        """Follow the session no longer."""


class OptionalTab:
    """Comes and goes with the robot.

    Args:
        session: whose robot it is.
        panel: where the tab is added.
        title: its label.
        make: fills the tab.
        wanted: whether the session's robot has use for it.
    """

    def __init__(
        self,
        session: Session,
        panel: viser.PanelHandle,
        title: str,
        make: Callable[[Session, viser.GuiTabHandle], Closable],
        wanted: Callable[[Session], bool],
    ) -> None:
        self._session = session
        self._panel = panel
        self._title = title
        self._make = make
        self._wanted = wanted
        self._tab: viser.GuiTabHandle | None = None
        self._content: Closable | None = None
        session.listeners.append(self._hear)
        self._hear("robot")

    def close(self) -> None:
        """Follow the session no longer."""
        self._session.listeners.remove(self._hear)
        if self._content is not None:
            self._content.close()

    def _hear(self, event: Event) -> None:
        if event != "robot":
            return
        wanted = self._wanted(self._session)
        if wanted and self._tab is None:
            self._tab = self._panel.add_tab(self._title)
            self._content = self._make(self._session, self._tab)
        elif not wanted and self._tab is not None:
            if self._content is not None:
                self._content.close()
            self._tab.remove()
            self._tab = self._content = None

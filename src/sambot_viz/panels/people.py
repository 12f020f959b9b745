"""Who drives, who watches, and what a user can do about that."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import viser

from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Answer, Row, own
from sambot_viz.session import Session
from sambot_viz.session.browser.browser import Browser


class PeoplePanel(Panel):
    """Who is there, for everyone.

    Args:
        session: whose browsers these are.
    """

    name = "people"
    remade_by = frozenset({"people"})

    def __init__(self, session: Session) -> None:
        self._session = session

    def rows(self) -> Sequence[Row]:
        """One row with the numbers and names."""
        roles = self._session.roles
        people = roles.people
        drive = [person.name for person in people.values() if person.drives]
        asks = [[id, person.name] for id, person in people.items() if person.asks]
        given = any(p.drives and not p.presenter for p in people.values())
        state = {
            "browsers": len(people),
            "presented": roles.presented,
            "drive": drive if roles.presented else [],
            "watching": len(people) - len(drive),
            "asks": asks,
            "given": given and roles.presented,
            "copy": isinstance(self._session.audience, viser.ClientHandle),
        }
        return [Row("people/state", "", "names", value=state)]


class OwnRolePanel(Panel):
    """What the user of one browser may do, and what can be asked for and given.

    Args:
        session: what it shows.
        browser: the browser.
    """

    name = "role"
    remade_by = frozenset({"people"})

    def __init__(self, session: Session, browser: Browser) -> None:
        self._session = session
        self._roles, self._id = session.roles, browser.client_id

    def rows(self) -> Sequence[Row]:
        """The user of this browser, then the actions."""
        person = self._roles.people.get(self._id)
        if person is None:
            return []
        me = {
            "name": person.name,
            "presenter": person.presenter,
            "drives": person.drives,
            "asks": person.asks,
        }
        return [Row("role/me", "", "names", value=me), *own(self._actions())]

    def _actions(self) -> Iterator[Row]:
        yield Row("role/ask", "", "action", takes=(str,), set=self._ask)
        yield Row("role/back", "", "action", set=lambda _: self._hand_back())
        yield Row("role/give", "", "action", takes=(int,), set=self._give)
        yield Row("role/refuse", "", "action", takes=(int,), set=self._refuse)
        yield Row("role/take", "", "action", set=lambda _: self._take())

    def _ask(self, arguments: tuple[str]) -> Answer:
        with self._session.change("people"):
            self._roles.ask(self._id, arguments[0])
        return Answer("Asked for the wheel; the presenter sees it")

    def _hand_back(self) -> None:
        with self._session.change("people"):
            self._roles.hand_back(self._id)

    def _give(self, arguments: tuple[int]) -> Answer:
        with self._session.change("people"):
            person = self._roles.give(self._id, arguments[0])
        return Answer(f"{person.name} has the wheel, and so have you")

    def _refuse(self, arguments: tuple[int]) -> None:
        with self._session.change("people"):
            self._roles.refuse(self._id, arguments[0])

    def _take(self) -> None:
        with self._session.change("people"):
            self._roles.take(self._id)

"""Who of the browsers of a session may change it, and who only watches.

Without a presenter everyone may. With one, presenters drive; the others watch, may ask
for the wheel, and drive once a presenter has given it to them. What is a browser's own,
such as its camera and its selection, is not a matter of roles.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

from sambot_viz.errors import UsageError

LONGEST_NAME = 40
WATCHING = (
    "you are watching: ask for the wheel to change what everyone sees, or work on a "
    "copy of your own"
)


@dataclass
class Person:
    """The user of one browser.

    Attributes:
        number: in the order of coming, among presenters or among the others.
        presenter: whether the browser was opened by the presenter's link.
        name: what the others read.
        drives: whether it may change the session.
        asks: whether it waits for the wheel.
    """

    number: int
    presenter: bool
    name: str
    drives: bool
    asks: bool = False


class Roles:
    """Who drives; the session that owns it holds its lock.

    Args:
        presented: whether only presenters, and those to whom they give the wheel, may
            change the session.
    """

    def __init__(self, presented: bool = False) -> None:
        self.presented = presented
        self._people: dict[int, Person] = {}
        self._guests = itertools.count(1)

    @property
    def people(self) -> dict[int, Person]:
        """The number of each browser, and its user."""
        return dict(self._people)

    def join(self, browser_id: int, presenter: bool) -> None:
        """A browser has opened the page."""
        # One who loads the page again is the presenter as before.
        taken = {person.number for person in self._people.values() if person.presenter}
        free = next(n for n in itertools.count(1) if n not in taken)
        number = free if presenter else next(self._guests)
        name = f"Guest {number}"
        if presenter:
            name = "Presenter" if number == 1 else f"Presenter {number}"
        drives = presenter or not self.presented
        self._people[browser_id] = Person(number, presenter, name, drives)

    def leave(self, browser_id: int) -> None:
        """A browser has closed the page; the wheel it was given is free again."""
        self._people.pop(browser_id, None)

    def may_edit(self, browser_id: int) -> bool:
        """Whether a browser may change what everyone sees; any thread may ask."""
        if not self.presented:
            return True
        person = self._people.get(browser_id)
        return person is not None and person.drives

    def ask(self, browser_id: int, name: str = "") -> None:
        """Ask the presenter for the wheel.

        Args:
            browser_id: who asks.
            name: what the presenter is to read; empty keeps "Guest 3".

        Raises:
            UsageError: the name is too long.
        """
        person = self._people[browser_id]
        if len(name) > LONGEST_NAME:
            raise UsageError(f"a name has at most {LONGEST_NAME} characters")
        person.name = name.strip() or person.name
        person.asks = not person.drives

    def hand_back(self, browser_id: int) -> None:
        """A guest gives the wheel back, or asks for it no longer."""
        person = self._people[browser_id]
        person.asks, person.drives = False, person.presenter or not self.presented

    def give(self, presenter_id: int, browser_id: int) -> Person:
        """A presenter gives the wheel to a guest; the one who had it watches again.

        Raises:
            UsageError: only presenters may, and only to who is there.
        """
        person = self._guest(presenter_id, browser_id)
        self.take(presenter_id)
        person.drives, person.asks = True, False
        return person

    def refuse(self, presenter_id: int, browser_id: int) -> Person:
        """A presenter does not give the wheel to the one who asks.

        Raises:
            UsageError: as for `give`.
        """
        person = self._guest(presenter_id, browser_id)
        person.asks = False
        return person

    def take(self, presenter_id: int) -> None:
        """A presenter takes the wheel back: all guests watch.

        Raises:
            UsageError: only presenters may.
        """
        self._check_presenter(presenter_id)
        for person in self._people.values():
            person.drives = person.presenter

    def _guest(self, presenter_id: int, browser_id: int) -> Person:
        self._check_presenter(presenter_id)
        person = self._people.get(browser_id)
        if person is None or person.presenter:
            raise UsageError("this guest is not there any more")
        return person

    def _check_presenter(self, browser_id: int) -> None:
        person = self._people.get(browser_id)
        if not self.presented or person is None or not person.presenter:
            raise UsageError("only the presenter can give the wheel")

"""Roles: which clients of a session may change it, and which only view it.

Without a presenter everyone has control. With one, presenters have it; viewers may
request it, and have it once a presenter has given it to them. What belongs to one
client, such as its camera and its selection, is not a matter of roles.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

from sambot_viz.errors import UsageError
from sambot_viz.session.signals import Change, Signal

LONGEST_NAME = 40
VIEW_ONLY = "view only: request control, or open your own copy"


@dataclass
class Participant:
    """The user of one client.

    Attributes:
        number: in the order of coming, among presenters or among viewers.
        presenter: whether the page was opened by the presenter's address.
        name: what the others read.
        has_control: whether it may change the session.
        requests: whether it waits for control.
    """

    number: int
    presenter: bool
    name: str
    has_control: bool
    requests: bool = False


class Roles:
    """Keeps who has control.

    Args:
        presented: whether only presenters, and those to whom they give control, may
            change the session.

    Attributes:
        changed: who is there, and who has or requests control.
    """

    def __init__(self, change: Change, presented: bool = False) -> None:
        self.presented = presented
        self.changed = Signal(change, None)
        self._people: dict[int, Participant] = {}
        self._guests = itertools.count(1)

    @property
    def people(self) -> dict[int, Participant]:
        """The number of each client, and its user."""
        return dict(self._people)

    def join(self, client_id: int, presenter: bool) -> None:
        """Add the user of a client that has opened the page."""
        # One who loads the page again is the presenter as before.
        taken = {person.number for person in self._people.values() if person.presenter}
        free = next(n for n in itertools.count(1) if n not in taken)
        number = free if presenter else next(self._guests)
        name = f"Guest {number}"
        if presenter:
            name = "Presenter" if number == 1 else f"Presenter {number}"
        has_control = presenter or not self.presented
        self._people[client_id] = Participant(number, presenter, name, has_control)
        self.changed.touch()

    def leave(self, client_id: int) -> None:
        """Remove the user of a client; control that was given to it is free again."""
        if self._people.pop(client_id, None) is not None:
            self.changed.touch()

    def may_edit(self, client_id: int) -> bool:
        """Whether a client may change what everyone sees; any thread may ask."""
        if not self.presented:
            return True
        person = self._people.get(client_id)
        return person is not None and person.has_control

    def request(self, client_id: int, name: str = "") -> None:
        """Ask the presenter for control.

        Args:
            client_id: who asks.
            name: what the presenter is to read; empty keeps "Guest 3".

        Raises:
            UsageError: the name is too long, another's, or sounds like a presenter's.
        """
        person = self._people[client_id]
        if len(name) > LONGEST_NAME:
            raise UsageError(f"a name has at most {LONGEST_NAME} characters")
        name = name.strip()
        if not person.presenter and name.casefold().startswith("presenter"):
            raise UsageError("names that begin with 'Presenter' are the presenter's")
        others = (p.name for id, p in self._people.items() if id != client_id)
        if name.casefold() in map(str.casefold, others):
            raise UsageError(f"someone here is called '{name}' already")
        person.name = name or person.name
        person.requests = not person.has_control
        self.changed.touch()

    def release(self, client_id: int) -> None:
        """Give control back, or request it no longer."""
        person = self._people[client_id]
        person.requests = False
        person.has_control = person.presenter or not self.presented
        self.changed.touch()

    def give(self, presenter_id: int, client_id: int) -> Participant:
        """Give control to a viewer, and take it from the one who had it.

        Raises:
            UsageError: only presenters may, and only to who is there.
        """
        person = self._viewer(presenter_id, client_id)
        for other in self._people.values():
            other.has_control = other.presenter
        person.has_control, person.requests = True, False
        self.changed.touch()
        return person

    def refuse(self, presenter_id: int, client_id: int) -> Participant:
        """Decline the request of a viewer.

        Raises:
            UsageError: as for `give`.
        """
        person = self._viewer(presenter_id, client_id)
        person.requests = False
        self.changed.touch()
        return person

    def take_back(self, presenter_id: int) -> None:
        """Take control from all viewers.

        Raises:
            UsageError: only presenters may.
        """
        self._check_presenter(presenter_id)
        for person in self._people.values():
            person.has_control = person.presenter
        self.changed.touch()

    def _viewer(self, presenter_id: int, client_id: int) -> Participant:
        self._check_presenter(presenter_id)
        person = self._people.get(client_id)
        if person is None or person.presenter:
            raise UsageError("this viewer has left")
        return person

    def _check_presenter(self, client_id: int) -> None:
        person = self._people.get(client_id)
        if not self.presented or person is None or not person.presenter:
            raise UsageError("only the presenter can give control")

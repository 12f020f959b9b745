"""Roles: which clients of a session may change it, and which only view it.

Without a presenter everyone has control. With one, presenters have it; viewers may
request it, and have it once a presenter has given it to them. What belongs to one
client, such as its camera and its selection, is not a matter of roles.
"""

from __future__ import annotations

import itertools
import secrets
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field

from sambot_viz import limits
from sambot_viz.errors import UsageError
from sambot_viz.session.people.looks_alike import same_form
from sambot_viz.session.signals import Change, Signal
from sambot_viz.text import text

_LONGEST_LOGIN = 36
"""A number may follow, when several pages have the same login."""
VIEW_ONLY = "view only: request control, or open your own copy"


@dataclass
class Participant:
    """The user of one client.

    Attributes:
        number: in the order of coming, among presenters or among viewers.
        presenter: whether the page was opened by the presenter's address.
        name: what the others read.
        has_control: whether it may change the session.
        requests: the number of its request for control, in their order; 0 for none.
        known: whether the name is that of a login, which cannot be changed.
        key: the page alone knows it; who comes again with it is the same user.
        only_looks: whether it never has control.
    """

    number: int
    presenter: bool
    name: str
    has_control: bool
    requests: int = 0
    known: bool = False
    key: str = field(default_factory=lambda: secrets.token_urlsafe(12), repr=False)
    only_looks: bool = False


class Roles:
    """Keeps who has control.

    Args:
        presented: whether only presenters, and those to whom they give control, may
            change the session.
        may_ask: whether others may request control; where they may not, presenters
            neither give it to them nor remove or rename them.

    Attributes:
        changed: who is there, and who has or requests control.
        copies: how many users have left for a private copy.
        end_connection: closes the page of a client for good.
    """

    def __init__(
        self, change: Change, presented: bool = False, may_ask: bool = True
    ) -> None:
        self.presented = presented
        self.may_ask = may_ask
        self.changed = Signal(change, None)
        self.copies = 0
        self.end_connection: Callable[[int], object] = lambda client_id: None
        self._people: dict[int, Participant] = {}
        self._viewers, self._requests = itertools.count(1), itertools.count(1)
        # One who loads the page again is the same presenter, and nobody takes the name
        # meanwhile.
        self._presenters: dict[int, str] = {1: "Presenter"}
        # Of the viewer who had control when the page was left, for a private copy or
        # to be loaded again; "" for none.
        self._key_of_control = ""

    @property
    def people(self) -> dict[int, Participant]:
        """The number of each client, and its user."""
        return dict(self._people)

    def join(
        self,
        client_id: int,
        presenter: bool,
        login: str = "",
        only_looks: bool = False,
    ) -> None:
        """Add the user of a client that has opened the page.

        Args:
            client_id: the client.
            presenter: whether it was opened by the presenter's link.
            login: the name by which a trusted proxy knows the user; "" without one.
            only_looks: whether it never has control.
        """
        taken = {person.number for person in self._people.values() if person.presenter}
        free = next(n for n in itertools.count(1) if n not in taken)
        number = free if presenter else next(self._viewers)
        name = self._free_name(f"Viewer {number}", client_id)
        if presenter:
            name = self._presenters.setdefault(number, f"Presenter {number}")
        has_control = (presenter or not self.presented) and not only_looks
        person = Participant(number, presenter, name, has_control)
        person.only_looks = only_looks
        self._people[client_id] = person
        if login:
            if not presenter and _is_presenters(login):
                login = f"User {login}"
            login = text(login, _LONGEST_LOGIN)
            self._name(client_id, self._free_name(login, client_id))
            person.known = not presenter
        self.changed.touch()

    def leave(self, client_id: int) -> None:
        """Remove the user of a client; control that was given to it is free again.

        Who comes again has it again, unless a presenter gave or took it meanwhile.
        """
        person = self._people.pop(client_id, None)
        if person is None:
            return
        if person.has_control and not person.presenter:
            self._key_of_control = person.key
        self.changed.touch()

    def count_copies(self, number: int) -> None:
        """Take how many private copies are open now."""
        if number != self.copies:
            self.copies = number
            self.changed.touch()

    def may_edit(self, client_id: int) -> bool:
        """Whether a client may change what everyone sees; any thread may ask."""
        person = self._people.get(client_id)
        if person is None:
            return not self.presented
        return person.has_control

    def request(self, client_id: int, name: str = "") -> None:
        """Ask the presenter for control.

        Args:
            client_id: who asks.
            name: what the presenter is to read; empty keeps "Viewer 3".

        Raises:
            UsageError: as for `rename`.
        """
        self._require_asking()
        person = self._people[client_id]
        self._name(client_id, "" if person.known else name)
        if not person.has_control:
            person.requests = person.requests or next(self._requests)
        self.changed.touch()

    def rename(self, by: int, client_id: int, name: str) -> None:
        """Give someone another name; an empty one keeps the name.

        Args:
            by: the client of who does it: the same one, or a presenter's.
            client_id: whose name it is.
            name: what the others read.

        Raises:
            UsageError: the name is too long, another's, or sounds like a presenter's;
                or the user may not rename others.
        """
        if by != client_id:
            self._viewer(by, client_id)
        self._name(client_id, name)
        self.changed.touch()

    def greet(self, client_id: int, name: str, key: str = "") -> None:
        """Restore the name and role that a page has kept of its user.

        Args:
            client_id: the new client of the page.
            name: its name; it gets a number if another client has it now.
            key: key of the user; "" for none.
        """
        person = self._people[client_id]
        if person.presenter:
            return
        if key and secrets.compare_digest(key.encode(), self._key_of_control.encode()):
            person.has_control, self._key_of_control = True, ""
            person.requests = 0
        # The user has not asked for anything that could be refused.
        with suppress(UsageError):
            self._name(client_id, name.strip() and self._free_name(name, client_id))
        self.changed.touch()

    def _name(self, client_id: int, name: str) -> None:
        person = self._people[client_id]
        if person.known and name:
            raise UsageError("this name is that of the login")
        if len(name) > limits.PERSON_NAME.value:
            raise UsageError(
                f"a name has at most {limits.PERSON_NAME.value} characters"
            )
        name = " ".join(name.split())
        if not person.presenter and _is_presenters(name):
            raise UsageError("names that begin with 'Presenter' are the presenter's")
        if name and self._is_taken(name, client_id):
            raise UsageError(f"someone here is called '{name}' already")
        person.name = name or person.name
        if person.presenter:
            self._presenters[person.number] = person.name

    def _is_taken(self, name: str, client_id: int) -> bool:
        person = self._people.get(client_id)
        own = person.number if person is not None and person.presenter else None
        others = [p.name for id, p in self._people.items() if id != client_id]
        others += [kept for number, kept in self._presenters.items() if number != own]
        return same_form(name) in map(same_form, others)

    def _free_name(self, name: str, client_id: int) -> str:
        """Return a name that no other client has: "Ada", or "Ada 2"."""
        numbered = (name if n == 1 else f"{name} {n}" for n in itertools.count(1))
        return next(one for one in numbered if not self._is_taken(one, client_id))

    def release(self, client_id: int) -> None:
        """Give control back, or request it no longer."""
        person = self._people[client_id]
        person.requests = 0
        person.has_control = person.presenter or not self.presented
        self.changed.touch()

    def give(self, presenter_id: int, client_id: int) -> Participant:
        """Give control to a viewer, and take it from the one who had it.

        Raises:
            UsageError: only presenters may, and only to who is there.
        """
        person = self._viewer(presenter_id, client_id)
        if person.only_looks:
            raise UsageError(
                "who looks at a follower has no control: its page leads to this one, "
                "where it can be requested"
            )
        self.pass_to(client_id)
        return person

    def pass_to(self, client_id: int) -> None:
        """Give control to a viewer, and take it from the one who had it."""
        self._key_of_control = ""
        for other in self._people.values():
            other.has_control = other.presenter
        person = self._people[client_id]
        person.has_control, person.requests = True, 0
        self.changed.touch()

    def queue(self) -> list[int]:
        """Return the clients that request control, in the order of their requests."""
        asking = [(p.requests, id) for id, p in self._people.items() if p.requests]
        return [client_id for _, client_id in sorted(asking)]

    def viewer_in_control(self) -> int | None:
        """Return the client of the viewer who has control; None where none has."""
        people = self._people.items()
        return next((i for i, p in people if p.has_control and not p.presenter), None)

    def refuse(self, presenter_id: int, client_id: int) -> Participant:
        """Decline the request of a viewer.

        Raises:
            UsageError: as for `give`.
        """
        person = self._viewer(presenter_id, client_id)
        person.requests = 0
        self.changed.touch()
        return person

    def refuse_all(self, presenter_id: int) -> None:
        """Decline all requests.

        Raises:
            UsageError: only presenters may.
        """
        self._check_presenter(presenter_id)
        for person in self._people.values():
            person.requests = 0
        self.changed.touch()

    def remove(self, presenter_id: int, client_id: int) -> Participant:
        """Close the page of a viewer.

        Raises:
            UsageError: as for `give`.
        """
        person = self._viewer(presenter_id, client_id)
        self.end_connection(client_id)
        person.has_control = False
        self.leave(client_id)
        return person

    def take_back(self, presenter_id: int) -> None:
        """Take control from all viewers.

        Raises:
            UsageError: only presenters may.
        """
        self._check_presenter(presenter_id)
        self.return_control()

    def return_control(self) -> None:
        """Give control back to the presenter, as STOP does; without one all keep it."""
        if not self.presented:
            return
        self._key_of_control = ""
        for person in self._people.values():
            person.has_control = person.presenter
        self.changed.touch()

    def _viewer(self, presenter_id: int, client_id: int) -> Participant:
        self._check_presenter(presenter_id)
        self._require_asking()
        person = self._people.get(client_id)
        if person is None or person.presenter:
            raise UsageError("this viewer has left")
        return person

    def _require_asking(self) -> None:
        if not self.may_ask:
            raise UsageError("in a class, this robot can only be looked at")

    def _check_presenter(self, client_id: int) -> None:
        person = self._people.get(client_id)
        if not self.presented or person is None or not person.presenter:
            raise UsageError("only the presenter can do this")


def _is_presenters(name: str) -> bool:
    """Whether a name could be taken for that of a presenter."""
    return same_form(name).startswith("presenter")

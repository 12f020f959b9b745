"""Who has control, who views, and how a user requests, gives and releases control."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import replace

from sambot_viz.errors import UsageError
from sambot_viz.panels.command import INTEGER, TEXT, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Answer, Data, Level
from sambot_viz.session.people.roles import Participant, Roles


class PeoplePanel(Panel):
    """Who is there, for everyone.

    Args:
        is_copy: whether one client has the session as a private copy.
    """

    name = "people"

    def __init__(self, roles: Roles, is_copy: bool) -> None:
        self.remade_by = (roles.changed,)
        self._roles = roles
        self._is_copy = is_copy

    def data(self) -> Sequence[Data]:
        """Return how many there are, and the names of some."""
        roles = self._roles
        people = roles.people
        control = [person.name for person in people.values() if person.has_control]
        requests = [
            [id, person.name] for id, person in people.items() if person.requests
        ]
        given = any(p.has_control and not p.presenter for p in people.values())
        state = {
            "clients": len(people),
            "presented": roles.presented,
            "control": control if roles.presented else [],
            "viewers": len(people) - len(control),
            "requests": requests,
            "given": given and roles.presented,
            "copy": self._is_copy,
        }
        return [Data("people/state", state)]


class OwnRolePanel(Panel):
    """Shows one client its role, and takes requests for control.

    Args:
        client_id: whose role it is.
        say: shows the user a sentence.
    """

    name = "role"

    def __init__(
        self, roles: Roles, client_id: int, say: Callable[[str, Level], None]
    ) -> None:
        self.remade_by = (roles.changed,)
        self._roles, self._id = roles, client_id
        self._say = say
        self._before: Participant | None = None
        self._helpers: frozenset[str] = frozenset()
        self._acted = False

    def data(self) -> Sequence[Data]:
        """Return the user of this browser."""
        person = self._roles.people.get(self._id)
        if person is None:
            return []
        self._say_news(person)
        me = {
            "name": person.name,
            "presenter": person.presenter,
            "control": person.has_control,
            "requests": person.requests,
        }
        return [Data("role/me", me)]

    def _say_news(self, person: Participant) -> None:
        """Say what others have changed about control."""
        before, self._before = self._before, replace(person)
        helpers, self._helpers = self._helpers, self._viewers_in_control()
        acted, self._acted = self._acted, False
        if before is None or not self._roles.presented:
            return
        if person.has_control and not before.has_control:
            self._say("You are in control. Everyone sees what you change", "ok")
        elif before.has_control and not person.has_control:
            taken = f"View only: {_list(self._helpers)} now in control"
            taken = taken if self._helpers else _TAKEN_BACK
            self._say(_RELEASED if acted else taken, "ok" if acted else "warn")
        elif before.requests and not person.requests and not acted:
            self._say("The presenter declined your request", "warn")
        elif person.presenter and not acted and helpers - self._helpers:
            self._say(f"{', '.join(helpers - self._helpers)} released control", "ok")

    def _viewers_in_control(self) -> frozenset[str]:
        people = self._roles.people.values()
        return frozenset(p.name for p in people if p.has_control and not p.presenter)

    def offers(self, command_id: str) -> bool:
        """Tell whether the browser has joined."""
        return self._id in self._roles.people

    @contextmanager
    def _acting(self) -> Generator[None]:
        """Note that this user changes something, and needs no news of it."""
        self._acted = True
        try:
            yield
        except UsageError:
            self._acted = False
            raise

    @command("role/request", TEXT, client_local=True)
    def _ask(self, name: str) -> Answer:
        with self._acting():
            self._roles.request(self._id, name)
        if any(person.presenter for person in self._roles.people.values()):
            return Answer("Requested control; the presenter sees your request")
        return Answer("Requested control; no presenter is here at the moment")

    @command("role/release", client_local=True)
    def _hand_back(self) -> None:
        with self._acting():
            self._roles.release(self._id)

    @command("role/give", INTEGER, client_local=True)
    def _give(self, client_id: int) -> Answer:
        with self._acting():
            person = self._roles.give(self._id, client_id)
        return Answer(f"You and {person.name} are in control")

    @command("role/decline", INTEGER, client_local=True)
    def _refuse(self, client_id: int) -> None:
        with self._acting():
            self._roles.refuse(self._id, client_id)

    @command("role/take-back", client_local=True)
    def _take(self) -> Answer:
        with self._acting():
            self._roles.take_back(self._id)
        return Answer("Only you are in control")


def _list(names: frozenset[str]) -> str:
    verb = "is" if len(names) == 1 else "are"
    return f"{', '.join(sorted(names))} {verb}"


_RELEASED = "You have released control"
_TAKEN_BACK = "View only: the presenter has taken back control"

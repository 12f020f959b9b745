"""Who has control, who views, and how a user requests, gives and releases control."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace

from sambot_viz.errors import UsageError
from sambot_viz.panels.command import INTEGER, TEXT, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Answer, Data, Json, Level, Row
from sambot_viz.session.people.roles import Participant, Roles
from sambot_viz.session.people.turns import Turns, Waiting


class PeoplePanel(Panel):
    """Who is there, for everyone.

    Args:
        is_copy: whether one client has the session as a private copy.
        turns: gives control to those who request it; None where a presenter does.
    """

    name = "people"

    def __init__(self, roles: Roles, is_copy: bool, turns: Turns | None = None) -> None:
        self.remade_by = (roles.changed,)
        self._roles, self._turns = roles, turns
        self._is_copy = is_copy

    def rows(self) -> Sequence[Row]:
        """Return everyone, presenters first."""
        people = sorted(self._roles.people.items(), key=lambda p: not p[1].presenter)
        queue = {} if self._turns is None else self._turns.waiting()
        return [self._row(id, person, queue.get(id)) for id, person in people]

    def _row(self, client_id: int, person: Participant, turn: Waiting | None) -> Row:
        facts: dict[str, Json] = {
            "client": client_id,
            "presenter": person.presenter,
            "control": person.has_control,
            "requests": person.requests > 0,
        }
        if turn is not None:
            facts |= {"place": turn.place, "wait": _shown(turn.seconds)}
        return Row(f"person/{client_id}", "", "readonly", person.name, extra=facts)

    def data(self) -> Sequence[Data]:
        """Return what kind of session it is, and how many have a copy of it."""
        roles = self._roles
        state: dict[str, Json] = {"presented": roles.presented, "copy": self._is_copy}
        state["copies"] = roles.copies
        if self._turns is not None:
            left = self._turns.left
            state["slot"] = self._turns.slot
            state["left"] = None if left is None else _shown(left)
        return [Data("people/state", state)]


@dataclass(frozen=True, slots=True)
class Invitation:
    """The link for viewers.

    Attributes:
        link: the whole address, with the secret in it.
        dark: its QR code, line by line: "1" for a dark module.
        only_here: whether it can be opened on this machine only.
    """

    link: str
    dark: Sequence[str]
    only_here: bool


Invite = Callable[[str], Invitation]
"""Makes the link for viewers, from the address at which a page was opened."""


class InvitePanel(Panel):
    """Gives one client the link for viewers, also as a QR code.

    Args:
        client_id: the client; where there is a presenter, only presenters invite.
        invite: makes the link.
        remake: called when there is one.
    """

    name = "invite"

    def __init__(
        self,
        roles: Roles,
        client_id: int,
        invite: Invite,
        remake: Callable[[Panel], None],
    ) -> None:
        self._roles, self._id = roles, client_id
        self._make, self._remake = invite, remake
        self._made: Json = None

    def data(self) -> Sequence[Data]:
        """Return the last link that was asked for."""
        return [Data("people/invitation", self._made)]

    def offers(self, command_id: str) -> bool:
        """Return whether this client may invite others."""
        person = self._roles.people.get(self._id)
        return person is not None and (person.presenter or not self._roles.presented)

    @command("people/invite", TEXT, name="Invite", client_local=True)
    def _invite(self, opened_at: str) -> None:
        if not re.fullmatch(r"https?://[^/?#\s]+(/[^?#\s]*)?", opened_at):
            raise UsageError(f"this is not the address of a page: {opened_at}")
        self._made = {"asked": opened_at, **asdict(self._make(opened_at))}
        self._remake(self)


class OwnRolePanel(Panel):
    """Shows one client its role, and takes requests for control.

    Args:
        client_id: whose role it is.
        say: shows the user a sentence.
        turns: gives control to those who request it; None where a presenter does.
    """

    name = "role"

    def __init__(
        self,
        roles: Roles,
        client_id: int,
        say: Callable[[str, Level], None],
        turns: Turns | None = None,
    ) -> None:
        self.remade_by = (roles.changed,)
        self._roles, self._id, self._turns = roles, client_id, turns
        self._say = say
        self._before: Participant | None = None
        self._helpers: dict[int, str] = {}
        self._viewers: dict[int, str] = {}
        self._acted = False

    def data(self) -> Sequence[Data]:
        """Return the user of this browser."""
        person = self._roles.people.get(self._id)
        if person is None:
            return []
        self._say_news(person)
        me = {
            "client": self._id,
            "name": person.name,
            "presenter": person.presenter,
            "control": person.has_control,
            "requests": person.requests > 0,
            "key": person.key,
        }
        return [Data("role/me", me)]

    def _say_news(self, person: Participant) -> None:
        """Say what others have changed about control."""
        before, self._before = self._before, replace(person)
        helpers, self._helpers = self._helpers, self._viewers_in_control()
        viewers, self._viewers = self._viewers, self._names_of_viewers()
        acted, self._acted = self._acted, False
        if before is None or not self._roles.presented:
            return
        if person.has_control and not before.has_control:
            self._say("You can now change the robot. Everyone sees it.", "ok")
        elif before.has_control and not person.has_control:
            taken = f"View only: {_list(self._helpers.values())} now in control"
            taken = taken if self._helpers else _TAKEN_BACK
            self._say(_RELEASED if acted else taken, "ok" if acted else "warn")
        elif before.requests and not person.requests and not acted:
            self._say("The presenter declined your request", "warn")
        elif before.name != person.name and not acted:
            self._say(f"The presenter has renamed you: {person.name}", "ok")
        elif person.presenter and not acted:
            self._say_who_helps(helpers)
            gone = viewers.keys() - self._viewers.keys() - helpers.keys()
            if gone:
                self._say(_left([viewers[id] for id in gone]), "ok")

    def _names_of_viewers(self) -> dict[int, str]:
        people = self._roles.people.items()
        return {i: p.name for i, p in people if not p.presenter}

    def _say_who_helps(self, before: dict[int, str]) -> None:
        """Tell a presenter which viewers have control now, or no longer."""
        left = [name for id, name in before.items() if id not in self._roles.people]
        ended = [before[id] for id in before.keys() - self._helpers.keys()]
        new = [self._helpers[id] for id in self._helpers.keys() - before.keys()]
        if new:
            self._say(f"{_list(new)} now in control", "ok")
        elif left:
            self._say(f"{_left(left)}, and had control", "ok")
        elif ended:
            self._say(f"{_list(ended)} no longer in control", "ok")

    def _viewers_in_control(self) -> dict[int, str]:
        people = self._roles.people.items()
        return {i: p.name for i, p in people if p.has_control and not p.presenter}

    def offers(self, command_id: str) -> bool:
        """Tell whether the browser has joined, and may have what it asks for."""
        asks = command_id in ("role/request", "role/give", "role/remove")
        return self._id in self._roles.people and (self._roles.may_ask or not asks)

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
        if self._turns is not None:
            place = self._roles.queue().index(self._id) + 1
            return Answer(f"You are number {place} in the queue")
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

    @command("role/decline-all", client_local=True)
    def _refuse_all(self) -> None:
        with self._acting():
            self._roles.refuse_all(self._id)

    @command("role/remove", INTEGER, client_local=True)
    def _remove(self, client_id: int) -> Answer:
        with self._acting():
            person = self._roles.remove(self._id, client_id)
        return Answer(f"Removed {person.name}")

    @command("role/rename", INTEGER, TEXT, name="Rename", client_local=True)
    def _rename(self, client_id: int, name: str) -> None:
        with self._acting():
            self._roles.rename(self._id, client_id, name)

    @command("role/greet", TEXT, TEXT, client_local=True)
    def _greet(self, name: str, key: str) -> None:
        with self._acting():
            self._roles.greet(self._id, name, key)

    @command("role/take-back", client_local=True)
    def _take(self) -> Answer:
        with self._acting():
            self._roles.take_back(self._id)
        return Answer("Only you are in control")


def _shown(seconds: float) -> int:
    """Return a time as it is shown, in steps of ten seconds [s]."""
    return 10 * math.ceil(seconds / 10.0)


_FEW = 3
"""Maximum number of names of users who left; a whole class leaves at once."""


def _left(names: Sequence[str]) -> str:
    if len(names) > _FEW:
        return f"{len(names)} viewers have left"
    return f"{', '.join(sorted(names))} {'has' if len(names) == 1 else 'have'} left"


def _list(names: Iterable[str]) -> str:
    listed = sorted(names)
    return f"{', '.join(listed)} {'is' if len(listed) == 1 else 'are'}"


_RELEASED = "You have released control"
_TAKEN_BACK = "View only: the presenter has taken back control"

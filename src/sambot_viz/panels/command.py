"""Declare what the page can call, once, at the method that does it.

    @command("displays/rename", TEXT, TEXT, name="Rename")
    def _rename(self, row_id: str, name: str) -> None: ...

The declaration has the types and limits of the arguments, which `panels.validation`
checks, and whether a viewer may call it: by default not.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, Concatenate, ParamSpec, TypeVar

from sambot_viz.panels.rows.row import Json

P = ParamSpec("P")
Owner = TypeVar("Owner")
Result = TypeVar("Result")
_DECLARED = "__command__"


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of a command.

    Attributes:
        type: of its value; a float may be sent as a whole number.
        optional: None may be sent too.
        least: lowest number that is taken.
        most: highest number that is taken.
        longest: length of a piece of a file [characters], which may have any character;
            None for a text of one line.
    """

    type: type[bool | int | float | str | list[Any]]
    optional: bool = False
    least: float = -math.inf
    most: float = math.inf
    longest: int | None = None


TEXT, NUMBER, INTEGER = Argument(str), Argument(float), Argument(int)
FLAG = Argument(bool)
LIST = Argument(list)
"""Of numbers, texts and truth values."""


@dataclass(frozen=True, slots=True)
class Command:
    """A command that a page may call at present.

    Attributes:
        id: unique in the window.
        arguments: what it takes.
        run: called with checked arguments, in the session's worker and with its lock
            held. It raises SambotVizError to refuse them, and may return an `Answer`.
        name: what refusals call it.
        client_local: whether it changes only what this client shows, so that viewers
            may call it too.
        at_once: it is run as soon as it comes, on viser's event loop and without the
            session's lock, and gets the number of the client first: it must not wait.
    """

    id: str
    arguments: tuple[Argument, ...] = ()
    run: Callable[..., object] = field(default=lambda: None, compare=False)
    name: str = ""
    client_local: bool = False
    at_once: bool = False

    def json(self) -> dict[str, Json]:
        """Return what the page gets."""
        local = {"local": True} if self.client_local else {}
        return {"id": self.id, "in": "", "kind": "command", **local}


def command(
    command_id: str,
    *arguments: Argument,
    name: str = "",
    client_local: bool = False,
    at_once: bool = False,
) -> Callable[
    [Callable[Concatenate[Owner, P], Result]], Callable[Concatenate[Owner, P], Result]
]:
    """Declare a method of a panel to be a command.

    Args:
        command_id: unique in the window.
        arguments: of the method, without `self`.
        name: what refusals call it.
        client_local: whether it changes only what this client shows.
        at_once: as of `Command`.
    """

    def declare(
        method: Callable[Concatenate[Owner, P], Result],
    ) -> Callable[Concatenate[Owner, P], Result]:
        made = Command(command_id, arguments, method, name, client_local, at_once)
        setattr(method, _DECLARED, made)
        return method

    return declare


def declared_commands(owner: type) -> Iterator[Command]:
    """Yield the commands of a class; each `run` is a function without its `self`."""
    for cls in reversed(owner.__mro__):
        for member in vars(cls).values():
            found = getattr(member, _DECLARED, None)
            if isinstance(found, Command):
                yield found

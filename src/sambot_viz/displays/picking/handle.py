"""Handles that a user can move or press in the view: controls of markers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from sambot_viz.displays.picking.aim import Aim
from sambot_viz.displays.picking.rays import Array
from sambot_viz.geometry import Vector3, Xyzw


@dataclass(frozen=True, slots=True)
class HandlePose:
    """Where a marker is, as its program wants to know it.

    Attributes:
        frame: in which the others are.
        stamp_ns: of the frame [ns]; 0 for the latest time.
        position: [m].
        xyzw: its rotation.
        mouse_point: what the pointer is on [m]; None for nothing.
    """

    frame: str
    stamp_ns: int
    position: Vector3
    xyzw: Xyzw
    mouse_point: Vector3 | None


@dataclass(frozen=True, slots=True)
class MenuEntry:
    """An entry of the menu of a marker.

    Attributes:
        id: the id that its program has given it.
        title: its text.
        runs: whether it requests to run a command, which is not done here.
        entries: the entries of its submenu.
    """

    id: int
    title: str
    runs: bool
    entries: Sequence[MenuEntry]


class Handle(Protocol):
    """A control of an interactive marker, as long as that is there."""

    @property
    def marker(self) -> str:
        """The name of the interactive marker."""
        ...

    @property
    def control(self) -> str:
        """The name of the control."""
        ...

    @property
    def topic(self) -> str:
        """The topic for feedback to its program."""
        ...

    @property
    def hint(self) -> str:
        """What can be done with it; empty for nothing."""
        ...

    @property
    def menu(self) -> Sequence[MenuEntry]:
        """The menu of the marker."""
        ...

    @property
    def opens_menu(self) -> bool:
        """Whether a click opens the menu."""
        ...

    @property
    def is_button(self) -> bool:
        """Whether a click presses it."""
        ...

    @property
    def is_there(self) -> bool:
        """Whether the marker still is the one that the ray has hit."""
        ...

    def grab(self, point: Array, aim: Aim) -> bool:
        """Take it; return whether no other hand has the marker.

        Args:
            point: what was grabbed, (3,) in the fixed frame [m].
            aim: where the pointer is.
        """
        ...

    def drag(self, aim: Aim, *, shift: bool, ctrl: bool) -> bool:
        """Follow the pointer; return whether the marker has moved."""
        ...

    def release(self) -> None:
        """Leave it: what its program has said meanwhile counts now."""
        ...

    def pose(self, point: Array | None) -> HandlePose | None:
        """Return where the marker is; None where its frame has no place.

        Args:
            point: what the pointer is on, (3,) in the fixed frame [m].
        """
        ...

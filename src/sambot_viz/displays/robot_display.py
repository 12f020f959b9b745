"""Displays that show a robot: what they add to `Display`, and what they are given.

Most displays draw data. One that draws a robot may read it from a file, sets the frames
of that robot, and waits for mesh files; the rest of the program reaches these through
`Display.robot_display`, so that other displays need not know of them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, TypeAlias

from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import Robot

ModelResult: TypeAlias = "Robot | RobotError"
"""A robot, or the reason why its file gave none."""


@dataclass(frozen=True, slots=True)
class ModelRequest:
    """A display's wish for a model to be read.

    Attributes:
        owner: the display; a new request replaces what it asked for before.
        path: the file.
        trusted: whether its code may run.
        done: takes the result; called in another thread.
    """

    owner: object
    path: Path
    trusted: bool
    done: Callable[[ModelResult], None]


class ModelReader(Protocol):
    """Reads models in the background, for displays with a model file of their own."""

    @property
    def package_path(self) -> tuple[Path | str, ...]:
        """The folders in which packages are looked for, or ``name=folder``."""
        ...

    def read(self, request: ModelRequest) -> None:
        """Read a model soon."""


class RobotDisplay(Protocol):
    """A display that shows a robot: the opened one, or one that it has read."""

    @property
    def own_robot(self) -> Robot | None:
        """The robot that the display has read from a file; None for the opened one."""
        ...

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that `own_robot` is read from, meshes left out."""
        ...

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Problems of the files that the robot is drawn from."""
        ...

    def refusal(self, path: str, value: object) -> str | None:
        """Return why a browser may not set a property to a value, or None."""
        ...

    def read_again(self) -> None:
        """Read `files` again: one of them has been saved."""
        ...

    def publish(self) -> bool:
        """Set the transforms of `own_robot`, and return whether any were new."""
        ...

    def notes(self) -> Mapping[str, str]:
        """Return what is worth knowing about values, by paths of properties."""
        ...

    def assets_read(self) -> None:
        """Draw mesh files and textures that were read in the background."""
        ...

"""The model that the sessions of a server can compare theirs with."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import Robot


class ReferenceModel:
    """A reference, read from its file as often as that is saved.

    While a save has a mistake, the last model that worked stays.

    Args:
        given: the model, or its file.
        load: reads the file.

    Attributes:
        name: what users call it.
        robot: the model; None while none could be read.
        files: those that it is read from.
        problems: why it is not as its file says; empty when it is.
        was_read: whether it was read once, with or without success.
    """

    def __init__(self, given: Path | Robot, load: Callable[[Path], Robot]) -> None:
        self._load = load
        self._path = None if isinstance(given, Robot) else given.absolute()
        self.name = given.name
        self.robot = given if isinstance(given, Robot) else None
        self.files: frozenset[Path] = frozenset()
        self.problems: tuple[Problem, ...] = ()
        self.was_read = False

    def read(self) -> RobotError | None:
        """Read the file; return why that failed."""
        self.was_read = True
        if self._path is None:
            return None
        try:
            self.robot = self._load(self._path)
        except RobotError as error:
            named = (Path(p.file) for p in error.problems if p.file is not None)
            self.files |= {self._path, *error.files, *named}
            # Others usually follow from the first.
            self.problems = error.problems[:1]
            return error
        self.files, self.problems = frozenset((self._path, *self.robot.files)), ()
        return None

"""The reference model, with which the sessions of a server compare theirs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import Robot


class ReferenceModel:
    """A reference model, read again after each save of its file.

    If a save contains a mistake, the last model that worked stays.

    Args:
        given: the model, or its file.
        load: reads the file.

    Attributes:
        name: name that users see.
        robot: the model; None until a read succeeds.
        files: files of the model.
        problems: reasons why it differs from its file; empty if it does not.
        was_read: whether the file was read once, with or without success.
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
        """Read the file; return the error if that fails."""
        self.was_read = True
        if self._path is None:
            return None
        try:
            self.robot = self._load(self._path)
        except RobotError as error:
            named = (Path(p.file) for p in error.problems if p.file is not None)
            self.files |= {self._path, *error.files, *named}
            # The others usually follow from the first.
            self.problems = error.problems[:1]
            return error
        self.files, self.problems = frozenset((self._path, *self.robot.files)), ()
        return None

"""What displays need of the reader of further models."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Protocol, TypeAlias

from sambot_viz.errors import RobotError
from sambot_viz.robot.model import Robot

ModelResult: TypeAlias = "Robot | RobotError"
"""A robot, or the reason why its file gave none."""


class ModelReader(Protocol):
    """Reads models in the background, for displays with a model file of their own."""

    @property
    def package_path(self) -> tuple[Path | str, ...]:
        """The folders in which packages are looked for, or ``name=folder``."""
        ...

    def read(
        self,
        owner: object,
        path: Path,
        trusted: bool,
        done: Callable[[ModelResult], None],
    ) -> None:
        """Read a model soon.

        Args:
            owner: the display that asks; replaces what it asked for before.
            path: the file.
            trusted: whether its code may run.
            done: takes the result; called in another thread.
        """

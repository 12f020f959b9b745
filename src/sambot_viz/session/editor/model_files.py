"""The files of a server's model: their names and how to load them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from sambot_viz.cached import cached_property
from sambot_viz.files import is_below
from sambot_viz.robot.model import Robot
from sambot_viz.session.model_edits import packages_of


@dataclass(frozen=True)
class ModelFiles:
    """The files of a server's model.

    Attributes:
        model: absolute path of the model file.
        load: loads a model file with other texts for its files, keyed by absolute path;
            the second argument is False for texts of a user who may not write the
            files, the last one holds values of ``xacro:arg`` that replace `arguments`.
        arguments: arguments from the command line.
        folder: absolute path of a student's folder, in which every file may be written;
            None for the package of the model.
        others: further files that users may write.
        trusted: True to evaluate the server's files as trusted ones.
    """

    model: Path
    load: Callable[[Path, bool, Mapping[str, str], Mapping[str, str]], Robot]
    arguments: Mapping[str, str] = field(default_factory=dict[str, str])
    folder: Path | None = None
    others: Callable[[], Iterable[Path]] = tuple
    trusted: bool = True

    def named(self, paths: Iterable[Path]) -> Iterator[tuple[str, Path]]:
        """Yield the name and the absolute path of each file in the package.

        A name is the path in the package, with slashes.
        """
        for path in paths:
            whole = Path(os.path.abspath(path))
            if not is_below(whole, self._real):
                continue
            beside = (f for f in (*self._folders, *self._real) if f in whole.parents)
            folder = next(beside, whole.parent)
            yield whole.relative_to(folder).as_posix(), whole

    @cached_property
    def _folders(self) -> tuple[Path, ...]:
        return packages_of(self.model) if self.folder is None else (self.folder,)

    @cached_property
    def _real(self) -> tuple[Path, ...]:
        return tuple(folder.resolve() for folder in self._folders)

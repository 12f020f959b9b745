"""Write the fixes of problems into the model's files, where that is allowed.

Only files in the package of the model are written, and only while they are as they were
when the problem was found. A model without a package has the folder that it is in.
New files are texts as the editor shows them.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TypeVar

from sambot_viz import bundled, limits
from sambot_viz.cached import cached_property
from sambot_viz.errors import Edit, UsageError
from sambot_viz.files import is_below, reason_of, write_atomically
from sambot_viz.fixes import EditRefused, FileChange, changes, write_changes
from sambot_viz.lessons.study import TEXTS
from sambot_viz.robot.packages.package_index import package_of
from sambot_viz.session.undo import History
from sambot_viz.text import text

T = TypeVar("T")
_LONGEST_NAME = 60
_LONGEST_NEW = limits.CLASS_FOLDER.value
_NEW = re.compile(rf"(\w[\w-]*/){{0,4}}\w[\w.-]*({'|'.join(map(re.escape, TEXTS))})")
_MOST_LINES = 3
"""More are counted."""


class ModelEdits:
    """Writes edits into the files of a model.

    Args:
        model: its file.
        watched: whether saved files are followed.
        folder: the whole path of a student's folder, which may be written in place of
            the package of the model.

    Attributes:
        watched: the same.
    """

    def __init__(self, model: Path, watched: bool, folder: Path | None = None) -> None:
        self._model, self._folder = model.absolute(), folder
        self.watched = watched

    def save(self, file: Path, before: bytes | None, after: bytes) -> None:
        """Write a file of the package, unless it has changed.

        Args:
            file: its path.
            before: what it has; None writes a file that is gone.
            after: what it will have.

        Raises:
            EditRefused: nothing was written; the file has its name alone.
        """
        name = _name(os.fspath(file))
        folders = [folder.resolve() for folder in self._folders]
        if not is_below(file, folders):
            raise EditRefused(name, "is outside of the package")
        if before is None:
            _save_new(file, after)
            return
        if not os.access(file, os.W_OK):
            raise EditRefused(name, "is read-only")
        _write([FileChange(os.fspath(file), before, after, "", ())])

    @property
    def can_create(self) -> bool:
        """Whether there is a folder for new files: the bundled robots have none."""
        return bool(self._folders)

    def create(self, name: str) -> Path:
        """Write an empty file; return its whole path.

        Args:
            name: its path in the package, with slashes.

        Raises:
            UsageError: it is not such a path, or a file is there.
            EditRefused: it cannot be written.
        """
        if not _NEW.fullmatch(name) or len(name) > _LONGEST_NEW:
            raise UsageError(
                "name it as launch/robot.launch.py: letters, digits, '_' and '-', and "
                f"one of the endings {', '.join(TEXTS)}"
            )
        # Of an installed model that is a link, the package with its source is the last.
        file = self._folders[-1] / name
        if os.path.lexists(file):
            raise UsageError(f"{name} is there already")
        self.save(file, None, b"")
        return file

    @cached_property
    def _folders(self) -> tuple[Path, ...]:
        if self._folder is not None:
            return (self._folder,)
        is_bundled = _is_bundled(Path(os.path.realpath(self._model)))
        return () if is_bundled else packages_of(self._model)

    def may_write(self, edits: Sequence[Edit]) -> bool:
        """Return whether all edits are in files of the package."""
        folders = [folder.resolve() for folder in self._folders]
        files = {edit.file for edit in edits}
        return bool(files) and all(is_below(Path(file), folders) for file in files)

    def write(self, edits: Sequence[Edit], history: History) -> str:
        """Write edits into their files, as one step that can be undone.

        Args:
            edits: of problems that are shown.
            history: keeps the step.

        Returns:
            Where they are, in words: "sam_bot.urdf.xacro line 7".

        Raises:
            EditRefused: nothing was written; the file has its name alone.
        """
        made = _of_names(lambda: changes(edits, self._folders))
        _write(made)
        history.record(
            f"Fix in {' and '.join(_name(change.file) for change in made)}",
            partial(_write, [change.inverse for change in made]),
            partial(_write, made),
            of_document=False,
        )
        return " and ".join(map(_places, made))


def packages_of(model: Path) -> tuple[Path, ...]:
    """Return the packages of a model: where it is, and where a link to it leads."""
    files = (model, Path(os.path.realpath(model)))
    return tuple(dict.fromkeys(map(package_of, files)))


def _save_new(file: Path, after: bytes) -> None:
    name = _name(os.fspath(file))
    if os.path.lexists(file):
        raise EditRefused.changed(name)
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(file, after)
    except OSError as error:
        raise EditRefused(name, f"cannot be written: {reason_of(error)}") from error


def _write(made: Sequence[FileChange]) -> None:
    _of_names(lambda: write_changes(made))


def _of_names(call: Callable[[], T]) -> T:
    try:
        return call()
    except EditRefused as error:
        raise EditRefused(_name(error.file), error.why, is_old=error.is_old) from error


def _is_bundled(file: Path) -> bool:
    try:
        return is_below(file, [bundled.assets_folder().resolve()])
    except UsageError:
        return False


def _name(file: str) -> str:
    return text(Path(file).name, _LONGEST_NAME)


def _places(change: FileChange) -> str:
    """Name a file and the lines that change."""
    lines = change.lines
    if len(lines) > _MOST_LINES:
        return f"{_name(change.file)} in {len(lines)} lines"
    word = "line" if len(lines) == 1 else "lines"
    return f"{_name(change.file)} {word} {', '.join(map(str, lines))}"

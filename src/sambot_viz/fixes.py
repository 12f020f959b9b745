"""Apply the edits of problems to files, or say why not.

A file is changed only while it is as it was checked, only below given folders, and
whole or not at all; its encoding, byte order mark, line ends and permissions stay.
"""

from __future__ import annotations

import difflib
import stat
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from sambot_viz.edits import apply_edits, by_file, source_of
from sambot_viz.errors import Edit, SambotVizError
from sambot_viz.files import is_below, reason_of, write_atomically


class EditRefused(SambotVizError):
    """Edits that cannot be made; nothing was changed.

    Attributes:
        file: path of the file that stands against it.
        why: what is said of the file.
        is_old: the file is not as it was when it was checked.
    """

    def __init__(self, file: str, why: str, *, is_old: bool = False) -> None:
        super().__init__(f"{file} {why}")
        self.file, self.why, self.is_old = file, why, is_old

    @classmethod
    def changed(cls, file: str) -> EditRefused:
        """A file that is not as it was when it was checked."""
        return cls(file, "has changed since it was checked", is_old=True)


@dataclass(frozen=True, slots=True)
class FileChange:
    """What edits make of a file.

    Attributes:
        file: path of the file as the user wrote it.
        before: its content as it was checked.
        after: its content with the edits.
        encoding: of both.
        lines: where the text is before, counted from 1.
    """

    file: str
    before: bytes
    after: bytes
    encoding: str
    lines: tuple[int, ...]

    @property
    def inverse(self) -> FileChange:
        """The change back."""
        return replace(self, before=self.after, after=self.before)

    def brings_back(self, earlier: FileChange) -> bool:
        """Return whether this makes a file again what it was before another change."""
        return (self.file, self.after) == (earlier.file, earlier.before)

    def diff(self) -> list[str]:
        """Return the change as the lines of a unified diff, without line ends."""
        old, new = (
            [line.removesuffix("\r") for line in data.decode(self.encoding).split("\n")]
            for data in (self.before, self.after)
        )
        name = self.file
        return list(difflib.unified_diff(old, new, name, name, lineterm="", n=1))


def changes(edits: Iterable[Edit], folders: Iterable[Path]) -> list[FileChange]:
    """Return what edits make of their files.

    Args:
        edits: of any files.
        folders: the files have to be below one of them, with their links followed.

    Raises:
        EditRefused: a file is elsewhere, read-only, or not as it was checked; or two
            edits replace the same text.
    """
    allowed = tuple(folder.resolve() for folder in folders)
    return [_change(file, own, allowed) for file, own in by_file(edits).items()]


def _change(file: str, edits: Sequence[Edit], folders: Sequence[Path]) -> FileChange:
    path = Path(file)
    if not is_below(path, folders):
        raise EditRefused(file, "is outside of the package")
    source = source_of(file)
    if source is None:
        raise EditRefused(file, "cannot be read")
    try:
        before = path.read_bytes()
        mode = path.stat().st_mode
    except OSError as error:
        raise EditRefused(file, f"cannot be read: {reason_of(error)}") from error
    if any(edit.seen != hash(source.text) for edit in edits):
        raise EditRefused.changed(file)
    if not mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH):
        raise EditRefused(file, "is read-only")
    try:
        if source.text.encode(source.encoding) != before:
            raise EditRefused.changed(file)
        after = apply_edits(edits, source.text).encode(source.encoding)
    except UnicodeEncodeError as error:
        raise EditRefused(
            file, f"is in {source.encoding}, which has no {error.object[error.start]}"
        ) from error
    except ValueError as error:
        raise EditRefused(file, f"cannot be changed: {error}") from error
    lines = sorted({source.text.count("\n", 0, edit.start) + 1 for edit in edits})
    return FileChange(file, before, after, source.encoding, tuple(lines))


def write_changes(made: Iterable[FileChange]) -> None:
    """Write changes; all of them or none.

    Raises:
        EditRefused: a file is not as it was before, or cannot be written.
    """
    written: list[FileChange] = []
    try:
        for change in made:
            _write(change)
            written.append(change)
    except EditRefused:
        undo_changes(written)
        raise


def undo_changes(made: Iterable[FileChange]) -> None:
    """Write the content before changes again, where nothing else was written since."""
    for change in made:
        with suppress(EditRefused):
            _write(change.inverse)


def _write(change: FileChange) -> None:
    path = Path(change.file)
    try:
        if path.read_bytes() != change.before:
            raise EditRefused.changed(change.file)
        write_atomically(path, change.after)
    except OSError as error:
        why = f"cannot be written: {reason_of(error)}"
        raise EditRefused(change.file, why) from error

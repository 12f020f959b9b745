"""A file that is open in an editor: its text, and what is on the disk."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

from sambot_viz import limits
from sambot_viz.errors import UsageError
from sambot_viz.session.editor.file_text import FileText, from_units, read_file_text


@dataclass(eq=False)
class Buffer:
    """A file in an editor.

    Attributes:
        path: the whole path.
        name: what users call it: its path in the package, with slashes.
        disk: what was on the disk when the text began, or was saved.
        text: as it is in the editor.
        version: another number for another text.
        theirs: what another program has saved meanwhile; None when nothing has.
    """

    path: Path
    name: str
    disk: FileText
    text: str = field(default="")
    version: int = 0
    theirs: FileText | None = None

    @classmethod
    def opened(cls, path: Path, name: str) -> Buffer:
        """Read a file."""
        disk = read_file_text(path)
        return cls(path, name, disk, disk.text)

    @property
    def why(self) -> str:
        """Why it cannot be shown as text; "" when it can."""
        return self.disk.why

    @property
    def is_changed(self) -> bool:
        """Whether the text is another one than that on the disk was."""
        return self.text != self.disk.text

    def take(self, text: str) -> None:
        """Take another text.

        Raises:
            UsageError: it is too long, or no text that a file can hold.
        """
        if len(text) > limits.EDITED_TEXT.value:
            raise UsageError(
                f"{self.name} would have {len(text):,} characters: "
                f"{limits.EDITED_TEXT.value:,} at most are taken"
            )
        if text != self.text:
            self.text = text
            self.version += 1

    def replace(self, version: int, start: int, end: int, new: str) -> bool:
        """Replace a part of the text.

        Args:
            version: of the text that the offsets are for.
            start: of the part [UTF-16 units].
            end: behind it [UTF-16 units].
            new: what is written there.

        Returns:
            False when the text has changed meanwhile; nothing is done then.

        Raises:
            UsageError: as `take`.
        """
        if version != self.version or self.why:
            return False
        first, last = from_units(self.text, start), from_units(self.text, end)
        new = new.replace("\r\n", "\n").replace("\r", "\n")
        self.take(self.text[:first] + new + self.text[max(first, last) :])
        self.version = version + 1
        return True

    def look(self) -> bool:
        """Compare with the disk, after another program may have saved the file.

        Returns:
            Whether anything has changed here.
        """
        found = read_file_text(self.path)
        is_same = found.data == self.disk.data and not (self.why and not found.why)
        if is_same:
            changed, self.theirs = self.theirs is not None, None
            return changed
        if not self.is_changed or found.text == self.text:
            self._begin(found)
            return True
        changed, self.theirs = self.theirs != found, found
        return changed

    def resolve(self, *, take_theirs: bool) -> None:
        """End the difference with what another program has saved.

        Args:
            take_theirs: whether their text is taken; else this one may be saved over
                it.
        """
        if self.theirs is None:
            return
        if take_theirs:
            self._begin(self.theirs)
        else:
            self.disk, self.theirs = replace(self.theirs, why=""), None

    def revert(self) -> None:
        """Take the text that is on the disk again."""
        self._begin(read_file_text(self.path))

    def saved(self, data: bytes) -> None:
        """Note that the text is on the disk now."""
        self.disk = FileText(data, self.text, self.disk.encoding)
        self.theirs = None

    def _begin(self, disk: FileText) -> None:
        if disk.data is None and self.disk.data is not None:
            # The file is gone, its text is not.
            self.disk, self.theirs = replace(disk, why=""), None
            return
        self.disk, self.theirs = disk, None
        if self.text != disk.text:
            self.text = disk.text
            self.version += 1

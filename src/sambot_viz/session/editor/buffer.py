"""A file that is open in an editor: its text and its contents on disk.

Saves by other programs are merged with the text of the users. Where both have changed
the same lines, the users choose.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

from sambot_viz import limits
from sambot_viz.edits import Extent
from sambot_viz.errors import UsageError
from sambot_viz.session.editor.file_text import FileText, from_units, read_file_text
from sambot_viz.session.editor.three_way import Segment, segments


class Replacement(NamedTuple):
    """A part of a text and its replacement."""

    extent: Extent
    text: str


def replaced(text: str, changes: Iterable[Replacement]) -> str:
    """Apply changes to separate parts of a text, in any order."""
    for (start, end), new in sorted(changes, reverse=True):
        text = text[:start] + new + text[end:]
    return text


@dataclass(eq=False)
class Buffer:
    """A file in an editor.

    Attributes:
        path: absolute path.
        name: name that users see: the path in the package, with slashes.
        disk: contents of the file when it was opened or last saved, with later merges.
        text: text in the editor.
        version: number that changes with the text.
        theirs: contents that another program saved and that could not be merged; None
            without such a conflict.
        merges: number of merges so far.
    """

    path: Path
    name: str
    disk: FileText
    text: str = field(default="")
    version: int = 0
    theirs: FileText | None = None
    merges: int = 0

    @classmethod
    def opened(cls, path: Path, name: str) -> Buffer:
        """Read a file."""
        disk = read_file_text(path)
        return cls(path, name, disk, disk.text)

    @property
    def why(self) -> str:
        """The reason why the file cannot be shown as text; "" when it can."""
        return self.disk.why

    @property
    def is_changed(self) -> bool:
        """Return whether the text differs from the text on disk."""
        is_gone = self.disk.data is None and not self.disk.why
        return self.text != self.disk.text or is_gone

    @property
    def conflicts(self) -> list[Replacement]:
        """The lines that another program has changed too, with its version of them."""
        if self.theirs is None or self.theirs.data is None or self.theirs.why:
            return []
        return [made for made, part in self._against(self.theirs) if _is_open(part)]

    def take(self, text: str) -> None:
        """Replace the whole text.

        Raises:
            UsageError: the text is too long, or a file cannot hold it.
        """
        if len(text) > limits.EDITED_TEXT.value:
            raise UsageError(
                f"{self.name} would have {len(text):,} characters: "
                f"{limits.EDITED_TEXT.value:,} at most are taken"
            )
        if text != self.text:
            self.text = text
            self.version += 1
            self._end_conflict()

    def replace(self, version: int, start: int, end: int, new: str) -> bool:
        """Replace a part of the text.

        Args:
            version: version of the text that the offsets refer to.
            start: start of the part [UTF-16 units].
            end: end of the part, exclusive [UTF-16 units].
            new: new text of the part.

        Returns:
            False when the text has changed meanwhile; the call then does nothing.

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
        """Compare the text with the disk, after another program may have saved it.

        Returns:
            True if the buffer has changed.
        """
        found = read_file_text(self.path)
        seen = self.disk if self.theirs is None else self.theirs
        if found.data == seen.data and not (self.why and not found.why):
            return False
        if found.text == self.text or self.text == self.disk.text:
            self._begin(found)
        elif found.data is None or found.why:
            self.theirs = found
        else:
            self._merge(found)
        return True

    def _merge(self, found: FileText) -> None:
        parts = [*segments(self.disk.text, self.text, found.text)]
        merged = "".join(part.merged for part in parts)
        if len(merged) > limits.EDITED_TEXT.value:
            self.theirs = found
            return
        self.merges += merged != self.text
        self.take(merged)
        base = "".join(p.base if p.is_conflict else p.theirs for p in parts)
        self.disk, self.theirs = replace(self.disk, text=base), found
        self._end_conflict()

    def keep(self, place: int | None = None) -> None:
        """Allow a save to overwrite another program's changes.

        Args:
            place: start of the lines of one conflict; None for all conflicts.
        """
        if self.theirs is None:
            return
        if place is not None:
            parts = self._against(self.theirs)
            base = (p.theirs if m.extent.start == place else p.base for m, p in parts)
            self.disk = replace(self.disk, text="".join(base))
            self._end_conflict()
        else:
            self.disk, self.theirs = replace(self.theirs, why=""), None

    def taken(self, place: int | None = None) -> list[Replacement]:
        """Return the changes that accept another program's version of conflicts.

        Args:
            place: as for `keep`.
        """
        return [m for m in self.conflicts if place is None or m.extent.start == place]

    def revert(self) -> list[Replacement]:
        """Return the changes that restore the text on disk, the new base of the buffer.

        Contents that are not text replace the buffer at once.
        """
        found = read_file_text(self.path)
        if self.why or found.data is None or found.why:
            self._begin(found)
            return []
        self.disk, self.theirs = found, None
        return [made for made, part in self._against(found) if part.mine != part.theirs]

    def _against(self, theirs: FileText) -> Iterator[tuple[Replacement, Segment]]:
        at = 0
        for part in segments(self.disk.text, self.text, theirs.text):
            yield Replacement(Extent(at, at + len(part.mine)), part.theirs), part
            at += len(part.mine)

    def _end_conflict(self) -> None:
        theirs = self.theirs
        is_text = theirs is not None and theirs.data is not None and not theirs.why
        if theirs is not None and is_text and not self.conflicts:
            self.disk, self.theirs = theirs, None

    def saved(self, data: bytes) -> None:
        """Record that the text has been saved."""
        self.disk = FileText(data, self.text, self.disk.encoding)
        self.theirs = None

    def _begin(self, disk: FileText) -> None:
        if disk.data is None and self.disk.data is not None:
            # The file has been removed, but its text remains.
            self.disk, self.theirs = replace(disk, text=self.text, why=""), None
            return
        self.disk, self.theirs = disk, None
        if self.text != disk.text:
            self.text = disk.text
            self.version += 1


def _is_open(part: Segment) -> bool:
    """Return whether another program has changed lines that differ here."""
    return part.theirs not in (part.base, part.mine)

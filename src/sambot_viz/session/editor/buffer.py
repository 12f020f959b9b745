"""A file that is open in an editor: its text, and what is on the disk.

What another program saves is merged with what users have written; where both have
changed the same lines, they choose.
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
    """A part of a text, and what takes its place."""

    extent: Extent
    text: str


def replaced(text: str, changes: Iterable[Replacement]) -> str:
    """Return a text with changes of different parts, in any order."""
    for (start, end), new in sorted(changes, reverse=True):
        text = text[:start] + new + text[end:]
    return text


@dataclass(eq=False)
class Buffer:
    """A file in an editor.

    Attributes:
        path: the whole path.
        name: what users call it: its path in the package, with slashes.
        disk: what was on the disk when the text began, or was saved, with what was
            merged since.
        text: as it is in the editor.
        version: another number for another text.
        theirs: what another program has saved meanwhile and could not be merged; None
            when nothing has.
        merges: how often something was merged.
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
        """Why it cannot be shown as text; "" when it can."""
        return self.disk.why

    @property
    def is_changed(self) -> bool:
        """Whether the text is another one than that on the disk was."""
        is_gone = self.disk.data is None and not self.disk.why
        return self.text != self.disk.text or is_gone

    @property
    def conflicts(self) -> list[Replacement]:
        """The lines that another program has changed too, with what it has written."""
        if self.theirs is None or self.theirs.data is None or self.theirs.why:
            return []
        return [made for made, part in self._against(self.theirs) if _is_open(part)]

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
            self._end_conflict()

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
        """Let the text be saved over what another program has saved.

        Args:
            place: where the lines of one conflict begin; None for all.
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
        """Return how the text becomes that of another program, where both changed it.

        Args:
            place: as for `keep`.
        """
        return [m for m in self.conflicts if place is None or m.extent.start == place]

    def revert(self) -> list[Replacement]:
        """Return how the text becomes that on the disk, which counts from now on.

        What cannot be shown as text takes its place at once.
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
        """Note that the text is on the disk now."""
        self.disk = FileText(data, self.text, self.disk.encoding)
        self.theirs = None

    def _begin(self, disk: FileText) -> None:
        if disk.data is None and self.disk.data is not None:
            # The file is gone, its text is not.
            self.disk, self.theirs = replace(disk, text=self.text, why=""), None
            return
        self.disk, self.theirs = disk, None
        if self.text != disk.text:
            self.text = disk.text
            self.version += 1


def _is_open(part: Segment) -> bool:
    """Tell whether another program has changed lines that are otherwise here."""
    return part.theirs not in (part.base, part.mine)

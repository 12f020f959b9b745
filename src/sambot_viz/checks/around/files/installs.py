"""Describe what CMakeLists.txt or setup.py installs, and where, in one form."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from sambot_viz.errors import Place


class Piece(NamedTuple):
    """An installed file, or a folder with everything in it.

    Attributes:
        source: relative to the package; a folder ends with a slash, and the package
            itself is empty.
        target: its installed path below the prefix; a folder ends with a slash.
        said: the destination as the build file has it.
        place: the place in the build file.
        certain: False when it depends on a condition.
    """

    source: str
    target: str
    said: str
    place: Place
    certain: bool = True

    def installed(self, path: str) -> str | None:
        """Return the installed path of a file of the package; None when it has none."""
        if path == self.source:
            return self.target
        folder = self.source.endswith("/") or not self.source
        if not folder or not path.startswith(self.source):
            return None
        return self.target + path.removeprefix(self.source)


class Installed(NamedTuple):
    """Everything that a build file installs.

    Attributes:
        place: where to add a missing piece.
        folder: the package.
        share: where its share folder is, below the prefix.
        pieces: the installed files and folders.
    """

    place: Place
    folder: Path
    share: str
    pieces: tuple[Piece, ...]

    def targets(self, path: str) -> Iterator[tuple[str, Piece]]:
        """Yield each installed path of a file of the package, with its piece."""
        for piece in self.pieces:
            target = piece.installed(path)
            if target is not None:
                yield target, piece

    def has(self, below: str) -> bool:
        """Return whether there is a file or a folder in the share folder."""
        wanted = f"{self.share}/{below.strip('/')}"
        return any(self._gives(piece, wanted) for piece in self.pieces)

    def _gives(self, piece: Piece, wanted: str) -> bool:
        if piece.target.rstrip("/") == wanted or piece.target.startswith(f"{wanted}/"):
            return True
        inner = wanted.removeprefix(piece.target)
        if not piece.target.endswith("/") or inner == wanted:
            return False
        return os.path.exists(self.folder / f"{piece.source}{inner}")

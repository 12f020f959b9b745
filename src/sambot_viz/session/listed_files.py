"""The files of a folder that a page may open: it names one of a list, never a path."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Sequence
from pathlib import Path

from sambot_viz.errors import UsageError
from sambot_viz.files import is_below


class ListedFiles:
    """Lists the files of a kind in a folder, but no hidden ones and no links elsewhere.

    Opened files are listed in any case.

    Args:
        folder: the folder; its subfolders are not searched.
        fits: returns whether a file or folder is of the wanted kind.
        most: maximum number of listed files, the first ones by their names.
        opened: paths in the folder that are neither hidden nor elsewhere.
        beside: further resolved folders into which links may lead.
    """

    def __init__(
        self,
        folder: Path,
        fits: Callable[[os.DirEntry[str]], bool],
        most: int,
        opened: Collection[Path | None] = (),
        beside: Sequence[Path] = (),
    ) -> None:
        self._folder = folder
        self._fits = fits
        self._most = most
        self._opened = opened
        self._beside = beside

    def names(self) -> list[str]:
        """Return the names of what fits, sorted.

        Raises:
            UsageError: the folder cannot be read.
        """
        try:
            with os.scandir(self._folder) as entries:
                found = [entry.name for entry in entries if self._is_listed(entry)]
        except OSError as error:
            raise UsageError(
                f"the folder {self._folder} cannot be read: {error.strerror}"
            ) from error
        return sorted(found, key=str.casefold)[: self._most]

    def leads_elsewhere(self, path: Path) -> bool:
        """Return whether a path in the folder is a link out of it."""
        # Few are links: what else there is costs no more than this question.
        if not path.is_symlink() or path in self._opened:
            return False
        return not is_below(path, [self._folder.resolve(), *self._beside])

    def _is_listed(self, entry: os.DirEntry[str]) -> bool:
        path = self._folder / entry.name
        if entry.name.startswith(".") and path not in self._opened:
            return False
        return self._fits(entry) and not self.leads_elsewhere(path)

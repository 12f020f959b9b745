"""The recordings that a page may open in place of those that are shown.

They lie in the folders of those that were opened: a page gets their names, and sends
one back. What it sends is never a path.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from sambot_viz import limits
from sambot_viz.errors import UsageError, did_you_mean
from sambot_viz.files import is_below, is_recording
from sambot_viz.session.listed_files import ListedFiles
from sambot_viz.sources.bag.folder import ENDINGS, METADATA
from sambot_viz.sources.given import GivenSource
from sambot_viz.text import text

Given = Sequence[GivenSource]


class RecordingFiles:
    """Lists recordings, and puts one in the place of others.

    Args:
        opened: what was opened by the command line or a program; their folders are
            looked through.
    """

    def __init__(self, opened: Given) -> None:
        self._opened = [opened]

    def add(self, given: Given) -> None:
        """Look through the folders of these too."""
        if given not in self._opened:
            self._opened.append(given)

    def names(self) -> list[str]:
        """Return the names of the recordings, without their folders.

        Raises:
            UsageError: a folder cannot be read.
        """
        return list(self._found())

    def instead(self, shown: Given, part: str, name: str) -> tuple[GivenSource, ...]:
        """Return the shown sources with one of them replaced.

        Args:
            shown: the shown sources.
            part: the source to replace, from `parts`.
            name: the recording, from `names`.

        Raises:
            UsageError: there is no such part or recording now.
        """
        parts, found = parts_of(shown), self._found()
        if part not in parts:
            raise UsageError(f"no recording '{text(part)}' is shown by now")
        if name not in found:
            raise UsageError(
                f"there is no recording '{text(name)}' in the folders of those that "
                f"were opened; {did_you_mean(name, found)}"
            )
        return replaced(shown, parts[part], found[name])

    def _found(self) -> Mapping[str, Sequence[Path]]:
        """Return name → the files and folders of each recording."""
        found: dict[str, Sequence[Path]] = {}
        known: set[Path] = set()
        for folder, opened in self._folders().items():
            real = [Path(os.path.realpath(path)).parent for path in opened]
            most = limits.RECORDING_NAMES.value - len(found)
            listed = ListedFiles(folder, _is_recording, most, opened, real)
            for name in listed.names():
                known.add(folder / name)
                found[_free(text(name), found)] = (folder / name,)
        # What was opened as one recording out of several files, or of a whole folder.
        for part in (one for given in self._opened for one in parts_of(given).values()):
            paths = [Path(one.path).absolute() for one in part]
            if len(paths) > 1:
                listed = ", ".join(path.name for path in paths)
                found[_free(text(f"{len(paths)} recordings: {listed}"), found)] = paths
            elif paths[0] not in known:
                whole = " (whole folder)" if paths[0].is_dir() else ""
                found[_free(text(f"{paths[0].name}{whole}"), found)] = paths
        return found

    def _folders(self) -> Mapping[Path, Sequence[Path]]:
        """Return folder → what was opened in it."""
        folders: dict[Path, list[Path]] = {}
        for one in (one for given in self._opened for one in given if not one.is_live):
            path = Path(one.path).absolute()
            # A folder that rosbag2 has written is one recording; others have many.
            is_folder = path.is_dir() and not (path / METADATA).is_file()
            folders.setdefault(path if is_folder else path.parent, []).append(path)
        return folders


def parts_of(given: Given) -> dict[str, Given]:
    """Return what can be replaced: recordings that are one, by what users call them."""
    groups: dict[tuple[str, str], list[GivenSource]] = {}
    for one in given:
        if not one.is_live:
            groups.setdefault((one.name, one.prefix), []).append(one)
    parts: dict[str, Given] = {}
    for (name, _), part in groups.items():
        of_file = Path(part[0].path).name
        called = of_file if len(part) == 1 else f"{len(part)} recordings"
        parts[_free(text(name or called), parts)] = part
    return parts


def replaced(
    shown: Given, part: Given, paths: Sequence[Path]
) -> tuple[GivenSource, ...]:
    """Return sources with other files in the place of one recording.

    Args:
        shown: all of them.
        part: those of the recording; the others have its name and prefix.
        paths: the files and folders.
    """
    first = shown.index(part[0])
    others = [replace(part[0], uri=f"bag:{path}") for path in paths]
    kept = [one for one in shown[first:] if one not in part]
    return (*shown[:first], *others, *kept)


def _free(name: str, taken: Mapping[str, object]) -> str:
    """Return a name that is not taken yet."""
    number, free = 1, name
    while free in taken:
        number += 1
        free = f"{name} ({number})"
    return free


def _is_recording(entry: os.DirEntry[str]) -> bool:
    if entry.is_file():
        return entry.name.lower().endswith(ENDINGS)
    if not entry.is_dir() or not is_recording(entry.path):
        return False
    # The files in the folder may be links to elsewhere.
    folder = Path(entry.path)
    files = [one for one in folder.iterdir() if one.is_symlink()]
    return all(is_below(one, [folder.parent.resolve()]) for one in files)

"""Finding the model file that a config names, also when it is another machine's."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath, PureWindowsPath

MOST_LEVELS = 5
"""So far above a folder a package is looked for."""


def find_description(name: str, near: Sequence[Path]) -> Path | None:
    """The file meant by "Description File".

    RViz takes the path as it is. A path of another machine is tried with ever fewer
    of its leading folders, below the folders that the opened files are in: with
    ``/home/ann/ws/src/pkg/urdf/a.urdf`` and an opened ``pkg/launch/b.launch.py`` the
    file ``pkg/urdf/a.urdf`` is found.

    Args:
        name: as the config says; "~", file:// and package:// are understood.
        near: folders in which to look, the most likely first.

    Returns:
        None when there is no such file.
    """
    name = name.removeprefix("file://").removeprefix("package://")
    own = Path(name).expanduser()
    if own.is_file():
        return own
    parts = _parts(name)
    bases = list(dict.fromkeys(base for folder in near for base in _above(folder)))
    for start in range(len(parts)):
        for base in bases:
            path = base.joinpath(*parts[start:])
            if path.is_file():
                return path
    return None


def _parts(name: str) -> Sequence[str]:
    """The folders and the file of a path of any system, without its root."""
    pure = PureWindowsPath(name) if "\\" in name else PurePosixPath(name)
    parts = pure.parts[1:] if pure.anchor else pure.parts
    return [part for part in parts if part not in ("~", "..")]


def _above(folder: Path) -> Iterator[Path]:
    folder = folder.resolve()
    yield from (folder, *folder.parents[: MOST_LEVELS - 1])

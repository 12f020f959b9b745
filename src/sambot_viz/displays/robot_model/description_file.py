"""Finding the model file that a config or a browser names."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath, PureWindowsPath

from sambot_viz.files import is_below
from sambot_viz.robot.model import Robot
from sambot_viz.robot.packages.package_index import PackageIndex

MOST_LEVELS = 5
"""Number of folders to search, from a given one upwards."""
MOST_PARTS = 40
"""Maximum number of parts of a path to look for, counted from its end."""


def find_description(name: str, near: Sequence[Path]) -> Path | None:
    """Return the file that "Description File" of an opened config means.

    RViz takes the path as it is. A path of another machine is tried with ever fewer
    of its leading folders, below the folders that the opened files are in: with
    ``/home/ann/ws/src/pkg/urdf/a.urdf`` and an opened ``pkg/launch/b.launch.py`` the
    file ``pkg/urdf/a.urdf`` is found.

    Args:
        name: the name in the config; "~", file:// and package:// are understood.
        near: folders in which to look, the most likely first.

    Returns:
        None if there is no such file.
    """
    found = (path for path in _candidates(name, near) if os.path.isfile(path))
    return next(found, None)


def find_below(name: str, folders: Sequence[Path]) -> Path | None:
    """Return the file that a browser names, if it is below some opened folders.

    Nothing outside the folders is read, so the answer reveals nothing about it.

    Args:
        name: as for `find_description`.
        folders: the folders that were opened on the command line.

    Returns:
        None when there is no such file, or when it lies elsewhere.
    """
    real = [folder.resolve() for folder in folders]
    written = [*real, *(folder.absolute() for folder in folders)]
    for path in _candidates(name, folders):
        plain = Path(os.path.normpath(path))
        # The text decides first, and only then the disk.
        if any(map(plain.is_relative_to, written)):
            if is_below(plain, real) and os.path.isfile(plain):
                return plain
    return None


def opened_folders(
    robot: Robot | None, config: Path | None, package_path: Sequence[Path | str]
) -> tuple[Path, ...]:
    """Return the folders that the command line opened.

    Args:
        robot: the opened model; the folder of its file and its package are open.
        config: the .rviz file; its folder is open.
        package_path: folders, or ``name=folder``.
    """
    folders: list[Path] = []
    for file in _with_target(robot.files[0] if robot and robot.files else None):
        folders += reversed(PackageIndex(file.parent).own_roots())
    folders += [file.parent for file in _with_target(config)]
    folders += PackageIndex(None, package_path).own_roots()
    return tuple(dict.fromkeys(folders))


def _with_target(file: Path | None) -> Iterator[Path]:
    """Yield a file, and where it leads: builds of ROS workspaces consist of links."""
    if file is not None:
        yield file.absolute()
        yield Path(os.path.realpath(file))


def _candidates(name: str, near: Sequence[Path]) -> Iterator[Path]:
    """The path itself, then ever shorter ends of it below the folders and above."""
    name = name.removeprefix("file://").removeprefix("package://")
    if "\0" in name:
        return
    yield Path(os.path.expanduser(name))
    parts = _parts(name)[-MOST_PARTS:]
    bases = list(dict.fromkeys(base for folder in near for base in _above(folder)))
    for start in range(len(parts)):
        for base in bases:
            yield base.joinpath(*parts[start:])


def _parts(name: str) -> Sequence[str]:
    """Return the folders and the file of a path of any system, without its root."""
    pure = PureWindowsPath(name) if "\\" in name else PurePosixPath(name)
    parts = pure.parts[1:] if pure.anchor else pure.parts
    return [part for part in parts if part not in ("~", "..")]


def _above(folder: Path) -> Iterator[Path]:
    folder = folder.resolve()
    yield from (folder, *folder.parents[: MOST_LEVELS - 1])

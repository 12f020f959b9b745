"""Finds the intended file in a package for a path that does not exist."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from pathlib import Path, PurePosixPath

from sambot_viz.robot.packages.package_index import package_around
from sambot_viz.robot.packages.resolve import walk_below
from sambot_viz.robot.slips.vocabulary import is_one_slip, meant

_KINDS = (
    frozenset((".stl", ".stlb", ".dae", ".obj", ".glb", ".gltf", ".ply")),
    frozenset((".png", ".jpg", ".jpeg", ".tga", ".bmp")),
    frozenset((".xacro", ".urdf", ".sdf", ".gazebo", ".xml")),
)
"""Endings of files that can replace each other."""
_LONG = 3


def _letters(name: str) -> str:
    return re.sub(r"[\W_]", "", name.rpartition(".")[0] or name)


def _bare(name: str) -> str:
    return name.partition(".")[0]


def _misspelt(one: str, other: str) -> bool:
    """Return whether a letter differs; l_ and r_, and numbers, differ on purpose."""
    words = [re.findall(r"[a-z]+|\d+", _bare(name)) for name in (one, other)]
    differing = [pair for pair in zip(*words, strict=False) if pair[0] != pair[1]]
    return (
        len(words[0]) == len(words[1])
        and len(differing) == 1
        and min(map(len, differing[0])) >= _LONG
        and differing[0][0].isalpha()
        and is_one_slip(*differing[0])
    )


_LIKE: tuple[Callable[[str, str], bool], ...] = (
    lambda one, other: one == other,
    lambda one, other: one.startswith(f"{other}.") or other.startswith(f"{one}."),
    lambda one, other: _bare(one) == _bare(other),
    lambda one, other: _letters(one) == _letters(other),
    _misspelt,
)
"""Ways in which two file names are similar, the surest first."""


def near_file(missing: Path) -> Path | None:
    """Return the intended file: in another folder, or there under another name.

    Args:
        missing: path in a package at which there is no file.

    Returns:
        None when no file of the package is a candidate, or several are.
    """
    missing = missing.absolute()
    above = (folder for folder in missing.parents[:2] if folder.is_dir())
    root = package_around(missing) or next(above, None)
    if root is None or not missing.is_relative_to(root):
        return None
    wanted = PurePosixPath(missing.relative_to(root).as_posix())
    files = _files_like(root, wanted)
    name = wanted.name.lower()
    for like in _LIKE:
        found = [file for file in files if like(file.name.lower(), name)]
        here = [file for file in found if file.parent == wanted.parent]
        if len(here) != 1 and like is _LIKE[0]:
            here = _in_near_folder(found, str(wanted.parent))
        if here:
            return root / here[0] if len(here) == 1 else None
    return None


def _in_near_folder(found: list[PurePosixPath], folder: str) -> list[PurePosixPath]:
    """Keep the files of a name whose folder has a similar name."""
    if len(found) == 1:
        return found
    near = meant(folder, [str(file.parent) for file in found])
    return [file for file in found if str(file.parent) == near]


def _files_like(root: Path, wanted: PurePosixPath) -> list[PurePosixPath]:
    """Return the files of the wanted kind, as paths in the package."""
    ending = wanted.suffix.lower()
    kinds = [kind for kind in _KINDS if ending in kind] or [frozenset((ending,))]
    endings: Iterable[str] = kinds[0] if ending else frozenset[str]().union(*_KINDS)
    return [
        PurePosixPath(folder.relative_to(root).as_posix()) / name
        for folder, names in walk_below(root)
        for name in sorted(names)
        if PurePosixPath(name).suffix.lower() in endings
    ]

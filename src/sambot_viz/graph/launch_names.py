"""The names of launch files, without what reads them."""

from __future__ import annotations

from pathlib import Path

_ENDINGS = ("launch.py", ".launch", "launch.xml", "launch.yaml", "launch.yml")


def is_launch_file(path: Path) -> bool:
    """Return whether a file is one by its name."""
    return path.name.endswith(_ENDINGS) and path.is_file()


def has_launch_files(package: Path) -> bool:
    """Return whether a package has some where they usually are."""
    folders = (package / "launch", package)
    return any(is_launch_file(path) for one in folders for path in one.glob("*"))

"""The errors of files that cannot be opened."""

from __future__ import annotations

from pathlib import Path

from sambot_viz.errors import Problem, SourceError
from sambot_viz.files import reason_of


def refused(path: Path, code: str, message: str, hint: str) -> SourceError:
    """Say why a file cannot be opened, and what to do."""
    return SourceError([Problem("error", code, message, hint, str(path))])


def unreadable(path: Path, error: OSError | ValueError) -> SourceError:
    """Say that the disk, or a web server, does not give a file."""
    message = f"{path.name} cannot be read: {reason_of(error)}"
    usual = "see whether the name is right, the disk is there and you may read the file"
    hint = str(getattr(error, "hint", usual))
    return refused(path, "file-unreadable", message, hint)


def lfs_pointer(path: Path) -> SourceError:
    """Say that a repository was cloned without its large files."""
    message = f"{path.name} is a git-LFS pointer, not the recording itself"
    return refused(
        path, "file-not-a-bag", message, "run 'git lfs pull' in its repository"
    )


def not_a_bag(path: Path, why: str) -> SourceError:
    """Say that a file is not a recording."""
    message = f"{path.name} is not a recording: {why}"
    hint = "give a .mcap, .db3 or .bag file, or the folder that holds it"
    return refused(path, "file-not-a-bag", message, hint)

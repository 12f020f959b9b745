"""Problems that the page shows when a saved file cannot be shown."""

from __future__ import annotations

import stat
from pathlib import Path

from sambot_viz.errors import JointError, Problem


def unreadable(code: str, path: Path) -> Problem:
    """Report that something other than a file has replaced the file."""
    return Problem(
        "error",
        code,
        "the file cannot be read: it is no longer a regular file",
        "save it as a file again",
        str(path),
    )


def start_pose(error: JointError) -> Problem:
    """Report that the command line's joint positions do not fit the first robot."""
    return Problem(
        "error",
        "start-position-refused",
        f"the robot cannot start as the command line says: {error}",
        "correct the name in the model, or start again with other --joint or --zeros",
    )


def kept(file: str) -> Problem:
    """Report a config that was saved elsewhere after a user has changed it here."""
    return Problem(
        "warning",
        "config-changes-kept",
        f"{Path(file).name} was saved elsewhere, but the page has unsaved changes; "
        "they are kept, and the new version of the file is not shown",
        "save the config from the page, or load the file again",
        file,
    )


def described(node: str, why: str) -> Problem:
    """Report a live robot's answer to the saved model."""
    if not why:
        return Problem(
            "info",
            "description-taken",
            f"{node} has taken the saved model, and publishes it",
            "nothing is wrong",
        )
    return Problem(
        "warning",
        "description-not-taken",
        f"{node} did not take the saved model: {why}",
        "start robot_state_publisher on the robot, and a bridge that calls services, "
        "then save the model again",
    )


def internal_error(error: Exception) -> Problem:
    """Report that the program failed to show a saved file."""
    return Problem(
        "error",
        "reload-failed",
        f"internal error while reloading: {type(error).__name__}: {error}",
        "start the program again, and please report this error",
    )


def drawing_failed(error: Exception) -> Problem:
    """Report that a session could not draw what the mesh thread has read."""
    return Problem(
        "error",
        "reload-failed",
        f"internal error while drawing meshes: {type(error).__name__}: {error}",
        "start the program again, and please report it",
    )


def unwatched(reason: str) -> Problem:
    """Report that the system does not watch files."""
    return Problem(
        "warning",
        "watch-limited",
        f"files cannot be followed ({reason}); the files are checked once a "
        "second instead",
        "raise fs.inotify.max_user_watches, or start with --no-watch",
    )


def is_pipe(path: Path) -> bool:
    """Return whether a path is a pipe or a device: reading it might never end."""
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError):
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))

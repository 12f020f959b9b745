"""Why a file that was saved is not shown, as Problems for the page."""

from __future__ import annotations

import stat
from pathlib import Path

from sambot_viz.errors import JointError, Problem


def unreadable(code: str, path: Path) -> Problem:
    """The file was replaced by something that is not a file."""
    return Problem(
        "error",
        code,
        "the file cannot be read: it is no longer a regular file",
        "save it as a file again",
        str(path),
    )


def start_pose(error: JointError) -> Problem:
    """The joint positions of the command line do not fit the first robot."""
    return Problem(
        "error",
        "start-position-refused",
        f"the robot cannot start as the command line says: {error}",
        "correct the name in the model, or start again with other --joint or --zeros",
    )


def kept(file: str) -> Problem:
    """The config was saved elsewhere, and a user has changed it in the page."""
    return Problem(
        "warning",
        "config-changes-kept",
        f"{Path(file).name} was saved elsewhere, but the page has unsaved changes; "
        "they are kept, and the new version of the file is not shown",
        "save the config from the page, or load the file again",
        file,
    )


def described(node: str, why: str) -> Problem:
    """What the node of a live robot has answered to the model that was saved."""
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
    """The program failed while it showed what was saved."""
    return Problem(
        "error",
        "reload-failed",
        f"internal error while reloading: {type(error).__name__}: {error}",
        "start the program again, and please report this error",
    )


def drawing_failed(error: Exception) -> Problem:
    """A session could not draw what the mesh thread has read."""
    return Problem(
        "error",
        "reload-failed",
        f"internal error while drawing meshes: {type(error).__name__}: {error}",
        "start the program again, and please report it",
    )


def unwatched(reason: str) -> Problem:
    """The system reports no changes of files."""
    return Problem(
        "warning",
        "watch-limited",
        f"files cannot be followed ({reason}); the files are checked once a "
        "second instead",
        "raise fs.inotify.max_user_watches, or start with --no-watch",
    )


def is_pipe(path: Path) -> bool:
    """Whether a path is a pipe or a device: reading it might never end."""
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError):
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))

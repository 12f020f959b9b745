"""A class on a JupyterHub of `a_jupyter`: the lesson of its users, and the board."""

from __future__ import annotations

from pathlib import Path

from a_jupyter import PYTHON

SECRET = "the-secret-of-the-teacher"
"""In the link of the board."""
TEACHER = "tess"
"""The user who may open the board with the hub's login."""


def board_lines(lesson: str | Path, folder: Path, port: int) -> list[str]:
    """Lines of the hub's configuration for a lesson, and its board as a service.

    Args:
        lesson: its name, or its folder.
        folder: has the students' folders.
        port: for the board.
    """
    words = [str(PYTHON), "-m", "sambot_viz", "class", str(lesson), "--hub"]
    words += ["--dir", str(folder), "--port", str(port)]
    service = {"name": "board", "url": f"http://127.0.0.1:{port}", "command": words}
    service["oauth_no_confirm"] = True
    service["environment"] = {"SAMBOT_VIZ_PRESENTER": SECRET}
    scopes = ["list:users", "read:servers"]
    role = {"name": "board", "services": ["board"], "scopes": scopes}
    right = ["access:services!service=board"]
    teachers = {"name": "teachers", "users": [TEACHER], "scopes": right}
    return [
        f"c.JupyterHub.services.append({service!r})",
        "for name in ('PATH', 'PYTHONPATH', 'SAMBOT_VIZ_TEST', 'TMPDIR'):",
        "    value = c.Spawner.environment[name]",
        "    c.JupyterHub.services[-1]['environment'][name] = value",
        f"c.JupyterHub.load_roles.extend([{role!r}, {teachers!r}])",
        f"c.Spawner.environment['SAMBOT_VIZ_LESSON'] = {str(lesson)!r}",
        "c.Spawner.environment['SAMBOT_VIZ_MODEL'] = (",
        f"    lambda spawner: {str(folder)!r} + '/' + spawner.user.name",
        ")",
    ]

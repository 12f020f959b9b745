"""The tile "Robot viewer" of JupyterLab: how jupyter-server-proxy starts the program.

The Jupyter server of each user starts one viewer, and shows it below its own address,
as .../robot-viewer/, to those whom it lets in itself. On a machine with other users
nobody else reaches it: it listens on a socket in a folder of this user (where the
system has such sockets), and asks for a token that only the Jupyter server knows. A
port of 127.0.0.1 would be open to all users of the machine; what is more, one of them
could listen on it first, and would be sent the cookies of the user.

This is imported by the Jupyter server, so it imports next to nothing.
"""

from __future__ import annotations

import os
import socket
import sys
from pathlib import Path
from typing import Any

from sambot_viz import limits
from sambot_viz.flags import new_token

STARTS_WITHIN = 60.0
"""A viewer that does not answer for so long is ended [s]; 5 s are not enough where the
packages are read from a slow network."""


def robot_viewer() -> dict[str, Any]:
    """What jupyter-server-proxy has to know; it calls this when the server starts."""
    token = new_token()
    _allow_large_messages()
    return {
        "command": _command,
        # Not in the command, which all users of the machine can read.
        "environment": {"SAMBOT_VIZ_TOKEN": token},
        "request_headers_override": {"Authorization": f"Bearer {token}"},
        "unix_socket": _has_sockets_in_folders(),
        "timeout": STARTS_WITHIN,
        "new_browser_tab": False,
        "launcher_entry": {
            "title": "Robot viewer",
            "icon_path": str(Path(__file__).with_name("robot_viewer.svg")),
        },
    }


def _command(port: int, unix_socket: str) -> list[str]:
    """The command of the viewer, which finds the model by itself."""
    where = ("--unix-socket", unix_socket) if unix_socket else ("--port", str(port))
    words = [sys.executable, "-m", "sambot_viz.jupyter", _root_folder(), *where]
    # The proxy fills in {port} and the like.
    return [word.replace("{", "{{").replace("}", "}}") for word in words]


def _root_folder() -> str:
    """The folder that the file browser of JupyterLab shows."""
    server: Any = getattr(
        sys.modules.get("jupyter_server.serverapp"), "ServerApp", None
    )
    if server is not None and server.initialized():
        return str(server.instance().root_dir)
    return os.getcwd()


def _has_sockets_in_folders() -> bool:
    return hasattr(socket, "AF_UNIX")


def _allow_large_messages() -> None:
    """Let the proxy take large messages; it has no setting for that."""
    websocket: Any = sys.modules.get("tornado.websocket")
    name = "_default_max_message_size"
    if (
        websocket is not None
        and getattr(websocket, name, 0) < limits.NOTEBOOK_MESSAGE.value
    ):
        setattr(websocket, name, limits.NOTEBOOK_MESSAGE.value)

"""A server that listens on a socket in the file system."""

from __future__ import annotations

import os
import socket
import stat
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
import viser
from websockets.sync.client import unix_connect
from websockets.typing import Subprotocol

from sambot_viz.errors import ServerError
from sambot_viz.options import Options
from sambot_viz.server.listener import listen

PROTOCOL = Subprotocol(f"viser-v{viser.__version__}")


@pytest.fixture
def path() -> Iterator[Path]:
    # The path of a socket must be short.
    with TemporaryDirectory() as folder:
        yield Path(folder) / "socket"


def test_only_its_user_can_open_it_and_it_goes_with_the_server(path: Path) -> None:
    options = Options(unix_socket=path)
    with listen(options) as listener:
        assert listener.url() == f"unix:{path}"
        assert stat.S_IMODE(os.stat(path).st_mode) == 0o600
        uri = "ws://localhost/"
        with unix_connect(str(path), uri=uri, subprotocols=[PROTOCOL]):
            pass
    assert not path.exists()


def test_what_a_killed_program_has_left_is_replaced(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as left:
        left.bind(str(path))
    listen(Options(unix_socket=path)).close()


@pytest.mark.parametrize("kind", ["server", "file"])
def test_a_socket_that_is_taken_is_one_line(path: Path, kind: str) -> None:
    if kind == "file":
        path.write_text("precious")
    with socket.socket(socket.AF_UNIX) as other:
        if kind == "server":
            other.bind(str(path))
            other.listen()
        with pytest.raises(ServerError, match="listens there already, or it is a file"):
            listen(Options(unix_socket=path))
    assert path.exists()


def test_a_folder_that_does_not_exist_is_one_line(path: Path) -> None:
    with pytest.raises(ServerError, match="No such file or directory"):
        listen(Options(unix_socket=path / "no" / "socket"))

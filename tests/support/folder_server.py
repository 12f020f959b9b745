"""A web server for a folder, without ranges as python3 -m http.server, or with them."""

from __future__ import annotations

import io
import re
import threading
from collections.abc import Generator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

_RANGE = re.compile(r"bytes=(\d+)-(\d+)")


class FolderServer(ThreadingHTTPServer):
    """Serves a folder on loopback.

    Attributes:
        answers: the path and the status of each answer.
        has_ranges: whether it sends parts of files.
        sent: size of the parts that it was asked for [bytes].
    """

    daemon_threads = True

    def __init__(self, folder: Path, port: int = 0) -> None:
        super().__init__(("127.0.0.1", port), partial(_Handler, directory=str(folder)))
        self.answers: list[tuple[str, int]] = []
        self.has_ranges = False
        self.sent = 0

    @property
    def address(self) -> str:
        """The address of the folder."""
        return f"http://127.0.0.1:{self.server_address[1]}/"


class _Handler(SimpleHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server: FolderServer  # pyright: ignore[reportIncompatibleVariableOverride]

    def send_head(self) -> Any:
        """Send the head of an answer, and return what is to follow."""
        found = _RANGE.fullmatch(self.headers.get("Range", ""))
        path = Path(self.translate_path(self.path))
        if found is None or not self.server.has_ranges or not path.is_file():
            return super().send_head()
        size = path.stat().st_size
        first, last = int(found[1]), min(int(found[2]), size - 1)
        with path.open("rb") as stream:
            stream.seek(first)
            data = stream.read(last - first + 1)
        self.server.sent += len(data)
        self.send_response(206)
        self.send_header("Content-Length", str(len(data)))
        self.send_header("Content-Range", f"bytes {first}-{last}/{size}")
        self.end_headers()
        return io.BytesIO(data)

    def log_message(self, format: str, *args: Any) -> None:
        """Write nothing."""

    def log_request(self, code: Any = "-", size: Any = "-") -> None:
        """Note the answer."""
        self.server.answers.append((self.path, int(code)))


@contextmanager
def folder_server(folder: Path, port: int = 0) -> Generator[FolderServer]:
    """Serve a folder until the block ends."""
    with FolderServer(folder, port) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()
